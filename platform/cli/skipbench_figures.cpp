#include "platform/cli/skipbench_figures.h"

#include <algorithm>
#include <optional>
#include <vector>

#include <fmt/format.h>

#include "perf/frame_times.h"
#include "platform/cli/skipbench_race.h"

namespace slabcast {

namespace {

using nlohmann::json;
using Value = std::optional<double>;

/// All that has these values.
std::vector<const json*> rowsWith(const json& rows, const json& keys) {
    std::vector<const json*> found;
    for (const json& row : rows) {
        const bool alike = std::all_of(keys.items().begin(), keys.items().end(), [&](auto item) {
            return row.contains(item.key()) && row[item.key()] == item.value();
        });
        if (alike) {
            found.push_back(&row);
        }
    }
    return found;
}

const json* rowWith(const json& rows, const json& keys) {
    const std::vector<const json*> found = rowsWith(rows, keys);
    return found.empty() ? nullptr : found.front();
}

Value numberAt(const json* row, const char* pointer) {
    const json::json_pointer place(pointer);
    const bool there = row != nullptr && row->contains(place) && row->at(place).is_number();
    return there ? Value(row->at(place).get<double>()) : std::nullopt;
}

Value quotient(Value a, Value b) {
    return a && b && *b > 0.0 ? Value(*a / *b) : std::nullopt;
}

/// Null where there is none.
const json* fastest(const std::vector<const json*>& rows) {
    const json* best = nullptr;
    for (const json* row : rows) {
        if (numberAt(row, "/speedup").value_or(0.0) > numberAt(best, "/speedup").value_or(0.0)) {
            best = row;
        }
    }
    return best;
}

/// Time of one row over another's of the same race.
Value pairedTimes(const json* a, const json* b) {
    if (a == nullptr || b == nullptr) {
        return std::nullopt;
    }
    return pairedRatio(a->at("samples").get<std::vector<double>>(),
                       b->at("samples").get<std::vector<double>>());
}

enum class Goal { AtLeast, AtMost };

/// `key`: of summaries, for programs; `name`: for people.
json figure(std::string key, std::string name, const json& volume, Value value,
            std::optional<double> goal, Goal sense, std::string from) {
    json reached;
    if (value && goal) {
        reached = sense == Goal::AtLeast ? *value >= *goal : *value <= *goal;
    }
    return {{"key", std::move(key)},
            {"name", std::move(name)},
            {"volume", volume["name"]},
            {"value", value ? json(*value) : json()},
            {"goal", goal ? json(*goal) : json()},
            {"sense", sense == Goal::AtLeast ? ">=" : "<="},
            {"reached", std::move(reached)},
            {"from", std::move(from)}};
}

/// As keys have it: "early exit" is early_exit.
std::string keyOf(std::string words) {
    std::replace(words.begin(), words.end(), ' ', '_');
    return words;
}

/// Skull CT under bone is what most goals were set for.
bool isBone(const json& volume) {
    return volume["modality"] == "ct" && volume["transferFunction"] == "CT bone";
}

std::optional<double> goalIf(bool meant, double goal) {
    return meant ? std::optional(goal) : std::nullopt;
}

/// Ray casting of one volume.
struct RayCasting {
    const json& rows;
    const json& volume;

    const json* row(const char* structure, const char* mode) const {
        return rowWith(rows, {{"table", "frames"},
                              {"volume", volume["name"]},
                              {"family", "ray casting"},
                              {"mode", mode},
                              {"structure", structure}});
    }
    const json* distanceMap(const char* mode) const {
        return fastest({row("proximity", mode), row("chebyshev", mode)});
    }
    Value ofDistanceMap(const char* structure) const {
        return pairedTimes(row(structure, "marching only"), distanceMap("marching only"));
    }
};

void addRayCasting(json& figures, const json& rows, const json& volume) {
    const RayCasting cast{rows, volume};
    const bool bone = isBone(volume);
    for (const auto& [mode, goal] : {std::pair{"marching only", 2.0}, {"early exit", 3.0}}) {
        const json* map = cast.distanceMap(mode);
        figures.push_back(figure(
            fmt::format("distance_map_{}_speedup", keyOf(mode)),
            fmt::format("distance map against none, {}", mode), volume, numberAt(map, "/speedup"),
            goalIf(bone, goal), Goal::AtLeast,
            fmt::format("times as fast; {}", map ? map->value("structure", "") : "not measured")));
    }
    const Value bitfield = cast.ofDistanceMap("bitfield-octree");
    const Value minMax = cast.ofDistanceMap("minmax-octree");
    figures.push_back(figure("bitfield_octree_over_distance_map_time",
                             "bitfield octree against the distance map, marching only", volume,
                             bitfield, goalIf(bone, 1.7), Goal::AtMost, "its time over the map's"));
    figures.push_back(figure("bitfield_octree_over_minmax_octree_time",
                             "bitfield octree against the min-max octree, marching only", volume,
                             quotient(bitfield, minMax), goalIf(bone, 1.0), Goal::AtMost,
                             "as multiples of the distance map's time"));
}

void addBlocks(json& figures, const json& rows, const json& volume) {
    const auto work = [&](const char* structure, const char* counter) {
        return numberAt(
            rowWith(rows,
                    {{"table", "work"}, {"volume", volume["name"]}, {"structure", structure}}),
            counter);
    };
    const bool gap = volume["input"].get<std::string>().starts_with("phantom:gap");
    const struct {
        const char* name;
        const char* counter;
        const char* from;
        std::optional<double> goal;
    } kinds[] = {
        {"blocks visited", "/counters/blocks_visited",
         "leaves marched through, since they may show something, along all rays", goalIf(gap, 0.6)},
        {"blocks looked at", "/counters/stretches", "those, and nodes leapt over", std::nullopt}};
    for (const auto& kind : kinds) {
        figures.push_back(figure(
            fmt::format("bitfield_octree_over_minmax_octree_{}", keyOf(kind.name)),
            fmt::format("bitfield octree against the min-max octree, {}", kind.name), volume,
            quotient(work("bitfield-octree", kind.counter), work("minmax-octree", kind.counter)),
            kind.goal, Goal::AtMost, fmt::format("{}; leaves of 4 voxels, 32 bits", kind.from)));
    }
}

/// The best of these rows against none at its best ratio.
/// Rows of the hybrid of a mode, with planes of the one kind or the other, that skip or do not.
std::vector<const json*> hybrids(const json& rows, const json& volume, const char* mode,
                                 bool tighten, bool skip) {
    std::vector<const json*> found = rowsWith(rows, {{"table", "frames"},
                                                     {"volume", volume["name"]},
                                                     {"family", "hybrid"},
                                                     {"mode", mode},
                                                     {"tighten", tighten}});
    std::erase_if(found, [=](const json* row) { return ((*row)["structure"] != "none") != skip; });
    return found;
}

void addHybrid(json& figures, const json& rows, const json& volume) {
    // Rectangles come from a structure, but what does not skip has them too unless told otherwise.
    const struct {
        const char* key;
        const char* name;
        bool tightWith, tightWithout;
        std::optional<double> goal;
    } kinds[] = {
        {"rectangles", "both with planes as rectangles", true, true, goalIf(isBone(volume), 2.0)},
        {"sphere", "both with planes of the sphere", false, false, std::nullopt},
        {"structure", "planes as rectangles, against none of the sphere", true, false,
         std::nullopt},
    };
    for (const char* mode : {"early exit", "marching only"}) {
        for (const auto& kind : kinds) {
            const json* best = fastest(hybrids(rows, volume, mode, kind.tightWith, true));
            const json* none = fastest(hybrids(rows, volume, mode, kind.tightWithout, false));
            const std::string by =
                best ? fmt::format("{}, {} layers a plane", best->value("structure", ""),
                                   best->value("layersPerPlane", 0))
                     : "not measured";
            figures.push_back(
                figure(fmt::format("hybrid_{}_{}_speedup", keyOf(mode), kind.key),
                       fmt::format("hybrid against its own best without, {}, {}", mode, kind.name),
                       volume, pairedTimes(none, best), kind.goal, Goal::AtLeast,
                       "times as fast, each at its best ratio; " + by));
        }
    }
}

void addMerging(json& figures, const json& rows, const json& volume) {
    for (const int edge : {4, 2, 1}) {
        std::vector<double> speedups;
        for (const json* row : rowsWith(rows, {{"table", "merge"},
                                               {"volume", volume["name"]},
                                               {"blockEdge", edge},
                                               {"partitions", 16}})) {
            speedups.push_back(row->at("speedup").get<double>());
        }
        const FrameTimes all = summarise(speedups); // no times, but a median all the same
        const bool any = !speedups.empty();
        figures.push_back(figure(
            fmt::format("merge_16_speedup_edge_{}", edge),
            fmt::format("merging 16 partitions against rebuilding, blocks of {}", edge), volume,
            any ? Value(all.median) : std::nullopt, goalIf(edge == 4, 10.0), Goal::AtLeast,
            any ? fmt::format("times as fast, median of {} transfer functions ({:.3g} to {:.3g})",
                              speedups.size(), all.min, all.max)
                : "not measured: over the memory budget"));
    }
}

void addBuilds(json& figures, const json& rows, const json& volume) {
    const json sized = {{"table", "sizes"}, {"volume", volume["name"]}};
    if (rowWith(rows, sized) == nullptr) {
        return; // another volume was resampled
    }
    json octree = sized;
    octree.update({{"edge", 256}, {"structure", "bitfield-octree"}});
    const json* row = rowWith(rows, octree); // none where 256 is not among the sizes
    constexpr double kVoxels = 256.0 * 256.0 * 256.0;
    figures.push_back(
        figure("bitfield_octree_256_build_ms", "bitfield octree of 256^3, build", volume,
               numberAt(row, "/buildMs/median"), 60.0, Goal::AtMost,
               fmt::format("ms on the processor, from codes that took {:.3g} ms; leaves of "
                           "4 voxels, 32 bits",
                           numberAt(row, "/codesMs").value_or(0.0))));
    figures.push_back(figure("bitfield_octree_256_memory_share", "bitfield octree of 256^3, memory",
                             volume, quotient(numberAt(row, "/gpuBytes"), 2.0 * kVoxels), 0.05,
                             Goal::AtMost, "of a 16-bit volume's"));
}

} // namespace

json figuresOf(const json& volumes, const json& rows) {
    json figures = json::array();
    for (const json& volume : volumes) {
        addRayCasting(figures, rows, volume);
        addBlocks(figures, rows, volume);
        addHybrid(figures, rows, volume);
        addMerging(figures, rows, volume);
        addBuilds(figures, rows, volume);
    }
    return figures;
}

json summaryOf(const json& figures) {
    json volumes = json::object();
    int reached = 0;
    int judged = 0;
    for (const json& figure : figures) {
        judged += !figure["reached"].is_null();
        reached += figure["reached"] == true;
        volumes[figure["volume"].get<std::string>()][figure["key"].get<std::string>()] = {
            {"value", figure["value"]},
            {"goal", figure["goal"]},
            {"sense", figure["sense"]},
            {"reached", figure["reached"]}};
    }
    return {{"judged", judged}, {"reached", reached}, {"volumes", std::move(volumes)}};
}

std::string lineOf(const json& summary, const json& figures) {
    std::string missed;
    for (const json& figure : figures) {
        if (figure["reached"] == false) {
            missed += fmt::format(
                "; {} ({}): {:.3g} {} {:g} does not hold", figure["name"].get<std::string>(),
                figure["volume"].get<std::string>(), figure["value"].get<double>(),
                figure["sense"].get<std::string>(), figure["goal"].get<double>());
        }
    }
    return fmt::format("summary: {} of {} figures reached{}", summary["reached"].get<int>(),
                       summary["judged"].get<int>(), missed);
}

} // namespace slabcast
