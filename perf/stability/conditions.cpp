#include "perf/stability/conditions.h"

#include <algorithm>
#include <cmath>

namespace slabcast::stability {

namespace {

double brightest(const Picture& picture) {
    double most = 0.0;
    for (const glm::vec4& pixel : picture.pixels) {
        const double value = std::max({pixel.r, pixel.g, pixel.b, pixel.a});
        most = value <= most ? most : value; // NaN stays
    }
    return most;
}

} // namespace

Settings settingsOf(const Method& method, const Spacing& spacing) {
    Settings settings = settingsOf(method);
    settings.layerSpacingVoxels = spacing.voxels;
    return settings;
}

const char* const kRoundingReason =
    "the target rounds at every plane that holds something (fp16: 2^-11; 8 bits: 1/510 for colour, "
    "opacity and their product each)";

View distantView(const Scene& scene, double azimuthDegrees, double halfHeightMm, glm::ivec2 size) {
    constexpr double kRadiiAway = 50.0;
    const double awayMm = kRadiiAway * scene.geometry().boundingSphere().radiusMm;
    return orbitView(scene, {azimuthDegrees, 0.0, kRadiiAway},
                     glm::degrees(2.0 * std::atan(halfHeightMm / awayMm)), size);
}

bool isShown(const Method& method) {
    return method.target == TargetFormat::Rgba8 && method.layersPerPlane == 16;
}

double mostOfPlane(const Scene& scene, const FramePlan& plan) {
    return -std::expm1(-scene.facts().maxExtinctionPerMm * plan.lattice.spacingMm *
                       plan.layersPerPlane);
}

void recordLoss(Bench& bench, const Case& c, const Scene& scene, const Drawn& drawn,
                const std::string& reason) {
    bench.record({.family = c.family,
                  .name = named({c.name, "warned of"}),
                  .quantity = "missing warnings of the plan",
                  .reason = reason,
                  .measured = warns(drawn.plan) ? 0.0 : 1.0});
    constexpr double kLean = 1.5; // rays at up to 48 degrees to the axis
    if (drawn.plan.target == TargetFormat::Rgba8 &&
        kLean * mostOfPlane(scene, drawn.plan) < 1.0 / 510.0) {
        bench.record({.family = c.family,
                      .name = named({c.name, "rounded away"}),
                      .quantity = "brightest component",
                      .reason = "every plane adds less than half of a step of 8 bits to nothing",
                      .measured = brightest(drawn.picture)});
    }
}

} // namespace slabcast::stability
