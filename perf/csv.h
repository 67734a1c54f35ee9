#pragma once

#include <initializer_list>
#include <span>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

namespace slabcast {

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
                                                 {"layers_evaluated", "/counters/layersEvaluated"},
                                                 {"layers_skipped", "/counters/layersSkipped"},
                                                 {"volume_fetches", "/counters/volumeFetches"},
                                                 {"skip_fetches", "/counters/skipFetches"},
                                                 {"stretches", "/counters/stretches"},
                                                 {"blocks_visited", "/counters/blocksVisited"}};

/// One table's columns from those of its parts.
std::vector<CsvColumn> columnsOf(std::initializer_list<std::span<const CsvColumn>> parts);

/// A line per row, after the headings; empty where a value is null or missing. Text is quoted where
/// it holds what separates cells or lines. Tested by: error_grid_test.cpp
std::string csvOf(const nlohmann::json& rows, std::span<const CsvColumn> columns);

} // namespace slabcast
