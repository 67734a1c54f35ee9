#pragma once

#include <vector>

#include "core/scene/scene.h"
#include "perf/stability/sampling_bound.h"

namespace slabcast::stability {

/// Where in a view a ray is while the head looks straight at the volume.
enum class Region { All, Centre, Border };
inline constexpr Region kRegions[] = {Region::All, Region::Centre, Region::Border};
const char* name(Region region);

/// What rays gather over a lattice, and what they are in that view.
struct Gathered {
    std::vector<glm::dvec4> pixels; // premultiplied
    std::vector<EyeRay> rays;
};

/// The rays of one square picture that meet the volume, as they are in the world. The eye is close
/// before the volume, which fills the view. Where the head turns about the vertical in place, every
/// ray stays; only its place in the view is another, and with it a planar lattice's samples.
/// Unlit, post-classified. Borrows the scene. Tested by: head_rays_test.cpp
class HeadRays {
public:
    HeadRays(const Scene& scene, double fovDegrees, int side);

    /// As a head that looks straight at the volume sees it.
    const View& view() const { return straight_; }
    int count() const { return static_cast<int>(tangents_.size()); }
    /// The share of the picture that they are.
    double share() const { return share_; }
    /// Centre: within a third of half the view, along both axes. Border: the outer third.
    bool isIn(Region region, int ray) const;

    /// In float64, every ray as the one pixel of a view that is turned by so much.
    Gathered gathered(const Lattice& lattice, double turnedDegrees) const;
    /// The integrals along the same rays.
    std::vector<glm::dvec4> integrals() const;

private:
    View viewOf(int ray, double turnedDegrees) const;

    const Scene& scene_;
    View straight_;
    double share_ = 0.0;
    std::vector<glm::dvec2> tangents_; // of the rays in that view
};

} // namespace slabcast::stability
