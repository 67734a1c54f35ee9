// How long the skip structure of a 256^3 volume of 16 bits takes to build, by block edge and
// transfer function. Prints medians in ms; what is timed is all that a change of transfer function
// costs (tables, occupancy, transform).

#include <cstdio>

#include "core/skip/occupancy.h"
#include "core/skip/proximity_cloud.h"
#include "perf/skip_bench_scene.h"

using namespace slabcast;
using namespace slabcast::perf;

int main() {
    const TexelCodes codes = headCodes();
    const Texels texels; // a code is its own value
    VolumeGeometry geometry;
    geometry.dims = codes.dims;
    geometry.spacingMm = {0.9, 0.9, 1.2};
    struct Case {
        const char* name;
        TransferTable table;
    };
    const Case cases[] = {{"bone", bandTable(1500, 4095)},
                          {"skin", bandTable(300, 4095)},
                          {"band in the skin's edge", bandTable(500, 520)},
                          {"noise of the air", bandTable(40, 45)},
                          {"nothing", bandTable(0, -1)}};
    std::printf("%-26s %4s %9s %9s %9s %8s\n", "transfer function", "edge", "tables", "occupancy",
                "all", "free");
    for (const Case& c : cases) {
        for (const int edge : {1, 2, 4, 8}) {
            CellVisibility visibility;
            const double tables =
                medianMs([&] { visibility = cellVisibility(codes, texels, c.table, 0.0); });
            const double occupancy = medianMs([&] { (void)occupiedBlocks(visibility, edge); });
            FreeLengths cloud;
            const double build =
                medianMs([&] { cloud = buildProximityCloud(visibility, geometry, edge).value(); });
            const double free = 1.0 - double(cloud.occupiedBlocks) / double(cloud.counts.size());
            std::printf("%-26s %4d %9.2f %9.2f %9.2f %7.1f%%\n", c.name, edge, tables, occupancy,
                        tables + build, 100.0 * free);
        }
    }
}
