#pragma once

#include <functional>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "core/transfer/transfer_function.h"
#include "core/view/lattice.h"

namespace slabcast {

/// A smooth scalar field by formula, of uvw: what voxels are only samples of.
using FormulaField = std::function<double(glm::dvec3 uvw)>;

/// A field and its look; the transfer function has no knot within the field's range, so that all
/// along a ray is smooth. Display space.
struct FormulaInput {
    FormulaField field;
    TransferFunction tf;
};

/// The emission-absorption integral along the ray, by K15 on so many equal pieces: exact to
/// rounding where the field is smooth over a piece. Tested by: formula_ray_test.cpp
glm::dvec4 integrateFormula(const FormulaInput& input, const LatticeRay& ray, int pieces);

/// How a ray's layers become its colour. The default is what the renderer does; all else is a
/// mistake that somebody has made, there to show that the measurement finds it.
struct RayRule {
    enum class Opacity : std::uint8_t { PerLength, Linear, Uncorrected };

    const char* name = "midpoint";
    double order = 2.0; // of its error in the step
    const char* why = "midpoints, end layers weighted by their length inside: each is of order 2";
    double place = 0.5; // of the sample in its layer
    bool weightedEnds = true;
    Opacity opacity = Opacity::PerLength;
    bool nearOverFar = true; // blends front to back; else each new layer over what is in front

    bool isControl() const { return order != 2.0; }
};

/// The renderer's rule first, then the mistakes. Tested by: formula_ray_test.cpp
const std::vector<RayRule>& rayRules();

/// The ray's layers by a rule. Samples outside the box are taken at its edge, as textures clamp.
glm::dvec4 sampleFormula(const FormulaInput& input, const LatticeRay& ray, int total,
                         const RayRule& rule);

} // namespace slabcast
