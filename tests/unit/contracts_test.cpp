#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "core/base/parallel.h"
#include "core/base/short_list.h"
#include "core/reference/continuous.h"
#include "core/reference/discrete.h"
#include "core/reference/picture_difference.h"
#include "core/reference/transfer_ramps.h"
#include "core/skip/bitfield_octree.h"
#include "core/skip/minmax_octree.h"
#include "core/skip/octree.h"
#include "core/skip/partitioned_maps.h"
#include "core/skip/proximity_cloud.h"
#include "core/skip/skip_layout.h"
#include "core/skip/skip_structure.h"
#include "core/skip/visible_values.h"
#include "core/transfer/preclassified.h"
#include "core/transfer/table_axis.h"
#include "core/transfer/transfer_integral.h"
#include "tests/support/formula_volume.h"

// What calling code must not do is said and ends the program, whatever the build: one line each.

namespace slabcast::test {
namespace {

/// A value of an enumeration that no name stands for.
template <class Enum>
Enum nameless() {
    return static_cast<Enum>(100);
}

const VolumeGeometry kGeometry{.dims = {2, 2, 2}};

Texels eightTexels() {
    return floatTexels(kGeometry, [](glm::ivec3 v) { return v.x; });
}

TransferFunction opaque() {
    return tfOf({{0.0, glm::dvec3(1.0), 0.5}});
}

TransferTable tableOf(const TransferFunction& tf) {
    return makeTable(tf, 0.0, 1.0, false, CompositingSpace::Display, 16);
}

VisibleValues shown(std::size_t codes) {
    VisibleValues values;
    values.shown.resize(codes);
    return values;
}

ValueBins binsOf(int count) {
    ValueBins bins;
    bins.count = count;
    return bins;
}

DiscreteInput pixelOf(const Texels& texels) {
    DiscreteInput input;
    input.texels = &texels;
    input.viewport = {0, 0, 1, 1};
    return input;
}

ContinuousInput continuousPixelOf(const Texels& texels) {
    ContinuousInput input;
    input.texels = &texels;
    input.viewport = {0, 0, 1, 1};
    return input;
}

struct Contract {
    const char* expects; // as the message has it
    void (*breach)();
};

const Contract kBase[] = {
    {"parallelFor: expects grain > 0, got 0",
     [] { parallelFor(1, 0, [](std::int64_t, std::int64_t) {}); }},
    {"add: expects size_ < most, got 2",
     [] {
         ShortList<int, 2> full{1, 2};
         full.add(3);
     }},
};

const Contract kVolume[] = {
    {"name: expects index < kTypeNames.size(), got 100", [] { (void)name(nameless<VoxelType>()); }},
    {"name: expects index < kFormatNames.size(), got 100",
     [] { (void)name(nameless<TexelFormat>()); }},
    {"computeStatistics: expects !volume.voxels.empty()", [] { computeStatistics(Volume{}); }},
    {"encodeTexels: expects !volume.voxels.empty()",
     [] { encodeTexels(Volume{}, VolumeStatistics{}, TexelFormat::R8); }},
    {"encodeCodes: expects !texels.data.empty()", [] { encodeCodes(Texels{}); }},
    {"valueAt: expects glm::all",
     [] {
         (void)Volume{.geometry = kGeometry}.valueAt({2, 0, 0});
     }},
    {"valueAt: expects glm::all",
     [] {
         (void)Volume{.geometry = kGeometry}.valueAt({0, -1, 0});
     }},
    {"decodedValue: expects glm::all",
     [] {
         (void)decodedValue(eightTexels(), {0, 0, 2});
     }},
};

const Contract kTransfer[] = {
    {"name: expects index < kSpaceNames.size(), got 100",
     [] { (void)name(nameless<CompositingSpace>()); }},
    {"evaluate: expects !tf.points.empty()", [] { evaluate(TransferFunction{}, 0.0); }},
    {"makeTable: expects !tf.points.empty()", [] { tableOf(TransferFunction{}); }},
    {"makeTable: expects dataMin <= dataMax, got -1",
     [] { makeTable(opaque(), 1.0, 0.0, false, CompositingSpace::Display, 16); }},
    {"makeTable: expects maxSize >= 4, got 3",
     [] { makeTable(opaque(), 0.0, 1.0, false, CompositingSpace::Display, 3); }},
    {"lookUp: expects table.texels.size() >= 2", [] { lookUp(TransferTable{}, 0.0); }},
    {"tableAxis: expects texels.valueScale > 0.0",
     [] {
         Texels texels = eightTexels();
         texels.valueScale = 0.0;
         tableAxis(texels, tableOf(opaque()));
     }},
    {"TransferIntegral: expects !tf.points.empty()",
     [] { TransferIntegral(TransferFunction{}, CompositingSpace::Display); }},
    {"classify: expects referenceLengthMm > 0.0",
     [] { classify(eightTexels(), kGeometry, tableOf(opaque()), {.referenceLengthMm = 0.0}); }},
    {"classify: expects distance > 0.0",
     [] {
         classify(eightTexels(), kGeometry, tableOf(opaque()),
                  {.light = BakedLight{.directionToLight = glm::dvec3(0.0)}});
     }},
};

const Contract kSkip[] = {
    {"infoOf: expects index < std::size(kStructures), got 100",
     [] { infoOf(nameless<SkipStructure>()); }},
    {"codeRange: expects codes.count() > 0", [] { codeRange(TexelCodes{}); }},
    {"valueBins: expects count >= 2 && count <= kMaxBins, got 1",
     [] {
         valueBins(encodeCodes(eightTexels()), CodeRange{0, 1}, 1, false, std::nullopt);
     }},
    {"valueBins: expects range.least <= range.most, got 1",
     [] {
         valueBins(encodeCodes(eightTexels()), CodeRange{1, 0}, 2, false, std::nullopt);
     }},
    {"valueBins: expects range.most < codes.lowSampled.size()",
     [] {
         valueBins(TexelCodes{}, CodeRange{0, 1}, 2, false, std::nullopt);
     }},
    {"visibleBins: expects binOf.size() == visibility.reach.size()",
     [] {
         ValueBins bins = binsOf(2);
         bins.binOfCode.resize(3);
         visibleBins(bins, CellVisibility{});
     }},
    {"covers: expects all.shown.size() == some.shown.size(), got 1",
     [] { covers(shown(1), shown(2)); }},
    {"changedCodes: expects a.shown.size() == b.shown.size(), got 1",
     [] { changedCodes(shown(1), shown(2)); }},
    {"changedBins: expects a.shown.size() == b.shown.size(), got 1",
     [] { changedBins(binsOf(2), shown(1), shown(2)); }},
    {"changedBins: expects a.shown.size() == bins.binOfCode.size(), got 0",
     [] { changedBins(binsOf(2), shown(1), shown(1)); }},
    {"buildMinMaxOctree: expects voxels > 0", [] { (void)buildMinMaxOctree(TexelCodes{}, {}); }},
    {"buildMinMaxOctree: expects codes.count() == voxels, got 12",
     [] {
         TexelCodes codes = encodeCodes(eightTexels());
         codes.dims.x = 3;
         (void)buildMinMaxOctree(codes, {});
     }},
    {"buildMinMaxOctree: expects options.blockEdgeVoxels > 0, got 0",
     [] { (void)buildMinMaxOctree(encodeCodes(eightTexels()), {.blockEdgeVoxels = 0}); }},
    {"buildBitfieldOctree: expects bins.count == options.bits, got 8",
     [] { (void)buildBitfieldOctree(TexelCodes{}, binsOf(8), {.bits = 16}); }},
    {"bitfieldOctree: expects bins.count <= kMaxBits, got 200",
     [] { bitfieldOctree(Octree{}, binsOf(200)); }},
    {"buildPartitionedMaps: expects bins.count == options.partitions, got 8",
     [] { (void)buildPartitionedMaps(TexelCodes{}, binsOf(8), {.partitions = 16}); }},
    {"buildProximityCloud: expects geometry.dims == visibility.texels->dims, got 3",
     [] {
         const TexelCodes codes = encodeCodes(eightTexels());
         CellVisibility visibility;
         visibility.texels = &codes;
         (void)buildProximityCloud(visibility, {.dims = {3, 2, 2}}, 1);
     }},
    {"octreeLayout: expects levels > 0",
     [] {
         octreeLayout({1, 1, 1}, 0, 8);
     }},
    {"keptLevels: expects initialLevel >= 0, got -1",
     [] {
         keptLevels({1, 1, 1}, -1);
     }},
    {"forVisibleNodes: expects level >= 0", [] { visibleNodes(Octree{}, NodeTest{}, -1); }},
};

const Contract kReference[] = {
    {"TransferRamps: expects !tf.points.empty()",
     [] { TransferRamps(TransferFunction{}, CompositingSpace::Display); }},
    {"difference: expects !picture.empty()", [] { difference({}, {}, CompositingSpace::Display); }},
    {"difference: expects !picture.empty() && picture.size() == reference.size(), got 1",
     [] {
         const std::vector<glm::dvec4> one(1);
         const std::vector<glm::dvec4> two(2);
         difference(one, two, CompositingSpace::Display);
     }},
    {"renderDiscrete: expects input.texels != nullptr", [] { renderDiscrete(DiscreteInput{}); }},
    {"renderDiscrete: expects viewport.width > 0",
     [] {
         const Texels texels = eightTexels();
         DiscreteInput input = pixelOf(texels);
         input.viewport.width = 0;
         renderDiscrete(input);
     }},
    {"expects input.texels != nullptr", [] { (void)renderContinuous(ContinuousInput{}); }},
    {"expects input.viewport.width > 0",
     [] {
         const Texels texels = eightTexels();
         ContinuousInput input = continuousPixelOf(texels);
         input.viewport.height = -1;
         (void)renderContinuous(input);
     }},
    {"expects input.tolerance > 0.0, got 0",
     [] {
         const Texels texels = eightTexels();
         ContinuousInput input = continuousPixelOf(texels);
         input.tolerance = 0.0;
         (void)renderContinuous(input);
     }},
};

/// A regular expression that matches nothing but `text`.
std::string exactly(const std::string& text) {
    std::string expression;
    for (const char c : text) {
        expression += std::string("\\^$.|?*+()[]{}").find(c) == std::string::npos ? "" : "\\";
        expression += c;
    }
    return expression;
}

template <std::size_t N>
void expectDeaths(const Contract (&contracts)[N]) {
    for (const Contract& contract : contracts) {
        EXPECT_DEATH(contract.breach(), exactly(contract.expects)) << contract.expects;
    }
}

TEST(ContractsDeathTest, Base) {
    expectDeaths(kBase);
}
TEST(ContractsDeathTest, Volume) {
    expectDeaths(kVolume);
}
TEST(ContractsDeathTest, Transfer) {
    expectDeaths(kTransfer);
}
TEST(ContractsDeathTest, Skip) {
    expectDeaths(kSkip);
}
TEST(ContractsDeathTest, Reference) {
    expectDeaths(kReference);
}

} // namespace
} // namespace slabcast::test
