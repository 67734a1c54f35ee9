#include "core/plan/settings_check.h"

#include <cstdio>

namespace slabcast {

namespace {

Result<void> checkRange(const char* what, double value, double low, double high) {
    if (value >= low && value <= high) {
        return {};
    }
    return fail(ErrorCode::InvalidArgument, std::string(what) + " is " + shortNumber(value) +
                                                ": give a number from " + shortNumber(low) +
                                                " to " + shortNumber(high));
}

Result<void> checkAlone(const Settings& s) {
    const struct {
        const char* what;
        std::optional<double> value;
        double low, high;
    } ranges[] = {
        {"layer spacing (voxels)", s.layerSpacingVoxels, 1e-3, 1e6},
        {"total layers", s.totalLayers, 1, kMaxTotalLayers},
        {"planes", s.planes, 1, kMaxTotalLayers},
        {"layers per plane", s.layersPerPlane, 1, kMaxTotalLayers},
        {"termination opacity", s.termination, 0.0, 1.0},
    };
    for (const auto& range : ranges) {
        if (range.value) {
            if (Result<void> ok = checkRange(range.what, *range.value, range.low, range.high);
                !ok) {
                return ok;
            }
        }
    }
    if (s.planes && s.layersPerPlane) {
        return fail(ErrorCode::InvalidArgument,
                    "planes and layers per plane are both set: give one, the total "
                    "number of layers decides the other");
    }
    if (s.shaded && s.classification == Classification::Preintegrated) {
        return fail(ErrorCode::InvalidArgument,
                    "pre-integrated classification has no shading: leave shading off, or take "
                    "post-classification");
    }
    return {};
}

/// A plan skips by what was built, or not at all.
Result<void> checkSkip(const SceneFacts& facts, const Settings& settings) {
    const SkipStructure built = facts.skip.structure;
    const SkipStructure asked = settings.skip.value_or(SkipStructure::None);
    if (asked == SkipStructure::None || built == SkipStructure::None || asked == built) {
        return {};
    }
    return fail(ErrorCode::InvalidArgument,
                std::string("skip ") + name(asked) + " was asked for, but what was built is " +
                    name(built) + ": provide what needsOf() these settings says, then plan anew");
}

} // namespace

std::string shortNumber(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.3g", value);
    return text;
}

Result<void> check(const Settings& settings, const SceneFacts& facts) {
    if (Result<void> ok = checkAlone(settings); !ok) {
        return ok;
    }
    return checkSkip(facts, settings);
}

} // namespace slabcast
