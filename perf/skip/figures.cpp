#include "perf/skip/figures.h"

#include <functional>

#include "perf/frame_times.h"
#include "perf/number.h"
#include "perf/report_json.h"
#include "perf/skip/row.h"

namespace slabcast::skipbench {

namespace {

using Value = std::optional<double>;
using Rows = std::vector<const Row*>;

/// The rows of one volume, and the figures that they give.
struct Judged {
    std::span<const Row> rows;
    const VolumeRecord& volume;
    std::vector<Figure>& figures;

    Rows where(Table table, const std::function<bool(const Row&)>& holds) const {
        Rows found;
        for (const Row& row : rows) {
            if (row.table == table && row.volume == volume.name && holds(row)) {
                found.push_back(&row);
            }
        }
        return found;
    }
    const Row* firstWhere(Table table, const std::function<bool(const Row&)>& holds) const {
        const Rows found = where(table, holds);
        return found.empty() ? nullptr : found.front();
    }
    void add(Figure figure) const {
        figure.volume = volume.name;
        figures.push_back(std::move(figure));
    }
};

Value quotient(Value a, Value b) {
    return a && b && *b > 0.0 ? Value(*a / *b) : std::nullopt;
}

Value speedupOf(const Row* row) {
    return row != nullptr && row->raced ? Value(row->raced->speedup.median) : std::nullopt;
}

/// Null where there is none.
const Row* fastest(const Rows& rows) {
    const Row* best = nullptr;
    for (const Row* row : rows) {
        if (speedupOf(row).value_or(0.0) > speedupOf(best).value_or(0.0)) {
            best = row;
        }
    }
    return best;
}

using Paired = std::optional<PairedRatio>;

/// Time of one row over another's of the same race.
Paired pairedTimes(const Row* a, const Row* b) {
    const bool both = a != nullptr && b != nullptr && a->raced && b->raced;
    return both ? Paired(pairedRatio(a->raced->samples, b->raced->samples)) : std::nullopt;
}

Value valueOf(const Paired& ratio) {
    return ratio ? Value(ratio->median) : std::nullopt;
}

std::optional<MedianInterval> intervalOf(const Paired& ratio) {
    return ratio ? std::optional(ratio->interval) : std::nullopt;
}

Paired speedupRatio(const Row* row) {
    return row != nullptr && row->raced ? Paired(row->raced->speedup) : std::nullopt;
}

/// What most goals were set for.
bool isBone(const VolumeRecord& volume) {
    return volume.own == OwnScene::Skull;
}

bool isOwn(const VolumeRecord& volume) {
    return volume.own != OwnScene::None;
}

Value goalIf(bool meant, double goal) {
    return meant ? Value(goal) : std::nullopt;
}

bool isMode(const Row& row, const Mode& mode) {
    return row.mode != nullptr && std::string_view(row.mode) == mode.name;
}

bool isFamily(const Row& row, const char* family) {
    return row.family != nullptr && std::string_view(row.family) == family;
}

Rows castBy(const Judged& judged, SkipStructure structure, const Mode& mode) {
    return judged.where(Table::Frames, [&](const Row& row) {
        return isFamily(row, kRayCasting) && isMode(row, mode) &&
               row.options.structure == structure;
    });
}

/// The faster one.
const Row* distanceMap(const Judged& judged, const Mode& mode) {
    Rows maps = castBy(judged, SkipStructure::Proximity, mode);
    for (const Row* row : castBy(judged, SkipStructure::Chebyshev, mode)) {
        maps.push_back(row);
    }
    return fastest(maps);
}

/// Marching only; null where it was not measured.
const Row* marched(const Judged& judged, SkipStructure structure) {
    const Rows rows = castBy(judged, structure, kMarchingOnly);
    return rows.empty() ? nullptr : rows.front();
}

void addRayCasting(const Judged& judged) {
    const bool bone = isBone(judged.volume);
    for (const auto& [mode, goal] : {std::pair{kMarchingOnly, 2.0}, {kEarlyExit, 3.0}}) {
        const Row* map = distanceMap(judged, mode);
        judged.add({.key = keyOf(std::string("distance map ") + mode.name + " speedup"),
                    .name = std::string("distance map against none, ") + mode.name,
                    .value = speedupOf(map),
                    .interval = intervalOf(speedupRatio(map)),
                    .goal = goalIf(bone, goal),
                    .from = std::string("times as fast; ") +
                            (map != nullptr ? name(map->options.structure) : "not measured")});
    }
    const Row* octree = marched(judged, SkipStructure::BitfieldOctree);
    const Paired bitfield = pairedTimes(octree, distanceMap(judged, kMarchingOnly));
    const Paired octrees = pairedTimes(octree, marched(judged, SkipStructure::MinMaxOctree));
    judged.add({.key = "bitfield_octree_over_distance_map_time",
                .name = "bitfield octree against the distance map, marching only",
                .value = valueOf(bitfield),
                .interval = intervalOf(bitfield),
                .goal = goalIf(bone, 1.7),
                .sense = Sense::AtMost,
                .from = "its time over the map's"});
    judged.add({.key = "bitfield_octree_over_minmax_octree_time",
                .name = "bitfield octree against the min-max octree, marching only",
                .value = valueOf(octrees),
                .interval = intervalOf(octrees),
                .goal = goalIf(bone, 1.0),
                .sense = Sense::AtMost,
                .from = "its time over the other's"});
}

void addBlocks(const Judged& judged) {
    const auto work = [&](SkipStructure structure, std::int64_t WorkCounters::*counter) -> Value {
        const Row* row = judged.firstWhere(
            Table::Work, [&](const Row& r) { return r.options.structure == structure; });
        const bool counted = row != nullptr && row->counters && *row->counters;
        return counted ? Value(static_cast<double>(**row->counters.*counter)) : std::nullopt;
    };
    const bool gap = isOwn(judged.volume) && judged.volume.input.starts_with("phantom:gap");
    const struct {
        const char* name;
        std::int64_t WorkCounters::*counter;
        const char* from;
        Value goal;
    } kinds[] = {{"blocks visited", &WorkCounters::blocksVisited,
                  "leaves marched through, since they may show something, along all rays",
                  goalIf(gap, 0.6)},
                 {"blocks looked at", &WorkCounters::stretches, "those, and nodes leapt over",
                  std::nullopt}};
    for (const auto& kind : kinds) {
        judged.add({.key = keyOf(std::string("bitfield octree over minmax octree ") + kind.name),
                    .name = std::string("bitfield octree against the min-max octree, ") + kind.name,
                    .value = quotient(work(SkipStructure::BitfieldOctree, kind.counter),
                                      work(SkipStructure::MinMaxOctree, kind.counter)),
                    .goal = kind.goal,
                    .sense = Sense::AtMost,
                    .from = std::string(kind.from) + "; leaves of 4 voxels, 32 bits"});
    }
}

/// The fastest hybrid of a mode, with planes of the one kind or the other, that skips or does not.
const Row* fastestHybrid(const Judged& judged, const Mode& mode, bool tighten, bool skips) {
    return fastest(judged.where(Table::Frames, [&](const Row& row) {
        return isFamily(row, kHybrid) && isMode(row, mode) && row.plan &&
               row.plan->tighten == tighten &&
               (row.options.structure != SkipStructure::None) == skips;
    }));
}

void addHybrid(const Judged& judged) {
    // Rectangles come from a structure, but what does not skip has them too unless told otherwise.
    const struct {
        const char* key;
        const char* name;
        bool tightWith, tightWithout;
        Value goal;
    } kinds[] = {
        {"rectangles", "both with planes as rectangles", true, true,
         goalIf(isBone(judged.volume), 2.0)},
        {"sphere", "both with planes of the sphere", false, false, std::nullopt},
        {"structure", "planes as rectangles, against none of the sphere", true, false,
         std::nullopt},
    };
    for (const Mode& mode : {kEarlyExit, kMarchingOnly}) {
        for (const auto& kind : kinds) {
            const Row* best = fastestHybrid(judged, mode, kind.tightWith, true);
            const Row* none = fastestHybrid(judged, mode, kind.tightWithout, false);
            const Paired speedup = pairedTimes(none, best);
            const std::string by = best == nullptr
                                       ? "not measured"
                                       : std::string(name(best->options.structure)) + ", " +
                                             std::to_string(best->plan->layersPerPlane) +
                                             " layers a plane";
            judged.add(
                {.key = keyOf(std::string("hybrid ") + mode.name + " " + kind.key + " speedup"),
                 .name = std::string("hybrid against its own best without, ") + mode.name + ", " +
                         kind.name,
                 .value = valueOf(speedup),
                 .interval = intervalOf(speedup),
                 .goal = kind.goal,
                 .from = "times as fast, each at its best ratio; " + by});
        }
    }
}

void addMerging(const Judged& judged) {
    for (const int edge : {4, 2, 1}) {
        std::vector<double> speedups;
        for (const Row* row : judged.where(Table::Merge, [edge](const Row& r) {
                 return r.merge && r.options.blockEdgeVoxels == edge && r.options.partitions == 16;
             })) {
            speedups.push_back(row->merge->speedup.median);
        }
        const FrameTimes all = summarise(speedups); // no times, but a median all the same
        const bool any = !speedups.empty();
        const std::string from =
            any ? "times as fast, median of " + std::to_string(speedups.size()) +
                      " transfer functions (" + number(all.min) + " to " + number(all.max) + ")"
                : "not measured: over the memory budget";
        judged.add(
            {.key = "merge_16_speedup_edge_" + std::to_string(edge),
             .name = "merging 16 partitions against rebuilding, blocks of " + std::to_string(edge),
             .value = any ? Value(all.median) : std::nullopt,
             .goal = goalIf(edge == 4 && isOwn(judged.volume), 10.0),
             .from = from});
    }
}

void addBuilds(const Judged& judged) {
    if (!judged.firstWhere(Table::Sizes, [](const Row&) { return true; })) {
        return; // another volume was resampled
    }
    constexpr int kEdge = 256;
    constexpr double kVoxels = 1.0 * kEdge * kEdge * kEdge;
    const Row* row = judged.firstWhere(Table::Sizes, [](const Row& r) {
        return r.cube && r.cube->edge == kEdge &&
               r.options.structure == SkipStructure::BitfieldOctree;
    }); // none where it is not among the sizes
    const bool built = row != nullptr && row->build && row->build->refused.empty();
    judged.add({.key = "bitfield_octree_256_build_ms",
                .name = "bitfield octree of 256^3, build",
                .value = built ? Value(summarise(row->build->ms).median) : std::nullopt,
                .goal = goalIf(isOwn(judged.volume), 60.0),
                .sense = Sense::AtMost,
                .from = "ms on the processor, from codes that took " +
                        number(row != nullptr ? row->cube->codesMs : 0.0) +
                        " ms; leaves of 4 voxels, 32 bits"});
    judged.add(
        {.key = "bitfield_octree_256_memory_share",
         .name = "bitfield octree of 256^3, memory",
         .value = built ? Value(static_cast<double>(row->build->memory.gpuBytes) / (2.0 * kVoxels))
                        : std::nullopt,
         .goal = goalIf(isOwn(judged.volume), 0.05),
         .sense = Sense::AtMost,
         .from = "of a 16-bit volume's"});
}

} // namespace

std::optional<bool> Figure::reached() const {
    if (!value || !goal) {
        return std::nullopt;
    }
    return sense == Sense::AtLeast ? *value >= *goal : *value <= *goal;
}

const char* name(Sense sense) {
    return sense == Sense::AtLeast ? ">=" : "<=";
}

std::vector<Figure> figuresOf(std::span<const VolumeRecord> volumes, std::span<const Row> rows) {
    std::vector<Figure> figures;
    for (const VolumeRecord& volume : volumes) {
        const Judged judged{rows, volume, figures};
        for (const auto add : {addRayCasting, addBlocks, addHybrid, addMerging, addBuilds}) {
            add(judged);
        }
    }
    return figures;
}

Tally tallyOf(std::span<const Figure> figures) {
    Tally tally;
    for (const Figure& figure : figures) {
        tally.judged += figure.reached().has_value();
        tally.reached += figure.reached() == true;
    }
    return tally;
}

std::string lineOf(std::span<const Figure> figures) {
    const Tally tally = tallyOf(figures);
    std::string line = "summary: " + std::to_string(tally.reached) + " of " +
                       std::to_string(tally.judged) + " figures reached";
    for (const Figure& figure : figures) {
        if (figure.reached() == false) {
            line += "; " + figure.name + " (" + figure.volume + "): " + number(*figure.value) +
                    " " + name(figure.sense) + " " + number(*figure.goal, 6) + " does not hold";
        }
    }
    return line;
}

} // namespace slabcast::skipbench
