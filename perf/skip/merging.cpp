#include "perf/skip/merging.h"

#include <algorithm>
#include <array>

#include "core/base/stopwatch.h"
#include "core/skip/chebyshev.h"
#include "core/skip/occupancy.h"
#include "core/skip/proximity_cloud.h"
#include "perf/skip/builds.h"
#include "perf/skip/row_json.h"

namespace slabcast::skipbench {

namespace {

constexpr std::array kEdges{4, 2, 1};
constexpr std::array kPartitions{16, 32, 64, 128, 256};
constexpr double kOpacity = 0.1;
/// What counts as the minimum, of the range: a table's texel is a 4096th of it at best, and a TF
/// shows a texel more than it says.
constexpr double kMinimumShare = 1.0 / 512.0;

struct NamedTransfer {
    Transfer named;
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

std::vector<NamedTransfer> transfersOf(const Scene& scene, const TransferFunction& other) {
    const VolumeStatistics& s = scene.statistics();
    const TransferFunction& own = scene.look().tf;
    std::vector<NamedTransfer> all;
    const auto add = [&](const char* key, const std::string& name, TransferFunction tf) {
        all.push_back({{key, name}, std::move(tf)});
    };
    add("TF1", "all but the minimum", bands(s, {{kMinimumShare, 1.0}}));
    add("TF2", "all", bands(s, {{0.0, 1.0}}));
    add("TF3", "upper half", bands(s, {{0.5, 1.0}}));
    add("TF4", "second and fourth quarter", bands(s, {{0.25, 0.5}, {0.75, 1.0}}));
    add("TF5", own.name, own);
    add("TF6", other.name, other);
    return all;
}

/// Ways to the same distances under a transfer function, timed again and again.
struct Ways {
    std::vector<double> chebyshevMs, proximityMs, chebyshevOfRangesMs, proximityOfRangesMs;
    std::vector<std::vector<double>> mergeMs; // of each number of partitions
};

Json keptOf(const Ways& ways) {
    Json merges = Json::list();
    for (const std::vector<double>& ms : ways.mergeMs) {
        merges.push_back(Json::listOf(ms));
    }
    return {{"chebyshev", Json::listOf(ways.chebyshevMs)},
            {"proximity", Json::listOf(ways.proximityMs)},
            {"chebyshev_of_ranges", Json::listOf(ways.chebyshevOfRangesMs)},
            {"proximity_of_ranges", Json::listOf(ways.proximityOfRangesMs)},
            {"merges", std::move(merges)}};
}

Ways waysOf(const Json& kept) {
    Ways ways{numbersOf(kept.at("chebyshev")),
              numbersOf(kept.at("proximity")),
              numbersOf(kept.at("chebyshev_of_ranges")),
              numbersOf(kept.at("proximity_of_ranges")),
              {}};
    for (const Json& ms : kept.at("merges")) {
        ways.mergeMs.push_back(numbersOf(ms));
    }
    return ways;
}

/// What outlives a change of transfer function at one block edge.
struct Kept {
    int edge = 4;
    OctreeLevel ranges;
    std::vector<BuiltSkip> partitioned;
};

SkipOptions optionsOf(const Bench& bench, SkipStructure structure, int edge, int partitions = 16) {
    // The separate minimum serves TF1, as in the paper's figure 4, and harms no other.
    return {.structure = structure,
            .blockEdgeVoxels = edge,
            .partitions = partitions,
            .separateMinimum = true,
            .memoryBudgetBytes = bench.desc.stage.settings.skipOptions.memoryBudgetBytes};
}

double msOf(const BuildStages& stages) {
    const Stopwatch watch;
    (void)runStages(stages); // not cancelled: cannot fail
    return watch.ms();
}

/// Builds partitioned maps and tells what they take.
Result<Kept> keep(Bench& bench, const Workshop& workshop, const CellVisibility& visibility,
                  int edge) {
    Result<OctreeLevel> ranges = blockRanges(workshop.codes(), edge);
    if (!ranges) {
        return tl::unexpected(ranges.error());
    }
    Kept kept{edge, std::move(*ranges), {}};
    for (const int partitions : kPartitions) {
        bench.show(std::to_string(partitions) + " partitions of " + std::to_string(edge) +
                   "-voxel blocks");
        const SkipOptions options = optionsOf(bench, SkipStructure::Partitioned, edge, partitions);
        Result<BuiltSkip> built = workshop.build(options, visibility);
        if (!built && built.error().code != ErrorCode::VolumeTooLarge) {
            return tl::unexpected(built.error());
        }
        Row row = bench.row(Table::Partitions, options);
        if (built) {
            const Result<double> initMs = bench.timed(
                idOf(row), [&]() -> Result<double> { return built->buildMs - built->updateMs; });
            if (!initMs) {
                return tl::unexpected(initMs.error());
            }
            row.partitions = {*initMs, {gpuBytes(*built), hostBytes(*built)}, {}};
            kept.partitioned.push_back(std::move(*built));
        } else {
            row.partitions = {.refused = built.error().detail};
        }
        bench.rows.push_back(std::move(row));
        if (bench.desc.quick && edge < 4) {
            break; // the fewest partitions only
        }
    }
    return kept;
}

/// One round of every way.
Result<void> goAllWays(const Bench& bench, const Workshop& workshop, const Kept& kept,
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

void addRows(Bench& bench, const Kept& kept, const Transfer& transfer, const Ways& ways) {
    const auto add = [&](Table table, const SkipOptions& options) -> Row& {
        bench.rows.push_back(bench.row(table, options));
        bench.rows.back().transfer = transfer;
        return bench.rows.back();
    };
    add(Table::Rebuild, optionsOf(bench, SkipStructure::Chebyshev, kept.edge)).rebuild = {
        ways.chebyshevMs, ways.chebyshevOfRangesMs};
    add(Table::Rebuild, optionsOf(bench, SkipStructure::Proximity, kept.edge)).rebuild = {
        ways.proximityMs, ways.proximityOfRangesMs};
    for (std::size_t k = 0; k < kept.partitioned.size(); ++k) {
        add(Table::Merge, kept.partitioned[k].options).merge = {
            ways.mergeMs[k], pairedRatio(ways.chebyshevMs, ways.mergeMs[k]),
            pairedRatio(ways.chebyshevOfRangesMs, ways.mergeMs[k])};
    }
}

/// All rounds under one transfer function, from the store where they are there.
Result<Ways> waysUnder(const Bench& bench, const Workshop& workshop, const Kept& kept,
                       const NamedTransfer& transfer) {
    Row subject = bench.row(Table::Merge, optionsOf(bench, SkipStructure::Chebyshev, kept.edge));
    subject.transfer = transfer.named;
    const std::string id = idOf(subject);
    if (const Json* piece = bench.store.find(id);
        piece != nullptr && piece->at("merges").size() == kept.partitioned.size()) {
        return waysOf(*piece);
    }
    const Result<Scene> scene =
        bench.stage.variation(transfer.tf, {.structure = SkipStructure::None});
    if (!scene) {
        return tl::unexpected(scene.error());
    }
    const CellVisibility visibility = workshop.visibilityUnder(*scene);
    Ways ways;
    ways.mergeMs.resize(kept.partitioned.size());
    const int rounds = bench.desc.quick ? kFewestFrames : bench.desc.frames;
    for (int round = 0; round < rounds; ++round) {
        if (Result<void> done = goAllWays(bench, workshop, kept, visibility, ways); !done) {
            return tl::unexpected(done.error());
        }
    }
    Json piece = keptOf(ways);
    piece["id"] = id;
    return bench.store.add(std::move(piece)).map([&] { return std::move(ways); });
}

Result<void> measureEdge(Bench& bench, const Workshop& workshop,
                         const std::vector<NamedTransfer>& transfers, int edge) {
    const Result<Kept> kept =
        keep(bench, workshop, workshop.visibilityUnder(bench.stage.scene()), edge);
    if (!kept) {
        return tl::unexpected(kept.error());
    }
    for (const NamedTransfer& transfer : transfers) {
        bench.show(std::string(transfer.named.key) + " at " + std::to_string(edge) +
                   "-voxel blocks");
        const Result<Ways> ways = waysUnder(bench, workshop, *kept, transfer);
        if (!ways) {
            return tl::unexpected(ways.error());
        }
        addRows(bench, *kept, transfer.named, *ways);
    }
    return {};
}

} // namespace

Result<void> measureMerging(Bench& bench, const Workshop& workshop, const TransferFunction& other) {
    const std::vector<NamedTransfer> transfers = transfersOf(bench.stage.scene(), other);
    for (const int edge : kEdges) {
        if (Result<void> done = measureEdge(bench, workshop, transfers, edge); !done) {
            return done;
        }
    }
    return {};
}

} // namespace slabcast::skipbench
