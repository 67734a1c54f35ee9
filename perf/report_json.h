#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "core/base/error.h"
#include "core/draw/renderer.h"
#include "perf/frame_times.h"
#include "perf/json.h"
#include "perf/paired_ratio.h"
#include "perf/volume_info.h"

namespace slabcast {

class Stage;

/// The key of what words name, snake_case as all keys are: of "early exit" or "early-exit"
/// early_exit. Tested by: settings_json_test.cpp
std::string keyOf(std::string_view words);

// JSON fragments that reports share. Keys are stable: people plot them.
Json toJson(const gl::Caps& caps);
Json toJson(const VolumeInfo& info);
Json toJson(const OrbitCamera& camera); // azimuth and elevation in degrees, radii
Json toJson(const FramePlan& plan);
Json toJson(const BuiltSkip& skip);   // null where nothing was built
Json toJson(const FrameTimes& times); // null of none; percentiles null below kFewestForPercentiles
Json toJson(const Result<WorkCounters>& counters); // null where they cannot be had

/// A ratio with its interval: NAME, NAME_low and NAME_high; and COVERAGE, which ratios of as many
/// rounds share.
void addRatio(Json& row, const std::string& name, const PairedRatio& ratio,
              const std::string& coverage);

/// What a report says of the run itself, and only the program knows.
struct RunInfo {
    std::string command;                         // as it was typed
    std::string commit;                          // of the build
    std::function<std::int64_t()> peakHostBytes; // so far; may be empty where nobody knows
};

/// What the host held at its peak, and the GPU holds, bytes.
Json memoryOf(const Renderer& renderer, const RunInfo& run);

/// What was run, of which build, when and on what: what every report begins with.
Json reportHeader(const RunInfo& run, const gl::Caps& caps);
/// And with which volume.
Json reportHeader(const RunInfo& run, const Stage& stage);

/// Now, as 2026-11-24T10:00:00Z.
std::string timestamp();

} // namespace slabcast
