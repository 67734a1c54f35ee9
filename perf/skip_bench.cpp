// How long the skip structure of a 256^3 volume of 16 bits takes to build, by block edge and
// transfer function. Prints medians in ms; what is timed is all that a change of transfer function
// costs (tables, occupancy, transform).

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <vector>

#include "core/skip/occupancy.h"
#include "core/skip/proximity_cloud.h"

using namespace slabcast;

namespace {

constexpr int kSize = 256;

/// A head-like shell of bone in soft tissue in air, with noise: values 0 to 4095, codes of 16 bits.
TexelCodes headCodes() {
    TexelCodes codes;
    codes.dims = glm::ivec3(kSize);
    std::uint32_t random = 1;
    for (int z = 0; z < kSize; ++z) {
        for (int y = 0; y < kSize; ++y) {
            for (int x = 0; x < kSize; ++x) {
                const glm::dvec3 p = (glm::dvec3(x, y, z) + 0.5) / (kSize / 2.0) - 1.0;
                const double r = glm::length(p / glm::dvec3(0.7, 0.85, 0.9));
                const double tissue = r > 1.0    ? 24.0
                                      : r > 0.92 ? 1070.0
                                      : r > 0.84 ? 2000.0
                                                 : 1060.0;
                random = random * 1664525U + 1013904223U;
                codes.codes.push_back(std::uint16_t(tissue + double(random >> 27)));
            }
        }
    }
    for (int c = 0; c < 65536; ++c) {
        codes.lowSampled.push_back(float(c));
        codes.highSampled.push_back(float(c));
    }
    return codes;
}

TransferTable bandTable(int first, int last) {
    TransferTable table{0.0, 4095.0, std::vector<glm::vec4>(4096, glm::vec4(0.0F))};
    for (int k = first; k <= last; ++k) {
        table.texels[k].a = 0.5F;
    }
    return table;
}

template <class Step>
double medianMs(Step step) {
    std::vector<double> times;
    for (int i = 0; i < 9; ++i) {
        const auto start = std::chrono::steady_clock::now();
        step();
        const std::chrono::duration<double, std::milli> spent =
            std::chrono::steady_clock::now() - start;
        times.push_back(spent.count());
    }
    std::nth_element(times.begin(), times.begin() + 4, times.end());
    return times[4];
}

} // namespace

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
            ProximityCloud cloud;
            const double build =
                medianMs([&] { cloud = buildProximityCloud(visibility, geometry, edge).value(); });
            const double free =
                1.0 - double(cloud.occupiedBlocks) / double(cloud.freeLengths.size());
            std::printf("%-26s %4d %9.2f %9.2f %9.2f %7.1f%%\n", c.name, edge, tables, occupancy,
                        tables + build, 100.0 * free);
        }
    }
}
