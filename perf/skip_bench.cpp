// How long the skip structures of a 256^3 volume of 16 bits that are grids take to build, by block
// edge and transfer function: all that a change of transfer function costs (tables, occupancy,
// transform), from the voxels or from the ranges of the blocks, which no transfer function changes;
// and how long partitioned maps take to merge instead. Prints medians in ms.

#include <cstdio>

#include "core/skip/chebyshev.h"
#include "core/skip/occupancy.h"
#include "core/skip/partitioned_maps.h"
#include "core/skip/proximity_cloud.h"
#include "perf/skip_bench_scene.h"

using namespace slabcast;
using namespace slabcast::perf;

namespace {

struct Scene {
    TexelCodes codes = headCodes();
    CodeRange range = codeRange(codes);
    VolumeGeometry geometry{.dims = codes.dims, .spacingMm = {0.9, 0.9, 1.2}};

    CellVisibility visibility(const TransferTable& table) const {
        return cellVisibility(codes, Texels{}, table, 0.0); // a code is its own value
    }
};

struct Case {
    const char* name;
    TransferTable table;
};

/// Of one block edge.
struct Rebuilds {
    double ranges = 0.0; // of the blocks: once
    double cloud = 0.0, cloudOfRanges = 0.0;
    double map = 0.0, mapOfRanges = 0.0;
    double free = 0.0;
};

Rebuilds rebuilds(const Scene& scene, const CellVisibility& visibility, int edge) {
    OctreeLevel ranges;
    FreeLengths grid;
    Rebuilds ms;
    ms.ranges = medianMs([&] { ranges = *blockRanges(scene.codes, edge); });
    ms.cloud = medianMs([&] { grid = *buildProximityCloud(visibility, scene.geometry, edge); });
    ms.cloudOfRanges = medianMs(
        [&] { (void)runStages(proximityStages(ranges, edge, visibility, scene.geometry, grid)); });
    ms.map = medianMs([&] { grid = *buildChebyshev(visibility, edge); });
    ms.mapOfRanges =
        medianMs([&] { (void)runStages(chebyshevStages(ranges, edge, visibility, grid)); });
    ms.free = 1.0 - double(grid.occupiedBlocks) / double(grid.counts.size());
    return ms;
}

void printRebuilds(const Scene& scene, const Case& c) {
    CellVisibility visibility;
    const double tables = medianMs([&] { visibility = scene.visibility(c.table); });
    for (const int edge : {1, 2, 4, 8}) {
        const Rebuilds ms = rebuilds(scene, visibility, edge);
        std::printf("%-24s %4d %8.2f %8.2f %10.2f %10.2f %10.2f %10.2f %7.1f%%\n", c.name, edge,
                    tables, ms.ranges, ms.cloud, ms.cloudOfRanges, ms.map, ms.mapOfRanges,
                    100.0 * ms.free);
    }
}

void printMerges(const Scene& scene, const Case& c, int edge) {
    const CellVisibility visibility = scene.visibility(c.table);
    const Rebuilds rebuild = rebuilds(scene, visibility, edge);
    for (const int partitions : {16, 32, 64, 128, 256}) {
        const SkipOptions options{.structure = SkipStructure::Partitioned,
                                  .blockEdgeVoxels = edge,
                                  .partitions = partitions};
        const ValueBins bins = valueBins(scene.codes, scene.range, partitions, false);
        const auto start = std::chrono::steady_clock::now();
        const auto maps = buildPartitionedMaps(scene.codes, bins, options);
        const std::chrono::duration<double, std::milli> once =
            std::chrono::steady_clock::now() - start;
        if (!maps) {
            std::printf("%-24s %4d %s\n", c.name, edge, maps.error().detail.c_str());
            continue;
        }
        BinSet set{};
        FreeLengths grid;
        const double choose = medianMs([&] { set = visibleBins(bins, visibility); });
        const double merge = medianMs([&] { grid = merged(*maps, set); });
        std::printf("%-24s %4d %10d %9.1f %7.3f %7.3f %9.1fx %9.1fx %9.1fx\n", c.name, edge,
                    partitions, once.count(), choose, merge, rebuild.map / merge,
                    rebuild.cloud / merge, rebuild.mapOfRanges / merge);
    }
}

} // namespace

int main() {
    const Scene scene;
    const Case cases[] = {{"bone", bandTable(1500, 4095)},
                          {"skin", bandTable(300, 4095)},
                          {"band in the skin's edge", bandTable(500, 520)},
                          {"noise of the air", bandTable(40, 45)},
                          {"all", bandTable(0, 4095)},
                          {"nothing", bandTable(0, -1)}};
    std::printf("%-24s %4s %8s %8s %10s %10s %10s %10s %8s\n", "rebuilt", "edge", "tables",
                "ranges", "proximity", "of ranges", "chebyshev", "of ranges", "free");
    for (const Case& c : cases) {
        printRebuilds(scene, c);
    }
    std::printf("\n%-24s %4s %10s %9s %7s %7s %10s %10s %10s\n", "merged", "edge", "partitions",
                "once", "set", "merge", "chebyshev", "proximity", "of ranges");
    for (const Case& c : {cases[0], cases[4]}) {
        for (const int edge : {1, 2, 4}) {
            printMerges(scene, c, edge);
        }
    }
}
