#pragma once

#include "perf/stability/bench.h"
#include "perf/stability/reference_picture.h"

namespace slabcast::stability {

// Conditions that several families draw under, and what goes with them.

struct Spacing {
    const char* name;
    double voxels;
};
inline constexpr Spacing kSpacings[] = {{"a layer per voxel", 1.0}, {"a layer per 4 voxels", 4.0}};

Settings settingsOf(const Method& method, const Spacing& spacing);

/// Of roundingPerPlane().
extern const char* const kRoundingReason;

/// So far away that all rays are parallel within a few hundredths, and that `halfHeightMm` about
/// the volume's centre fills half of the picture.
View distantView(const Scene& scene, double azimuthDegrees, double halfHeightMm, glm::ivec2 size);

/// Whether the page shows this method's pictures: the hybrid's in 8 bits.
bool isShown(const Method& method);

/// The greatest opacity that a plane of the scene's densest material has, seen straight.
double mostOfPlane(const Scene& scene, const FramePlan& plan);

/// Where rounding may take what a picture shows, two claims are left: that the plan warns of it;
/// and that 8 bits hold nothing where every plane adds less than half of their step. `c` names what
/// was drawn.
void recordLoss(Bench& bench, const Case& c, const Scene& scene, const Drawn& drawn,
                const std::string& reason);

} // namespace slabcast::stability
