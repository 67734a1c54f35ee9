#include "platform/cli/skipbench_merging.h"

#include <algorithm>
#include <array>
#include <optional>

#include <fmt/core.h>

#include "core/base/stopwatch.h"
#include "core/skip/chebyshev.h"
#include "core/skip/occupancy.h"
#include "core/skip/proximity_cloud.h"
#include "perf/frame_times.h"
#include "perf/report_json.h"
#include "platform/cli/skipbench_race.h"
#include "platform/json/transfer_json.h"

namespace slabcast {

namespace {

using nlohmann::json;

constexpr std::array kEdges{4, 2, 1};
constexpr std::array kPartitions{16, 32, 64, 128, 256};
constexpr double kOpacity = 0.1;
/// What counts as the minimum, of the range: a table's texel is a 4096th of it at best, and a TF
/// shows a texel more than it says.
constexpr double kMinimumShare = 1.0 / 512.0;

struct NamedTransfer {
    std::string key; // as in Rauter et al. 2024, figure 3
    std::string what;
    TransferFunction tf;
};

/// Visible from each first to each second part of the range, 0 to 1, and nowhere else.
TransferFunction bands(const VolumeStatistics& s, std::vector<std::array<double, 2>> visible) {
    TransferFunction tf;
    const double range = std::max(s.max - s.min, 1e-6);
    const auto add = [&](double part, double opacity) {
        tf.points.push_back({s.min + part * range, glm::dvec3(1.0), opacity});
    };
    for (const auto [from, to] : visible) {
        if (from > 0.0) {
            add(from, 0.0);
        }
        add(from, kOpacity);
        add(to, kOpacity);
        if (to < 1.0) {
            add(to, 0.0);
        }
    }
    return tf;
}

/// A preset that suits the volume's kind and is not what it is shown with already.
Result<TransferFunction> otherPreset(const Scene& scene, Modality modality) {
    const bool ct = modality == Modality::Ct;
    for (const char* preset : {ct ? "ct-bone-skin" : "linear", ct ? "ct-lung" : "mr"}) {
        Result<TransferFunction> tf = presetTransferFunction(preset, scene.statistics());
        if (!tf || tf->name != scene.look().tf.name) {
            return tf;
        }
    }
    return presetTransferFunction("angio", scene.statistics());
}

Result<std::vector<NamedTransfer>> transfersOf(const Stage& stage) {
    const VolumeStatistics& s = stage.scene().statistics();
    const TransferFunction& own = stage.scene().look().tf;
    Result<TransferFunction> other = otherPreset(stage.scene(), stage.info().modality);
    if (!other) {
        return tl::unexpected(other.error());
    }
    return std::vector<NamedTransfer>{
        {"TF1", "all but the minimum", bands(s, {{kMinimumShare, 1.0}})},
        {"TF2", "all", bands(s, {{0.0, 1.0}})},
        {"TF3", "upper half", bands(s, {{0.5, 1.0}})},
        {"TF4", "second and fourth quarter", bands(s, {{0.25, 0.5}, {0.75, 1.0}})},
        {"TF5", own.name, own},
        {"TF6", other->name, *other}};
}

/// Ways to the same distances under a transfer function, timed again and again.
struct Ways {
    std::vector<double> chebyshevMs, proximityMs, chebyshevOfRangesMs, proximityOfRangesMs;
    std::vector<std::vector<double>> mergeMs; // of each number of partitions
};

/// What outlives a change of transfer function at one block edge.
struct Kept {
    int edge = 4;
    OctreeLevel ranges;
    std::vector<BuiltSkip> partitioned;
};

SkipOptions optionsOf(const SkipBench& bench, SkipStructure structure, int edge,
                      int partitions = 16) {
    // The separate minimum serves TF1, as in the paper's figure 4, and harms no other.
    return {.structure = structure,
            .blockEdgeVoxels = edge,
            .partitions = partitions,
            .separateMinimum = true,
            .memoryBudgetBytes = bench.options.skip.memoryBudgetBytes};
}

double msOf(const BuildStages& stages) {
    const Stopwatch watch;
    (void)runStages(stages); // not cancelled: cannot fail
    return watch.ms();
}

/// Builds partitioned maps and tells what they take.
Result<Kept> keep(SkipBench& bench, const Workshop& workshop, const CellVisibility& visibility,
                  int edge) {
    Result<OctreeLevel> ranges = blockRanges(workshop.codes(), edge);
    if (!ranges) {
        return tl::unexpected(ranges.error());
    }
    Kept kept{edge, std::move(*ranges), {}};
    for (const int partitions : kPartitions) {
        bench.progress.show(
            fmt::format("{}: {} partitions of {}-voxel blocks", bench.volume, partitions, edge));
        const SkipOptions options = optionsOf(bench, SkipStructure::Partitioned, edge, partitions);
        Result<BuiltSkip> built = workshop.build(options, visibility);
        if (!built && built.error().code != ErrorCode::VolumeTooLarge) {
            return tl::unexpected(built.error());
        }
        json row = bench.row("partitions");
        row.update(toJson(options));
        if (built) {
            row.update({{"initMs", built->buildMs - built->updateMs},
                        {"gpuBytes", gpuBytes(*built)},
                        {"hostBytes", hostBytes(*built)}});
            kept.partitioned.push_back(std::move(*built));
        } else {
            row["refused"] = built.error().detail;
        }
        bench.rows.push_back(std::move(row));
        if (bench.options.quick && edge < 4) {
            break; // the fewest partitions only
        }
    }
    return kept;
}

/// One round of every way.
Result<void> goAllWays(const SkipBench& bench, const Workshop& workshop, const Kept& kept,
                       const CellVisibility& visibility, Ways& ways) {
    const VolumeGeometry& geometry = bench.stage.scene().geometry();
    const std::pair<SkipStructure, std::vector<double>*> rebuilds[] = {
        {SkipStructure::Chebyshev, &ways.chebyshevMs},
        {SkipStructure::Proximity, &ways.proximityMs}};
    for (const auto& [structure, times] : rebuilds) {
        const Result<BuiltSkip> built =
            workshop.build(optionsOf(bench, structure, kept.edge), visibility);
        if (!built) {
            return tl::unexpected(built.error());
        }
        times->push_back(built->buildMs);
    }
    FreeLengths grid;
    ways.chebyshevOfRangesMs.push_back(
        msOf(chebyshevStages(kept.ranges, kept.edge, visibility, grid)));
    ways.proximityOfRangesMs.push_back(
        msOf(proximityStages(kept.ranges, kept.edge, visibility, geometry, grid)));
    for (std::size_t k = 0; k < kept.partitioned.size(); ++k) {
        ways.mergeMs[k].push_back(underTransfer(kept.partitioned[k], visibility).updateMs);
    }
    return {};
}

void addRows(SkipBench& bench, const Kept& kept, const NamedTransfer& transfer, const Ways& ways) {
    const auto rowOf = [&](const char* table, const SkipOptions& options) {
        json row = bench.row(table);
        row.update(toJson(options));
        row.update({{"tf", transfer.key}, {"tfName", transfer.what}});
        return row;
    };
    json chebyshev = rowOf("rebuild", optionsOf(bench, SkipStructure::Chebyshev, kept.edge));
    chebyshev.update({{"buildMs", toJson(summarise(ways.chebyshevMs))},
                      {"ofRangesMs", toJson(summarise(ways.chebyshevOfRangesMs))}});
    json proximity = rowOf("rebuild", optionsOf(bench, SkipStructure::Proximity, kept.edge));
    proximity.update({{"buildMs", toJson(summarise(ways.proximityMs))},
                      {"ofRangesMs", toJson(summarise(ways.proximityOfRangesMs))}});
    bench.rows.push_back(std::move(chebyshev));
    bench.rows.push_back(std::move(proximity));
    for (std::size_t k = 0; k < kept.partitioned.size(); ++k) {
        json row = rowOf("merge", kept.partitioned[k].options);
        row.update({{"updateMs", toJson(summarise(ways.mergeMs[k]))},
                    {"speedup", pairedRatio(ways.chebyshevMs, ways.mergeMs[k])},
                    {"speedupOfRanges", pairedRatio(ways.chebyshevOfRangesMs, ways.mergeMs[k])}});
        bench.rows.push_back(std::move(row));
    }
}

Result<void> measureEdge(SkipBench& bench, const Workshop& workshop,
                         const std::vector<NamedTransfer>& transfers, int edge) {
    const Result<Kept> kept =
        keep(bench, workshop, workshop.visibilityUnder(bench.stage.scene()), edge);
    if (!kept) {
        return tl::unexpected(kept.error());
    }
    for (const NamedTransfer& transfer : transfers) {
        bench.progress.show(
            fmt::format("{}: {} at {}-voxel blocks", bench.volume, transfer.key, edge));
        const Result<Scene> scene =
            bench.stage.variation(transfer.tf, {.structure = SkipStructure::None});
        if (!scene) {
            return tl::unexpected(scene.error());
        }
        const CellVisibility visibility = workshop.visibilityUnder(*scene);
        Ways ways;
        ways.mergeMs.resize(kept->partitioned.size());
        const int rounds = bench.options.quick ? kFewestFrames : bench.options.frames;
        for (int round = 0; round < rounds; ++round) {
            if (Result<void> done = goAllWays(bench, workshop, *kept, visibility, ways); !done) {
                return done;
            }
        }
        addRows(bench, *kept, transfer, ways);
    }
    return {};
}

} // namespace

Result<void> measureMerging(SkipBench& bench, const Workshop& workshop) {
    const Result<std::vector<NamedTransfer>> transfers = transfersOf(bench.stage);
    if (!transfers) {
        return tl::unexpected(transfers.error());
    }
    for (const int edge : kEdges) {
        if (Result<void> done = measureEdge(bench, workshop, *transfers, edge); !done) {
            return done;
        }
    }
    return {};
}

} // namespace slabcast
