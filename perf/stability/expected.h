#pragma once

#include <vector>

#include <glm/glm.hpp>

#include "core/scene/scene.h"
#include "perf/stability/bench.h"
#include "perf/stability/reference_picture.h"

namespace slabcast::stability {

/// One scene seen in one way, to be put through all methods.
struct Exhibit {
    std::string family;
    std::string name; // what of it is extreme
    const Scene& scene;
    View view;
    glm::ivec2 size;
    LatticeKind lattice = LatticeKind::Planar;
    double layerSpacingVoxels = 1.0;
    int columnStride = 1; // every so many-th column is judged

    Viewport viewport() const { return {0, 0, size.x, size.y}; }
    /// Columns that are judged.
    int columns() const { return (size.x + columnStride - 1) / columnStride; }
    glm::dvec2 fragCoord(int column, int row) const {
        return {column * columnStride + 0.5, row + 0.5};
    }
};

/// Per judged pixel, row by row from the bottom: colour and bound without blending, which depends
/// on the planes.
using ExpectedPicture = std::vector<PixelReference>;

/// Float64 evaluation of the very samples that the plan takes.
ExpectedPicture expectedFromSamples(const Exhibit& exhibit, const FramePlan& plan);

/// Of one material everywhere: alpha = 1 - exp(-extinction x chord), colour = color x alpha. The
/// chord comes from the eye, the ray's direction and the box's six faces alone; the bound is what
/// it changes by where the box grows and shrinks by what float32 positions may be off by.
ExpectedPicture expectedOfUniform(const Exhibit& exhibit, const FramePlan& plan,
                                  double extinctionPerMm, glm::dvec3 color);

/// The integral without any sampling; the bound is that of the samples and what sampling may cost.
/// Of a view without scale, every column.
ExpectedPicture expectedFromIntegral(const Exhibit& exhibit, const FramePlan& plan);

/// What blending may add to each pixel. Only planes that the ray meets inside the box change it,
/// each seen through what lies in front of it, of which `extinctionPerMm` is a lower bound. fp16
/// rounds once, by 2^-11 at most where a device cuts off. 8 bits round the fragment's colour, its
/// opacity and their product with what is behind, by 1/510 each; the deepest only the first.
std::vector<double> blendingBounds(const Exhibit& exhibit, const FramePlan& plan,
                                   double extinctionPerMm);

struct Verdict {
    double share = 0.0; // worst share of a pixel's bound that is used up: 1 is the bound
    int judged = 0;     // pixels that could fail: no ray that grazes the box, no bound of 1 or more
    int lit = 0;        // judged ones where something is to be seen
};

Verdict judge(const Exhibit& exhibit, const Picture& picture, const ExpectedPicture& expected,
              const std::vector<double>& blending);

/// Pixels of which any bit differs.
int differingPixels(const Picture& a, const Picture& b);
/// NaN and infinities among the components.
int nonFiniteComponents(const Picture& picture);

} // namespace slabcast::stability
