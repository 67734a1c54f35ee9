#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/gl/caps.h"
#include "core/plan/frame_plan.h"
#include "core/scene/scene.h"

namespace slabcast {

struct StageDesc;

/// What ratios of planes to layers took in one scene, as it was drawn.
struct KeptRatios {
    std::string key;     // of ratioKey()
    std::string subject; // for people: which volume
    std::string date;    // when they were measured
    std::vector<RatioMeasurement> ratios;
};

/// As many scenes as a table keeps: those measured last.
inline constexpr std::size_t kMostKeptScenes = 64;

/// Tells apart all that a ratio's time depends on: device and driver, build, volume, transfer
/// function, view, picture and settings, the ratio left open. Cost: one pass over the texels.
/// Tested by: ratio_table_test.cpp
std::string ratioKey(const gl::Caps& caps, const Scene& scene, const StageDesc& drawn,
                     const Settings& settings, const std::string& commit);

/// Null where a table has none of this key.
const KeptRatios* findRatios(const std::vector<KeptRatios>& table, std::string_view key);

/// `table` with `fresh` last, in place of what it has of the same key.
std::vector<KeptRatios> withRatios(std::vector<KeptRatios> table, KeptRatios fresh);

std::string ratioTableText(const std::vector<KeptRatios>& table);

/// Fails: FileUnreadable, with what is wrong in a few words (also of what ratioTableText() did not
/// write).
Result<std::vector<KeptRatios>> parseRatioTable(std::string_view text);

} // namespace slabcast
