#include "perf/skip/figures.h"

#include <gtest/gtest.h>

#include "perf/skip/bench.h"
#include "perf/skip/row.h"

using namespace slabcast;
using namespace slabcast::skipbench;

namespace {

VolumeRecord skull() {
    VolumeRecord volume{.name = "skull", .input = "skull.nrrd"};
    volume.info.modality = Modality::Ct;
    volume.transferFunction = "CT bone";
    volume.own = OwnScene::Skull;
    return volume;
}

VolumeRecord gap() {
    return {.name = "gap", .input = "phantom:gap:24", .own = OwnScene::Phantom};
}

/// A row of a race: `samples` of it, against those of none.
Row drawn(const VolumeRecord& volume, SkipStructure structure, const char* family, const Mode& mode,
          std::vector<double> samples, double speedup, bool tighten = false) {
    Row row{.table = Table::Frames,
            .volume = volume.name,
            .options = {.structure = structure},
            .family = family,
            .mode = mode.name};
    row.plan = FramePlan{.layersPerPlane = 16, .tighten = tighten};
    row.raced = Raced{std::move(samples), {speedup, {speedup / 2, speedup * 2, 0.75}}};
    return row;
}

Row merged(const VolumeRecord& volume, int edge, int partitions, double speedup) {
    Row row{.table = Table::Merge,
            .volume = volume.name,
            .options = {.structure = SkipStructure::Partitioned,
                        .blockEdgeVoxels = edge,
                        .partitions = partitions}};
    row.merge = Merge{{}, {.median = speedup}, {}};
    return row;
}

Row counted(const VolumeRecord& volume, SkipStructure structure, std::int64_t visited,
            std::int64_t looks) {
    Row row{.table = Table::Work, .volume = volume.name, .options = {.structure = structure}};
    row.counters = WorkCounters{.stretches = looks, .blocksVisited = visited};
    return row;
}

Figure figureOf(const VolumeRecord& volume, const std::vector<Row>& rows, const std::string& key) {
    for (const Figure& figure : figuresOf({&volume, 1}, rows)) {
        if (figure.key == key) {
            return figure;
        }
    }
    ADD_FAILURE() << "no figure " << key;
    return {};
}

TEST(SkipFigures, NothingMeasuredIsNoValueAndNotReached) {
    const VolumeRecord volume = skull();
    for (const Figure& figure : figuresOf({&volume, 1}, {})) {
        EXPECT_FALSE(figure.value) << figure.key;
        EXPECT_FALSE(figure.reached()) << figure.key;
    }
    EXPECT_EQ(tallyOf(figuresOf({&volume, 1}, {})).judged, 0);
}

TEST(SkipFigures, TheFasterDistanceMapCounts) {
    const std::vector<Row> rows{
        drawn(skull(), SkipStructure::None, kRayCasting, kMarchingOnly, {8, 8}, 1.0),
        drawn(skull(), SkipStructure::Proximity, kRayCasting, kMarchingOnly, {4, 4}, 2.0),
        drawn(skull(), SkipStructure::Chebyshev, kRayCasting, kMarchingOnly, {2, 2}, 4.0),
        drawn(skull(), SkipStructure::Chebyshev, kRayCasting, kEarlyExit, {1, 1}, 2.5),
        drawn(skull(), SkipStructure::BitfieldOctree, kRayCasting, kMarchingOnly, {3, 3}, 2.7),
        drawn(skull(), SkipStructure::MinMaxOctree, kRayCasting, kMarchingOnly, {6, 6}, 1.3)};
    const Figure map = figureOf(skull(), rows, "distance_map_marching_only_speedup");
    EXPECT_EQ(map.value, 4.0);
    EXPECT_EQ(map.goal, 2.0);
    EXPECT_EQ(map.reached(), true);
    EXPECT_EQ(map.from, "times as fast; chebyshev");
    const Figure early = figureOf(skull(), rows, "distance_map_early_exit_speedup");
    EXPECT_EQ(early.value, 2.5);
    EXPECT_EQ(early.reached(), false); // 3 was asked for
    const Figure octree = figureOf(skull(), rows, "bitfield_octree_over_distance_map_time");
    EXPECT_EQ(octree.value, 1.5); // 3 over 2
    EXPECT_EQ(octree.reached(), true);
    EXPECT_EQ(figureOf(skull(), rows, "bitfield_octree_over_minmax_octree_time").value, 0.5);
}

TEST(SkipFigures, GoalsOfTheSkullAreNoOtherVolumes) {
    VolumeRecord other = skull(); // a CT under bone, but not the one that they were set for
    other.own = OwnScene::None;
    const std::vector<Row> rows{
        drawn(skull(), SkipStructure::Proximity, kRayCasting, kMarchingOnly, {4}, 2.0)};
    for (const VolumeRecord& volume : {other, gap()}) {
        EXPECT_FALSE(figureOf(volume, rows, "distance_map_marching_only_speedup").goal);
        EXPECT_FALSE(figureOf(volume, rows, "hybrid_early_exit_rectangles_speedup").goal);
    }
    EXPECT_EQ(figureOf(other, rows, "distance_map_marching_only_speedup").value, 2.0);
    EXPECT_FALSE(figureOf(skull(), {}, "bitfield_octree_over_minmax_octree_blocks_visited").goal);
}

TEST(SkipFigures, AVolumeThatIsNotOursHasNoGoals) {
    VolumeRecord other = gap();
    other.own = OwnScene::None;
    Row row{.table = Table::Sizes,
            .volume = "gap",
            .options = {.structure = SkipStructure::BitfieldOctree}};
    row.cube = Cube{.edge = 256};
    const std::vector<Row> rows{row};
    const std::vector<Figure> figures = figuresOf({&other, 1}, rows);
    EXPECT_FALSE(figures.empty());
    for (const Figure& figure : figures) {
        EXPECT_FALSE(figure.goal) << figure.key;
    }
}

TEST(SkipFigures, OwnScenesArePhantomsUnderTheirOwnPresetsAndTheSkullUnderBone) {
    EXPECT_EQ(ownSceneOf({.volume = "phantom:gap:24", .usualTransfer = true}, "Gap"),
              OwnScene::Phantom);
    EXPECT_EQ(ownSceneOf({.volume = "phantom:gap:24"}, "Linear"), OwnScene::None);
    EXPECT_EQ(ownSceneOf({.volume = "skull.nrrd", .voxels = "0", .usualTransfer = true}, "CT bone"),
              OwnScene::None)
        << "a file's name makes no skull";
    const Input skull{.volume = "any.nrrd", .voxels = "7cddd6bf41a5f58c"};
    EXPECT_EQ(ownSceneOf(skull, "CT bone"), OwnScene::Skull);
    EXPECT_EQ(ownSceneOf(skull, "CT lung"), OwnScene::None);
}

TEST(SkipFigures, WhatIsPairedHasAnInterval) {
    const std::vector<Row> rows{
        drawn(skull(), SkipStructure::Proximity, kRayCasting, kMarchingOnly, {4, 4, 5}, 2.0),
        drawn(skull(), SkipStructure::BitfieldOctree, kRayCasting, kMarchingOnly, {4, 8, 15}, 1.5),
        drawn(skull(), SkipStructure::MinMaxOctree, kRayCasting, kMarchingOnly, {2, 8, 5}, 1.0)};
    const Figure map = figureOf(skull(), rows, "distance_map_marching_only_speedup");
    ASSERT_TRUE(map.interval);
    EXPECT_EQ(map.interval->low, 1.0);
    EXPECT_EQ(map.interval->high, 4.0);
    const Figure octrees = figureOf(skull(), rows, "bitfield_octree_over_minmax_octree_time");
    EXPECT_EQ(octrees.value, 2.0); // of 2, 1 and 3: round by round
    ASSERT_TRUE(octrees.interval);
    EXPECT_EQ(octrees.interval->low, 1.0);
    EXPECT_EQ(octrees.interval->high, 3.0);
    EXPECT_EQ(octrees.interval->coverage, 0.75);
    EXPECT_FALSE(figureOf(skull(), rows, "merge_16_speedup_edge_4").interval);
}

TEST(SkipFigures, OtherVolumesRowsAreNotMixedIn) {
    const std::vector<Row> rows{
        drawn(gap(), SkipStructure::Proximity, kRayCasting, kMarchingOnly, {4}, 9.0),
        drawn(skull(), SkipStructure::Proximity, kRayCasting, kMarchingOnly, {4}, 2.0)};
    EXPECT_EQ(figureOf(skull(), rows, "distance_map_marching_only_speedup").value, 2.0);
    EXPECT_EQ(figureOf(gap(), rows, "distance_map_marching_only_speedup").value, 9.0);
}

TEST(SkipFigures, BlocksAreThoseOfEqualParameters) {
    const std::vector<Row> rows{counted(gap(), SkipStructure::BitfieldOctree, 3, 8),
                                counted(gap(), SkipStructure::MinMaxOctree, 6, 10)};
    const Figure visited =
        figureOf(gap(), rows, "bitfield_octree_over_minmax_octree_blocks_visited");
    EXPECT_EQ(visited.value, 0.5);
    EXPECT_EQ(visited.goal, 0.6);
    EXPECT_EQ(visited.reached(), true);
    EXPECT_EQ(figureOf(gap(), rows, "bitfield_octree_over_minmax_octree_blocks_looked_at").value,
              0.8);
}

TEST(SkipFigures, WorkThatCouldNotBeCountedIsNoValue) {
    std::vector<Row> rows{counted(gap(), SkipStructure::BitfieldOctree, 3, 8),
                          counted(gap(), SkipStructure::MinMaxOctree, 6, 10)};
    rows[1].counters = fail(ErrorCode::DeviceUnsupported, "no blending of float32 targets");
    EXPECT_FALSE(figureOf(gap(), rows, "bitfield_octree_over_minmax_octree_blocks_visited").value);
}

TEST(SkipFigures, AHybridIsComparedWithNoneOfTheSameOrTheOtherPlanes) {
    const auto row = [](SkipStructure structure, bool tighten, double ms, double speedup) {
        return drawn(skull(), structure, kHybrid, kEarlyExit, {ms, ms}, speedup, tighten);
    };
    const std::vector<Row> rows{
        row(SkipStructure::None, false, 12, 1.0), row(SkipStructure::None, true, 8, 1.5),
        row(SkipStructure::Proximity, false, 6, 2.0), row(SkipStructure::Proximity, true, 4, 3.0),
        row(SkipStructure::Chebyshev, true, 3, 4.0)};
    EXPECT_EQ(figureOf(skull(), rows, "hybrid_early_exit_sphere_speedup").value, 2.0);    // 12 / 6
    EXPECT_EQ(figureOf(skull(), rows, "hybrid_early_exit_structure_speedup").value, 4.0); // 12 / 3
    const Figure rectangles = figureOf(skull(), rows, "hybrid_early_exit_rectangles_speedup");
    EXPECT_DOUBLE_EQ(*rectangles.value, 8.0 / 3.0);
    EXPECT_EQ(rectangles.reached(), true);
    EXPECT_EQ(rectangles.from,
              "times as fast, each at its best ratio; chebyshev, 16 layers a plane");
    EXPECT_FALSE(figureOf(skull(), rows, "hybrid_marching_only_sphere_speedup").value);
}

TEST(SkipFigures, MergingIsTheMedianOfTransferFunctionsAtSixteenPartitions) {
    const std::vector<Row> rows{merged(skull(), 4, 16, 8), merged(skull(), 4, 16, 12),
                                merged(skull(), 4, 16, 30), merged(skull(), 4, 32, 1),
                                merged(skull(), 2, 16, 5)};
    const Figure four = figureOf(skull(), rows, "merge_16_speedup_edge_4");
    EXPECT_EQ(four.value, 12.0);
    EXPECT_EQ(four.reached(), true);
    EXPECT_EQ(four.from, "times as fast, median of 3 transfer functions (8 to 30)");
    const Figure two = figureOf(skull(), rows, "merge_16_speedup_edge_2");
    EXPECT_EQ(two.value, 5.0);
    EXPECT_FALSE(two.reached()); // nothing was asked of it
    EXPECT_EQ(figureOf(skull(), rows, "merge_16_speedup_edge_1").from,
              "not measured: over the memory budget");
}

TEST(SkipFigures, TheOctreeOf256IsJudgedWhereItWasBuilt) {
    Row row{.table = Table::Sizes,
            .volume = "gap",
            .options = {.structure = SkipStructure::BitfieldOctree}};
    row.cube = Cube{.edge = 256, .volumeBytes = 0, .codesMs = 21.0};
    row.build = Build{.ms = {70, 50, 55}, .memory = {.gpuBytes = 2 * 256 * 256 * 256 / 10}};
    const Figure ms = figureOf(gap(), {row}, "bitfield_octree_256_build_ms");
    EXPECT_EQ(ms.value, 55.0);
    EXPECT_EQ(ms.reached(), true);
    const Figure share = figureOf(gap(), {row}, "bitfield_octree_256_memory_share");
    EXPECT_NEAR(*share.value, 0.1, 1e-6);
    EXPECT_EQ(share.reached(), false); // 0.05 was asked for
    row.build->refused = "over the budget";
    EXPECT_FALSE(figureOf(gap(), {row}, "bitfield_octree_256_build_ms").value);
    row.cube->edge = 128;
    EXPECT_FALSE(figureOf(gap(), {row}, "bitfield_octree_256_build_ms").value);
}

TEST(SkipFigures, TheLineNamesWhatWasMissed) {
    const std::vector<Figure> figures{
        {.key = "a", .name = "one", .volume = "skull", .value = 2.5, .goal = 3.0},
        {.key = "b",
         .name = "two",
         .volume = "skull",
         .value = 1.0,
         .goal = 1.7,
         .sense = Sense::AtMost},
        {.key = "c", .name = "three", .volume = "skull", .value = 1.0},
        {.key = "d", .name = "four", .volume = "skull", .goal = 1.0}};
    EXPECT_EQ(tallyOf(figures).judged, 2);
    EXPECT_EQ(tallyOf(figures).reached, 1);
    EXPECT_EQ(lineOf(figures),
              "summary: 1 of 2 figures reached; one (skull): 2.5 >= 3 does not hold");
}

} // namespace
