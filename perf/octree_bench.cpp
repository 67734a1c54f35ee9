// How long the octrees of a 256^3 volume of 16 bits take to build, what they weigh, and what a
// change of transfer function costs. Prints medians in ms.

#include <cstdio>
#include <string>

#include "core/frame/visible_boxes.h"
#include "core/skip/bitfield_octree.h"
#include "core/skip/boolean_octree.h"
#include "core/skip/minmax_octree.h"
#include "core/skip/skip_texture.h"
#include "perf/skip_bench_scene.h"

using namespace slabcast;
using namespace slabcast::perf;

namespace {

struct Scene {
    TexelCodes codes = headCodes();
    VolumeGeometry geometry{.dims = codes.dims, .spacingMm = {0.9, 0.9, 1.2}};
    CellVisibility visibility = cellVisibility(codes, Texels{}, bandTable(1500, 4095), 0.0);
};

struct Built {
    Octree octree;
    NodeTest test;
};

void printRow(const Scene& scene, const std::string& name, int edge, double buildMs, double testMs,
              const Built& built) {
    const auto& [octree, test] = built;
    const double boxes =
        medianMs([&, &o = octree, &t = test] { (void)visibleBoxes(o, t, scene.geometry, 1.0); });
    const double count = medianMs([&o = octree, &t = test] { (void)visibleLeaves(o, t); });
    const double leaves = double(octree.levels[0].words.size()) / octree.wordsPerNode();
    const auto bytes = gpuBytes(octree);
    std::printf("%-16s %4d %9.2f %9.3f %9.3f %9.3f %8.2f %7.2f%% %6.1f%%\n", name.c_str(), edge,
                buildMs, testMs, boxes, count, double(bytes) / 0x1p20,
                100.0 * double(bytes) / (2.0 * double(scene.codes.codes.size())),
                100.0 * (1.0 - double(visibleLeaves(octree, test)) / leaves));
}

void measureBoolean(const Scene& scene, const SkipOptions& options) {
    Octree octree;
    const double build =
        medianMs([&] { octree = buildBooleanOctree(scene.visibility, options).value(); });
    printRow(scene, "boolean", options.blockEdgeVoxels, build, 0.0, {octree, booleanNodeTest()});
}

void measureMinMax(const Scene& scene, const SkipOptions& options) {
    Octree octree;
    NodeTest test;
    const double build =
        medianMs([&] { octree = buildMinMaxOctree(scene.codes, options).value(); });
    const double change = medianMs([&] { test = minMaxNodeTest(scene.visibility); });
    printRow(scene, "min-max", options.blockEdgeVoxels, build, change, {octree, test});
}

void measureBitfield(const Scene& scene, SkipOptions options, int bits) {
    options.bits = bits;
    BitfieldOctree built;
    NodeTest test;
    const double build = medianMs([&] {
        ValueBins bins = valueBins(scene.codes, codeRange(scene.codes), bits, false);
        built = buildBitfieldOctree(scene.codes, std::move(bins), options).value();
    });
    const double change = medianMs([&] { test = bitfieldNodeTest(built.bins, scene.visibility); });
    printRow(scene, "bitfield, " + std::to_string(bits), options.blockEdgeVoxels, build, change,
             {built.octree, test});
}

} // namespace

int main() {
    const Scene scene;
    std::printf("%-16s %4s %9s %9s %9s %9s %8s %8s %7s\n", "octree", "edge", "build", "new TF",
                "boxes", "leaves", "MiB", "memory", "free");
    for (const int edge : {2, 4, 8, 16, 64}) {
        const SkipOptions options{.blockEdgeVoxels = edge};
        measureBoolean(scene, options);
        measureMinMax(scene, options);
        for (const int bits : {8, 16, 32, 64, 128}) {
            measureBitfield(scene, options, bits);
        }
    }
}
