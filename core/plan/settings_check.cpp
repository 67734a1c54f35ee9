#include "core/plan/settings_check.h"

#include <cstdio>

#include "core/plan/settings_table.h"

namespace slabcast {

namespace {

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

Result<void> check(const Settings& s) {
    for (const Setting& setting : settingsTable()) {
        // Parameters of structures are checked with the structure: others have no use for them.
        const bool parameter = setting.usedBy != nullptr;
        if (const SettingValue value = setting.read(s); !parameter && !setting.takes(value)) {
            return fail(ErrorCode::InvalidArgument, std::string(setting.name) + " is " +
                                                        setting.text(value) + ": give " +
                                                        setting.allowed());
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

Result<void> check(const Settings& settings, const SceneFacts& facts) {
    if (Result<void> ok = check(settings); !ok) {
        return ok;
    }
    return checkSkip(facts, settings);
}

} // namespace slabcast
