#pragma once

#include <functional>
#include <vector>

#include <glm/glm.hpp>

#include "core/base/parallel.h"
#include "core/transfer/transfer_function.h"
#include "core/view/lattice.h"
#include "core/volume/texels.h"

namespace slabcast {

/// What a picture without any sampling is of. Borrows the texels: they must outlive it.
struct ContinuousInput {
    const Texels* texels = nullptr; // R32fExact keeps 16-bit integers and float32 as they are
    VolumeGeometry geometry;
    TransferFunction tf; // validated
    CompositingSpace space = CompositingSpace::Display;
    View view;
    Viewport viewport;
    /// Relative to a ray's alpha: what two rules may differ by over any piece, the finer of which
    /// is taken; 1e-13 at the finest.
    double tolerance = 1e-10;
};

/// Called now and then with the share done in [0,1], from any thread, never two at once.
using ReferenceProgress = std::function<void(double share)>;

/// The picture that every renderer of the model approximates: the emission-absorption integral
/// along each pixel's ray, from where it enters the box or passes the near plane to where it leaves
/// the box, to the tolerance. The camera is the renderer's own code. Within an interpolation cell
/// the field along the ray is a cubic; it is cut where it crosses a knot of the TF, and every piece
/// is smooth and integrated adaptively. A ray ends early only where less than the tolerance of what
/// lies behind would still show. No lighting.
/// Premultiplied RGBA in the compositing space, row by row from the bottom; empty if cancelled.
/// Cost: O(pixels * cells met), all cores; some 40 us for a ray through a CT head.
/// Tested by: continuous_test.cpp
std::vector<glm::dvec4> renderContinuous(const ContinuousInput& input,
                                         const ReferenceProgress& progress = {},
                                         const CancelToken* cancel = nullptr);

/// The same for one ray; `fragCoord` as gl_FragCoord.
glm::dvec4 integrateRay(const ContinuousInput& input, glm::dvec2 fragCoord);

} // namespace slabcast
