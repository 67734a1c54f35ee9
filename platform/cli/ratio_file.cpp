#include "platform/cli/ratio_file.h"

#include <algorithm>

#include <fmt/core.h>

#include "perf/ratios/ratio_table.h"
#include "perf/report_json.h"
#include "perf/stage.h"
#include "platform/cli/commit.h"
#include "platform/cli/device_cache.h"
#include "platform/cli/progress.h"

namespace slabcast {

namespace {

namespace fs = std::filesystem;

Result<fs::path> tablePath(const gl::Caps& caps) {
    return deviceCachePath("ratio-table", "what ratios take here", caps);
}

/// Empty where there is no table, or none that can be used: that is said.
std::vector<KeptRatios> readTable(const fs::path& path) {
    const auto parsed = [](const std::optional<std::string>& text) {
        return text ? parseRatioTable(*text) : std::vector<KeptRatios>{};
    };
    Result<std::vector<KeptRatios>> table = readDeviceCache(path).and_then(parsed);
    if (!table) {
        say(fmt::format("{}: no table of measured ratios ({}): measured and written anew",
                        path.string(), table.error().detail));
        return {};
    }
    return std::move(*table);
}

std::string keyOf(const Stage& stage, const Settings& settings) {
    return ratioKey(stage.caps(), stage.scene(), stage.desc(), settings, commit());
}

std::string keep(const fs::path& path, std::vector<KeptRatios> table, KeptRatios fresh) {
    const Result<void> written =
        writeDeviceCache(path, ratioTableText(withRatios(std::move(table), std::move(fresh))));
    if (!written) {
        say(fmt::format("what was measured is not kept: {}", written.error().detail));
        return "not kept";
    }
    return "kept in " + path.string();
}

/// The fastest, where there are more than a plan takes.
std::vector<RatioMeasurement> fastest(std::vector<RatioMeasurement> ratios) {
    if (ratios.size() > kMostRatios) {
        std::stable_sort(ratios.begin(), ratios.end(),
                         [](const auto& a, const auto& b) { return a.frameMs < b.frameMs; });
        ratios.resize(kMostRatios);
    }
    return ratios;
}

} // namespace

Result<FoundRatios> ratiosOf(Stage& stage, const Settings& settings) {
    if (settings.planes || settings.layersPerPlane || !stage.scene().facts().anythingVisible) {
        return FoundRatios{};
    }
    const Result<fs::path> path = tablePath(stage.caps());
    const std::string key = keyOf(stage, settings);
    std::vector<KeptRatios> table = path ? readTable(*path) : std::vector<KeptRatios>{};
    if (const KeptRatios* kept = findRatios(table, key)) {
        return FoundRatios{kept->ratios,
                           fmt::format("measured {}, kept in {}", kept->date, path->string())};
    }
    Result<std::vector<RatioMeasurement>> measured = stage.timeRatios(settings);
    if (!measured) {
        return tl::unexpected(measured.error());
    }
    FoundRatios found{fastest(std::move(*measured)), "measured now"};
    if (!path) {
        say(path.error().detail);
        return found;
    }
    found.origin +=
        ", " + keep(*path, std::move(table), {key, stage.info().name, timestamp(), found.ratios});
    return found;
}

void keepRatios(const Stage& stage, const Settings& settings,
                std::vector<RatioMeasurement> ratios) {
    const Result<fs::path> path = tablePath(stage.caps());
    if (!path) {
        say(path.error().detail);
        return;
    }
    (void)keep(
        *path, readTable(*path),
        {keyOf(stage, settings), stage.info().name, timestamp(), fastest(std::move(ratios))});
}

} // namespace slabcast
