#include "perf/error/error_table_json.h"

#include <algorithm>
#include <span>
#include <tuple>

#include "perf/error/error_grid.h"
#include "perf/error/scene_key.h"
#include "perf/json.h"

namespace slabcast {

namespace {

constexpr int kVersion = 4;
constexpr double kMost = 1e300;

/// Reads members of one row; the first that is missing or of another kind is what is wrong.
class RowReader {
public:
    explicit RowReader(const Json& row) : row_(row) {}

    std::string text(const char* key) {
        const Json* value = member(key, &Json::isText);
        return value == nullptr ? "" : value->text();
    }
    bool flag(const char* key) {
        const Json* value = member(key, &Json::isBool);
        return value != nullptr && value->flag();
    }
    double number(const char* key, double low, double high) {
        const Json* value = member(key, &Json::isNumber);
        return value == nullptr ? low : inside(key, value->number(), low, high);
    }
    glm::ivec2 size(const char* key) {
        const Json* value = member(key, &Json::isList);
        const bool sound = value != nullptr && value->size() == 2 && value->at(0).isWhole() &&
                           value->at(1).isWhole();
        return sound ? glm::ivec2(value->at(0).whole(), value->at(1).whole())
                     : (complain(key), glm::ivec2(0));
    }
    /// One of the values that are named so.
    template <class T>
    T named(const char* key, std::initializer_list<T> values) {
        const std::string word = text(key);
        const auto* found = std::find_if(values.begin(), values.end(),
                                         [&word](T value) { return word == name(value); });
        return found != values.end() ? *found : (complain(key), *values.begin());
    }
    /// A number, or nothing for "off".
    std::optional<double> orOff(const char* key, double low, double high) {
        return row_.contains(key) && row_.at(key) == "off" ? std::nullopt
                                                           : std::optional(number(key, low, high));
    }
    /// Empty where nothing is.
    const std::string& wrong() const { return wrong_; }

private:
    const Json* member(const char* key, bool (Json::*isOfKind)() const) {
        if (row_.isObject() && row_.contains(key) && (row_.at(key).*isOfKind)()) {
            return &row_.at(key);
        }
        complain(key);
        return nullptr;
    }
    double inside(const char* key, double value, double low, double high) {
        return value >= low && value <= high ? value : (complain(key), low);
    }
    void complain(const char* key) { wrong_ = wrong_.empty() ? std::string("bad ") + key : wrong_; }

    const Json& row_;
    std::string wrong_;
};

Json rowOf(const MeasuredError& m) {
    Json row = toJson(m.sampling);
    row.update({{"volume", m.scene.volume},
                {"tf", m.scene.tf},
                {"fingerprint", m.scene.fingerprint},
                {"space", name(m.scene.space)},
                {"size", Json::list({m.size.x, m.size.y})},
                {"rmse", m.rmse},
                {"ms_per_megapixel", m.msPerMegapixel},
                {"commit", m.commit}});
    return row;
}

MeasuredError measuredIn(RowReader& row) {
    return {
        .scene = {row.text("volume"), row.text("tf"), row.text("fingerprint"),
                  row.named("space", {CompositingSpace::Display, CompositingSpace::Linear})},
        .size = row.size("size"),
        .sampling = {.layerSpacingVoxels = row.number("layer_spacing", 1e-3, 1e6),
                     .layersPerPlane =
                         static_cast<int>(row.number("layers_per_plane", 0, kMaxTotalLayers)),
                     .classification =
                         row.named("classify", {Classification::Post, Classification::Pre,
                                                Classification::Preintegrated}),
                     .target = row.named("target", {TargetFormat::Rgba8, TargetFormat::Rgba16f}),
                     .termination = row.orOff("termination", 0.0, 1.0),
                     .jitter = row.flag("jitter")},
        .rmse = row.number("rmse", 0.0, kMost),
        .msPerMegapixel = row.number("ms_per_megapixel", 0.0, kMost),
        .commit = row.text("commit")};
}

} // namespace

std::string errorTableText(const std::vector<MeasuredError>& table) {
    Json rows = Json::list();
    for (const MeasuredError& m : table) {
        rows.push_back(rowOf(m));
    }
    return Json{{"version", kVersion}, {"rows", std::move(rows)}}.dump(1) + "\n";
}

Result<std::vector<MeasuredError>> parseErrorTable(std::string_view text) {
    const Json content = Json::parse(text).value_or(Json());
    if (!content.isObject() || !content.contains("version") || !content.at("rows").isList()) {
        return fail(ErrorCode::FileUnreadable, "it is something else, or cut short");
    }
    if (content.at("version") != kVersion) {
        return fail(ErrorCode::FileUnreadable, "of another version");
    }
    std::vector<MeasuredError> table;
    for (const Json& row : content.at("rows")) {
        RowReader reader(row);
        table.push_back(measuredIn(reader));
        if (!reader.wrong().empty()) {
            return fail(ErrorCode::FileUnreadable, reader.wrong());
        }
    }
    return table;
}

std::vector<MeasuredError> refreshed(std::vector<MeasuredError> table,
                                     const std::vector<MeasuredError>& fresh) {
    std::erase_if(table, [&fresh](const MeasuredError& old) {
        return std::any_of(fresh.begin(), fresh.end(), [&old](const MeasuredError& now) {
            return now.commit != old.commit ||
                   (now.scene == old.scene && now.size == old.size && now.sampling == old.sampling);
        });
    });
    table.insert(table.end(), fresh.begin(), fresh.end());
    return table;
}

SceneLabel labelOf(const Stage& stage) {
    const Scene& scene = stage.scene();
    const glm::ivec3 dims = stage.info().dims;
    const std::string content =
        Json::list({statisticsKey(scene.statistics()), placementKey(scene.geometry()),
                    transferKey(scene.look().tf)})
            .dump();
    const auto edge = [](int length) { return std::to_string(length); };
    return {stage.info().name + " " + edge(dims.x) + "x" + edge(dims.y) + "x" + edge(dims.z),
            scene.look().tf.name, fingerprint(std::as_bytes(std::span(content))),
            scene.provided()->space};
}

bool hasUsualSettings(const StageDesc& desc) {
    const auto othersOf = [](const StageDesc& d) {
        const Settings& s = d.settings;
        return std::make_tuple(s.skip, s.tighten, s.lattice, s.form, s.skipOptions, d.exactTexels);
    };
    return othersOf(desc) == othersOf(StageDesc{});
}

} // namespace slabcast
