#pragma once

#include <vector>

#include <glm/glm.hpp>

#include "core/transfer/transfer_function.h"
#include "core/view/lattice.h"
#include "core/volume/texels.h"

namespace slabcast {

/// What a ray is traced through. Borrows the texels: they must outlive it.
struct TraceInput {
    const Texels* texels = nullptr;
    VolumeGeometry geometry;
    TransferFunction tf; // validated
    CompositingSpace space = CompositingSpace::Display;
    View view;
    Viewport viewport;
    Lattice lattice;
    double tolerance = 1e-10; // of the exact integral: ContinuousInput::tolerance
};

/// One layer of a ray, as renderDiscrete() composites it, post-classified.
struct TracedLayer {
    int index = 0;
    double distanceMm = 0.0; // of the sample from the eye
    glm::dvec3 placeMm{0.0}; // of the sample, in patient space
    double lengthMm = 0.0;   // of the layer's part inside
    double value = 0.0;
    glm::dvec3 color{0.0};    // in the compositing space, not premultiplied
    double opacity = 0.0;     // of opacityUnitMm
    double alpha = 0.0;       // of the layer
    glm::dvec4 gathered{0.0}; // by the samples up to here, premultiplied
    glm::dvec4 exact{0.0};    // the continuous integral up to the layer's far end
};

/// Where a ray goes and what it gathers, layer by layer, beside the exact integral.
struct RayTrace {
    glm::dvec3 eyeMm{0.0};
    glm::dvec3 direction{0.0};       // of length 1
    double entryMm = 0.0;            // from the eye, where the ray enters what is drawn
    double exitMm = 0.0;             // equal to entryMm where it meets nothing
    std::vector<TracedLayer> layers; // those that meet the ray's part inside
};

/// `fragCoord` as gl_FragCoord. The last layer's `gathered` is renderDiscrete()'s pixel, and its
/// `exact` is renderContinuous()'s, but for a ray that is opaque before its end.
/// Tested by: ray_trace_test.cpp
RayTrace traceRay(const TraceInput& input, glm::dvec2 fragCoord);

} // namespace slabcast
