#include "perf/ratios/ratio_table.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "perf/error/scene_key.h"
#include "perf/json.h"
#include "perf/stage.h"

namespace slabcast {

namespace {

constexpr int kVersion = 1;

Json toJson(const RatioMeasurement& one) {
    return {{"planes", one.ratio.planes},
            {"layers_per_plane", one.ratio.layersPerPlane},
            {"unrolled", one.ratio.form == SegmentForm::Unrolled},
            {"frame_ms", one.frameMs}};
}

std::optional<int> countIn(const Json& row, std::string_view name) {
    const Json& count = row.at(name);
    const bool sound =
        count.isWhole() && count.whole() >= 1 && count.whole() <= std::int64_t{kMaxTotalLayers};
    return sound ? std::optional(static_cast<int>(count.whole())) : std::nullopt;
}

std::optional<RatioMeasurement> ratioIn(const Json& row) {
    const std::optional<int> planes = countIn(row, "planes");
    const std::optional<int> layers = countIn(row, "layers_per_plane");
    const double ms = row.at("frame_ms").number();
    const bool unrolled = row.at("unrolled").flag();
    const bool sound = planes && layers && row.at("unrolled").isBool() && std::isfinite(ms) &&
                       ms > 0.0 && (!unrolled || unrollLengthFor(*layers) != 0);
    if (!sound) {
        return std::nullopt;
    }
    return RatioMeasurement{
        {*planes, *layers, unrolled ? SegmentForm::Unrolled : SegmentForm::Loop}, ms};
}

/// Nothing where a member is missing or of another kind.
std::optional<KeptRatios> sceneIn(const Json& row) {
    KeptRatios kept{row.at("key").text(), row.at("subject").text(), row.at("date").text(), {}};
    for (const Json& one : row.at("ratios")) {
        const std::optional<RatioMeasurement> ratio = ratioIn(one);
        if (!ratio) {
            return std::nullopt;
        }
        kept.ratios.push_back(*ratio);
    }
    const bool sound = !kept.key.empty() && !kept.date.empty() && row.at("ratios").isList() &&
                       !kept.ratios.empty() && kept.ratios.size() <= kMostRatios;
    return sound ? std::optional(std::move(kept)) : std::nullopt;
}

} // namespace

std::string ratioKey(const gl::Caps& caps, const Scene& scene, const StageDesc& drawn,
                     const Settings& settings, const std::string& commit) {
    StageDesc asked = drawn;
    asked.settings = settings;
    asked.settings.planes.reset();
    asked.settings.layersPerPlane.reset();
    Json all = frameKey(caps, scene, asked);
    all["commit"] = commit;
    const std::string text = all.dump();
    return fingerprint(std::as_bytes(std::span(text)));
}

const KeptRatios* findRatios(const std::vector<KeptRatios>& table, std::string_view key) {
    const auto found = std::find_if(table.begin(), table.end(),
                                    [key](const KeptRatios& kept) { return kept.key == key; });
    return found == table.end() ? nullptr : &*found;
}

std::vector<KeptRatios> withRatios(std::vector<KeptRatios> table, KeptRatios fresh) {
    std::erase_if(table, [&fresh](const KeptRatios& old) { return old.key == fresh.key; });
    if (table.size() >= kMostKeptScenes) {
        const auto surplus = static_cast<std::ptrdiff_t>(table.size() - kMostKeptScenes + 1);
        table.erase(table.begin(), table.begin() + surplus);
    }
    table.push_back(std::move(fresh));
    return table;
}

std::string ratioTableText(const std::vector<KeptRatios>& table) {
    Json scenes = Json::list();
    for (const KeptRatios& kept : table) {
        Json ratios = Json::list();
        for (const RatioMeasurement& one : kept.ratios) {
            ratios.push_back(toJson(one));
        }
        scenes.push_back({{"key", kept.key},
                          {"subject", kept.subject},
                          {"date", kept.date},
                          {"ratios", std::move(ratios)}});
    }
    return Json{{"version", kVersion}, {"scenes", std::move(scenes)}}.dump(1) + "\n";
}

Result<std::vector<KeptRatios>> parseRatioTable(std::string_view text) {
    const Json content = Json::parse(text).value_or(Json());
    if (!content.isObject() || !content.at("scenes").isList()) {
        return fail(ErrorCode::FileUnreadable, "it is something else, or cut short");
    }
    if (content.at("version") != kVersion) {
        return fail(ErrorCode::FileUnreadable, "of another version");
    }
    std::vector<KeptRatios> table;
    for (const Json& row : content.at("scenes")) {
        std::optional<KeptRatios> kept = sceneIn(row);
        if (!kept) {
            return fail(ErrorCode::FileUnreadable,
                        "scene " + std::to_string(table.size() + 1) + " is damaged");
        }
        table.push_back(std::move(*kept));
    }
    return table;
}

} // namespace slabcast
