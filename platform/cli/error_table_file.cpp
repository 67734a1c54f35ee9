#include "platform/cli/error_table_file.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <sstream>

#include <fmt/core.h>

#include "perf/report_json.h"
#include "platform/cli/scene_key.h"
#include "platform/cli/scene_options.h"
#include "platform/io/atomic_file.h"

namespace slabcast {

namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr int kVersion = 2;

const Choices<CompositingSpace>& spaceWords() {
    static const Choices<CompositingSpace> words = {
        {name(CompositingSpace::Display), CompositingSpace::Display},
        {name(CompositingSpace::Linear), CompositingSpace::Linear}};
    return words;
}

json rowOf(const MeasuredError& m) {
    json row = toJson(m.sampling);
    row.update({{"volume", m.scene.volume},
                {"tf", m.scene.tf},
                {"fingerprint", m.scene.fingerprint},
                {"space", name(m.scene.space)},
                {"size", {m.size.x, m.size.y}},
                {"rmse", m.rmse},
                {"msPerMegapixel", m.msPerMegapixel},
                {"commit", m.commit}});
    return row;
}

// Reading: the library throws where a member is missing or of another type. Caught in
// readErrorTable().

template <class T>
T wordIn(const json& row, const char* key, const Choices<T>& choices) {
    const std::optional<T> value = choiceParser(choices)(row.at(key).get<std::string>());
    return value ? *value : throw std::runtime_error(fmt::format("{} is unknown", key));
}

double numberIn(const json& row, const char* key, double low, double high) {
    const double value = row.at(key).get<double>();
    return value >= low && value <= high ? value
                                         : throw std::runtime_error(fmt::format("bad {}", key));
}

MeasuredError measuredIn(const json& row) {
    constexpr double kMost = 1e300;
    const json& termination = row.at("termination");
    const Sampling sampling{
        .layerSpacingVoxels = numberIn(row, "spacing", kLeastSpacing, kMostSpacing),
        .layersPerPlane = static_cast<int>(numberIn(row, "layers", 0, kMaxLayers)),
        .classification = wordIn(row, "classification", classificationWords()),
        .target = wordIn(row, "target", targetWords()),
        .termination = termination == "off" ? std::nullopt
                                            : std::optional(numberIn(row, "termination", 0.0, 1.0)),
        .jitter = row.at("jitter").get<bool>()};
    return {.scene = {row.at("volume"), row.at("tf"), row.at("fingerprint"),
                      wordIn(row, "space", spaceWords())},
            .size = {row.at("size").at(0).get<int>(), row.at("size").at(1).get<int>()},
            .sampling = sampling,
            .rmse = numberIn(row, "rmse", 0.0, kMost),
            .msPerMegapixel = numberIn(row, "msPerMegapixel", 0.0, kMost),
            .commit = row.at("commit")};
}

} // namespace

Result<fs::path> errorTablePath(const gl::Caps& caps) {
    const auto folderIn = [](const char* variable) {
        const char* value = std::getenv(variable);
        return fs::path(value == nullptr ? "" : value);
    };
    fs::path cache = folderIn("XDG_CACHE_HOME");
    if (cache.empty() && !folderIn("HOME").empty()) {
        cache = folderIn("HOME") / ".cache";
    }
    if (cache.empty()) {
        return fail(ErrorCode::InvalidArgument, "there is no place for the table of measured "
                                                "errors: set XDG_CACHE_HOME or HOME");
    }
    std::string file = "error-table";
    bool apart = true;
    for (const unsigned char c : caps.renderer) {
        if (std::isalnum(c) != 0) {
            file += std::string(apart ? "-" : "") + static_cast<char>(std::tolower(c));
        }
        apart = std::isalnum(c) == 0;
    }
    return cache / "slabcast" / (file + ".json");
}

Result<std::vector<MeasuredError>> readErrorTable(const fs::path& path) {
    std::error_code ignored; // what cannot be asked after cannot be read either: said below
    if (fs::status(path, ignored).type() == fs::file_type::not_found) {
        return std::vector<MeasuredError>{};
    }
    try {
        std::ifstream file(path);
        if (!file) {
            throw std::runtime_error("it cannot be read");
        }
        const json content = json::parse(file);
        if (content.at("version") != kVersion) {
            throw std::runtime_error("of another version");
        }
        std::vector<MeasuredError> table;
        for (const json& row : content.at("rows")) {
            table.push_back(measuredIn(row));
        }
        return table;
    } catch (const std::exception& problem) {
        std::string_view what = problem.what();
        what.remove_prefix(what.front() == '[' ? what.find("] ") + 2 : 0); // the library's own tag
        return fail(ErrorCode::FileUnreadable,
                    fmt::format("{}: no table of measured errors ({}): delete it and run "
                                "`slabcast error` anew",
                                path.string(), what.substr(0, what.find('\n'))));
    }
}

Result<void> writeErrorTable(const fs::path& path, const std::vector<MeasuredError>& table) {
    json rows = json::array();
    for (const MeasuredError& m : table) {
        rows.push_back(rowOf(m));
    }
    std::error_code ignored; // what cannot be made is reported as a folder that is not there
    fs::create_directories(path.parent_path(), ignored);
    return writeFileAtomically(
        path, json{{"version", kVersion}, {"rows", std::move(rows)}}.dump(1) + "\n");
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
    const std::string content = json{statisticsKey(scene.statistics()),
                                     placementKey(scene.geometry()), transferKey(scene.look().tf)}
                                    .dump();
    return {fmt::format("{} {}x{}x{}", stage.info().name, dims.x, dims.y, dims.z),
            scene.look().tf.name, fingerprint(std::as_bytes(std::span(content))),
            scene.look().space};
}

} // namespace slabcast
