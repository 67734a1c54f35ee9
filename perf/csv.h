#pragma once

#include <initializer_list>
#include <span>
#include <string>
#include <vector>

#include "perf/json.h"

namespace slabcast {

/// One column of a table: its heading, and where its value lies in a row (a JSON pointer).
struct CsvColumn {
    const char* heading;
    const char* pointer;
};

/// The times and counters of rows that have them as `frameMs` and `counters`.
inline constexpr CsvColumn kMeasuredColumns[] = {{"frame_ms_median", "/frame_ms/median"},
                                                 {"frame_ms_min", "/frame_ms/min"},
                                                 {"frame_ms_max", "/frame_ms/max"},
                                                 {"frame_ms_p10", "/frame_ms/p10"},
                                                 {"frame_ms_p90", "/frame_ms/p90"},
                                                 {"frame_ms_n", "/frame_ms/n"},
                                                 {"fragments", "/counters/fragments"},
                                                 {"layers_evaluated", "/counters/layers_evaluated"},
                                                 {"layers_skipped", "/counters/layers_skipped"},
                                                 {"volume_fetches", "/counters/volume_fetches"},
                                                 {"skip_fetches", "/counters/skip_fetches"},
                                                 {"stretches", "/counters/stretches"},
                                                 {"blocks_visited", "/counters/blocks_visited"}};

/// One table's columns from those of its parts.
std::vector<CsvColumn> columnsOf(std::initializer_list<std::span<const CsvColumn>> parts);

/// A line per row, after the headings; empty where a value is null or missing. Text is quoted where
/// it holds what separates cells or lines. Tested by: error_grid_test.cpp
std::string csvOf(const Json& rows, std::span<const CsvColumn> columns);

} // namespace slabcast
