#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <glm/glm.hpp>

#include "core/transfer/shading.h"
#include "core/transfer/transfer_function.h"
#include "core/volume/texels.h"

namespace slabcast {

/// Voxels as colours: RGBA8, premultiplied, in the table's compositing space. Alpha is the opacity
/// of a layer of `referenceLengthMm`; a layer of another length h corrects it to
/// 1-(1-alpha)^(h/reference) after filtering.
struct ClassifiedTexels {
    glm::ivec3 dims{0};
    double referenceLengthMm = 1.0;
    std::vector<glm::u8vec4> texels; // x fastest
};

/// A light far away, fixed to the patient, baked into the texels without its highlights.
struct BakedLight {
    glm::dvec3 directionToLight{0.0, -1.0, 0.0}; // patient space; any length but zero
    ShadingParameters params;
};

struct ClassifySettings {
    std::optional<double> referenceLengthMm{}; // none: the smallest voxel edge
    std::optional<BakedLight> light{};
};

/// Classifies every stored texel by the table and shades it by the gradient of the stored texels:
/// central differences one voxel apart, clamped at the edge, carried to patient space.
/// Rounds to nearest: what absorbs less than 1/510 of a reference layer is lost, and a
/// premultiplied colour is off by up to 1/510, so hues of faint texels are coarse. A longer
/// reference length keeps more.
/// Cost: one pass, all cores. Source: the pre-shaded 3D texture of the core paper. Tested by:
/// preclassified_test.cpp
ClassifiedTexels classify(const Texels& texels, const VolumeGeometry& geometry,
                          const TransferTable& table, const ClassifySettings& settings = {});

/// Alpha bytes as codes, for the skip structures.
TexelCodes alphaCodes(const ClassifiedTexels& classified);

} // namespace slabcast
