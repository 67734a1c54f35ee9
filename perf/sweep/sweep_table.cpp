#include "perf/sweep/sweep_table.h"

#include <optional>

#include "core/base/error.h"
#include "perf/csv.h"
#include "perf/report_json.h"

namespace slabcast {

namespace {

constexpr CsvColumn kColumns[] = {
    {"planes", "/planes"},
    {"layers_per_plane", "/layers_per_plane"},
    {"form", "/form"},
    {"skip", "/skip"},
    {"tighten", "/tighten"},
    {"classify", "/classify"},
    {"termination", "/termination"},
    {"lattice", "/lattice"},
    {"jitter", "/jitter"},
    {"variant", "/variant"},
    {"compile_ms", "/compile_ms"},
    {"first_frame_ms", "/first_frame_ms"},
    {"speedup_over_slicing", "/speedup_over_slicing"},
    {"speedup_over_slicing_low", "/speedup_over_slicing_low"},
    {"speedup_over_slicing_high", "/speedup_over_slicing_high"},
    {"speedup_over_plain", "/speedup_over_plain"},
    {"speedup_over_plain_low", "/speedup_over_plain_low"},
    {"speedup_over_plain_high", "/speedup_over_plain_high"},
    {"speedup_over_plain_slicing", "/speedup_over_plain_slicing"},
    {"speedup_over_plain_slicing_low", "/speedup_over_plain_slicing_low"},
    {"speedup_over_plain_slicing_high", "/speedup_over_plain_slicing_high"},
    {"speedup_coverage", "/speedup_coverage"},
    {"model_g71_ms", "/model/g71/frame_ms"},
    {"model_g52_ms", "/model/g52/frame_ms"},
    {"model_g57_ms", "/model/g57/frame_ms"},
    {"model_adreno630_ms", "/model/adreno630/frame_ms"},
    {"model_adreno650_ms", "/model/adreno650/frame_ms"},
    {"model_adreno660_ms", "/model/adreno660/frame_ms"},
    {"model_adreno740_ms", "/model/adreno740/frame_ms"}};

/// The first row of a series with so many layers per plane.
std::optional<std::size_t> rowAt(std::span<const SweepPlace> places, int series, int layers) {
    for (std::size_t k = 0; k < places.size(); ++k) {
        if (places[k].series == series && places[k].layersPerPlane == layers) {
            return k;
        }
    }
    return std::nullopt;
}

} // namespace

void addTimes(Json& rows, std::span<const SweepPlace> places, const Laps& laps) {
    SLABCAST_EXPECTS(rows.size() == places.size() && laps.size() == places.size(), laps.size());
    for (std::size_t k = 0; k < places.size(); ++k) {
        Json& row = rows[k];
        row["frame_ms"] = toJson(summarise(laps[k]));
        row["samples"] = Json::listOf(laps[k]);
        const struct {
            const char* name;
            std::optional<std::size_t> other;
        } ratios[] = {
            {"speedup_over_slicing", rowAt(places, places[k].series, 1)},
            {"speedup_over_plain", rowAt(places, 0, places[k].layersPerPlane)},
            {"speedup_over_plain_slicing", rowAt(places, 0, 1)},
        };
        for (const auto& [name, other] : ratios) {
            if (other) {
                addRatio(row, name, pairedRatio(laps[*other], laps[k]), "speedup_coverage");
            }
        }
    }
}

std::string sweepCsv(const Json& rows) {
    return csvOf(rows, columnsOf({kColumns, kMeasuredColumns}));
}

} // namespace slabcast
