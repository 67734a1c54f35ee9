#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <glm/glm.hpp>
#include <nlohmann/json.hpp>

#include "platform/cli/draw.h"

namespace slabcast {

// What commands that measure into a folder have in common.

/// Makes the folder, and those above it. Fails: FileUnwritable, naming --out.
Result<void> makeReportFolder(const std::filesystem::path& folder);

std::string timestamp(); // now, as 2026-11-24T10:00:00Z

/// What was run, of which build, when, where and on what: what every report begins with.
nlohmann::json reportHeader(const Stage& stage, const std::string& command);

/// One column of a table: its heading, and where its value lies in a row (a JSON pointer).
struct CsvColumn {
    const char* heading;
    const char* pointer;
};

/// The times and counters of rows that have them as `frameMs` and `counters`.
inline constexpr CsvColumn kMeasuredColumns[] = {{"frame_ms_median", "/frameMs/median"},
                                                 {"frame_ms_min", "/frameMs/min"},
                                                 {"frame_ms_max", "/frameMs/max"},
                                                 {"frame_ms_p10", "/frameMs/p10"},
                                                 {"frame_ms_p90", "/frameMs/p90"},
                                                 {"frame_ms_n", "/frameMs/n"},
                                                 {"fragments", "/counters/fragments"},
                                                 {"layers_evaluated", "/counters/layers_evaluated"},
                                                 {"layers_skipped", "/counters/layers_skipped"},
                                                 {"volume_fetches", "/counters/volume_fetches"},
                                                 {"skip_fetches", "/counters/skip_fetches"},
                                                 {"stretches", "/counters/stretches"},
                                                 {"blocks_visited", "/counters/blocks_visited"}};

/// One table's columns from those of its parts.
std::vector<CsvColumn> columnsOf(std::initializer_list<std::span<const CsvColumn>> parts);

/// A line per row; empty where a value is null or missing.
std::string csvOf(const nlohmann::json& rows, std::span<const CsvColumn> columns);

struct SmallPicture {
    glm::ivec2 size{0};
    std::vector<glm::vec4> pixels;
};

/// Box-filtered to an edge that suits a page.
SmallPicture thumbnail(glm::ivec2 size, const std::vector<glm::vec4>& picture);

/// The page is made by a script from the JSON, so that it can be made again: `script` is its name
/// in perf/. Fails: FileUnwritable, saying that `written` are there and how to make the page.
Result<void> writePage(const std::filesystem::path& folder, const std::string& script,
                       const std::string& written);

} // namespace slabcast
