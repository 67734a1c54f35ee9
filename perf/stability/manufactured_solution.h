#pragma once

#include <vector>

#include "core/scene/scene.h"
#include "core/view/view.h"
#include "perf/stability/bench.h"

namespace slabcast::stability {

/// A picture that was chosen first, and the medium that was derived from it. Along s, from 0 to 1
/// through a slab of 16 mm, the transmittance is
///     T(s) = exp(-3 (3 s^2 - 2 s^3)),
/// so that the extinction is sigma(s) = 18 s (1 - s) per slab, zero at both faces and with a kink
/// there. Colours are functions of T: 1 - T, T and T^2. A ray that leans, and is `lean` times as
/// long as the slab is thick, sees T^lean, and what it gathers is an integral over powers of T.
/// A ramp of values and a transfer function with `knots` intervals make a volume of it.
namespace manufactured {

inline constexpr double kDepth = 3.0;
inline constexpr double kThicknessMm = 16.0;
inline constexpr double kMostExtinction = 1.5 * kDepth; // per slab
/// The greatest rate at which anything that is summed changes: that of T^2. An expansion in the
/// step h goes on in powers of kRate h.
inline constexpr double kRate = 2.0 * kMostExtinction;

double transmittance(double s);
double extinction(double s); // per slab
glm::dvec3 color(double s);

/// What the whole slab shows; premultiplied.
glm::dvec4 solution(double lean);

/// Bounds on what replaces the solution, of any component.
/// Of so many layers through the slab, each by the material in its middle, that begin and end on
/// its faces. Per layer, with w = sigma T and the greatest of each in it: extinction by h^3/24 T of
/// its second derivative, colour by h^3/12 (|c'| |w'| + |c''| w / 2).
double boundOfLayers(int layers, double lean);
/// What comes on top where the faces lie within layers: h^2/8 of the kink's slope at each.
double boundOfKinks(double layers, double lean);
/// Of a transfer function with so many intervals, straight in opacity and colour.
double boundOfKnots(int knots, double lean);

/// 17 slices along z, whose values rise from 0 to 4096; outside the first and last one's middle
/// nothing is visible.
Volume volume();
inline constexpr double kLastValue = 4096.0;
TransferFunction transferFunction(int knots);

/// From below, along z; all rays pass both faces.
View view(const Scene& scene, glm::ivec2 size);
double leanOf(const View& view, glm::ivec2 size, glm::dvec2 fragCoord);
double mostLean(const View& view, glm::ivec2 size);
/// All of a picture, row by row from the bottom.
std::vector<glm::dvec4> solutionOf(const View& view, glm::ivec2 size);

inline constexpr const char* kFamily = "manufactured";
inline constexpr int kKnots = 1024; // samples in the middles of up to 512 layers lie on knots

} // namespace manufactured

/// The family's part that the device draws. `scene`: of kKnots knots, exact texels.
void drawnManufacturedCases(Bench& bench, const Scene& scene);

} // namespace slabcast::stability
