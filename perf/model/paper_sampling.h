#pragma once

#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

#include "core/transfer/transfer_function.h"
#include "core/volume/volume.h"

namespace slabcast {

// The core paper's way of sampling (Tukora 2020, sections 2.1 to 2.3), counted: planes of the
// bounding sphere, layers a voxel apart, pre-classified texels, and a proximity cloud of one length
// per voxel, read with the colour at a sample; what it spares the layers after it is counted down.

/// Per voxel the distance to the closest visible one, in voxels, rounded down; 0 where it is
/// visible. A cube of voxels.
struct PaperVolume {
    int edge = 0;
    std::vector<std::uint8_t> distance;

    std::uint8_t at(glm::ivec3 voxel) const {
        const auto e = static_cast<std::size_t>(edge);
        return distance[static_cast<std::size_t>(voxel.x) +
                        e * (static_cast<std::size_t>(voxel.y) +
                             e * static_cast<std::size_t>(voxel.z))];
    }
};

/// Of a volume that is a cube of voxels, as the paper's skull is. Visible: opacity above 0 at the
/// voxel's own value. Cost: O(voxels) per axis. Contract: as many voxels along each axis.
PaperVolume paperVolume(const Volume& volume, const TransferFunction& tf);

struct PaperView {
    double azimuthDegrees = 0.0;
    double eyeDistanceRadii = 2.0; // of the bounding sphere, from its centre
    int discPixels = 1300;         // of the sphere's disc, across
    int everyQuad = 20;            // of the quads along an axis one in so many is looked at
};

struct PaperSettings {
    int layersPerPlane = 16; // all: 1 plane
    int totalLayers = 444;
    bool skips = true;
};

/// Of one pixel of the sphere's disc, on average. Quads run in lockstep: what one of the four does,
/// all wait for; so a quad's work is that of four of the slowest.
struct PaperWork {
    double fragments = 0.0;    // on all planes
    double segments = 0.0;     // of these whose layers may lie in the box: others are discarded
    double layers = 0.0;       // of segments
    double leaps = 0.0;        // layers counted down
    double boxTests = 0.0;     // the others
    double fetches = 0.0;      // of these in the box
    double fetchesAlone = 0.0; // the same if quads did not wait: what divergence costs
};

inline constexpr double PaperWork::*kPaperParts[] = {
    &PaperWork::fragments, &PaperWork::segments, &PaperWork::layers,      &PaperWork::leaps,
    &PaperWork::boxTests,  &PaperWork::fetches,  &PaperWork::fetchesAlone};

/// Tested by: paper_model_test.cpp
PaperWork paperWork(const PaperVolume& volume, const PaperView& view,
                    const PaperSettings& settings);

} // namespace slabcast
