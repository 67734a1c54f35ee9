#include "perf/edit/summary.h"

#include <gtest/gtest.h>

using namespace slabcast;

namespace {

EditRow frame(bool edited, double ms, double octreeMs) {
    return {.step = "jump",
            .edited = edited,
            .structure = "proximity",
            .frameMs = ms,
            .octreeMs = octreeMs,
            .octreeWorstMs = octreeMs};
}

EditRow compared(bool edited, bool equal) {
    EditRow row = frame(edited, 1.0, 1.0);
    row.equal = equal;
    return row;
}

TEST(EditSummary, EachFrameIsMeasuredByTheOctreesFrameOfItsOwn) {
    // The longest frame is not the worst: it takes 1.2 octree frames, the short one 3.
    const std::vector<EditRow> rows{frame(false, 12, 10), frame(true, 3, 1), frame(false, 10, 10)};
    const EditSummary s = summaryOf(rows, std::nullopt);
    EXPECT_EQ(s.overOctree.max, 3.0);
    EXPECT_EQ(s.overOctree.median, 1.2);
    EXPECT_EQ(s.framesOverBudget, 1); // the short one, of 3 ms: its budget is 1.5
    EXPECT_EQ(s.frames, 3);
    EXPECT_EQ(s.edits, 1);
    EXPECT_EQ(s.frameMs.max, 12.0);
    EXPECT_EQ(s.editFrameMs.count, 1);
    EXPECT_EQ(s.editFrameMs.max, 3.0);
}

TEST(EditSummary, TheBudgetIsTheOctreesUnlessGiven) {
    const std::vector<EditRow> rows{frame(false, 20, 10), frame(false, 16, 10),
                                    frame(false, 12, 10)};
    EXPECT_EQ(summaryOf(rows, std::nullopt).framesOverBudget, 2);
    EXPECT_EQ(summaryOf(rows, 12.0).framesOverBudget, 2); // 12 is within
    EXPECT_EQ(budgetOf(rows[0], std::nullopt), 15.0);
    EXPECT_EQ(budgetOf(rows[0], 12.0), 12.0);
}

TEST(EditSummary, AFrameOfADearViewIsWithinItsOwnBudgetAndNotOverAnothers) {
    // By the median octree frame, 10 ms, the dear frames would be over and the slow one within.
    const std::vector<EditRow> rows{frame(false, 10, 10), frame(false, 40, 40),
                                    frame(false, 44, 40), frame(false, 9, 10), frame(true, 4, 2)};
    EXPECT_EQ(summaryOf(rows, std::nullopt).framesOverBudget, 1);
}

TEST(EditSummary, WhatIsAddedIsAllButDrawing) {
    EditRow row = frame(true, 10, 4);
    row.editMs = 0.5;
    row.workMs = 1.0;
    row.prepareMs = 0.5;
    row.drawMs = 8.0;
    EXPECT_EQ(summaryOf({row}, std::nullopt).worstAdded, 1.5);
}

TEST(EditSummary, TheNaivePolicyIsJudgedByTheSameBudget) {
    EditRow slow = frame(true, 1, 1);
    slow.naiveMs = 5.0;
    EditRow fast = frame(false, 1, 1);
    fast.naiveMs = 1.0;
    const EditSummary s = summaryOf({slow, fast}, std::nullopt);
    EXPECT_EQ(s.worstNaive, 5.0);
    EXPECT_EQ(s.naiveFramesOverBudget, 1);
    EXPECT_EQ(s.naiveMs.median, 3.0);
    EXPECT_EQ(s.naiveEditFrameMs.median, 5.0);
}

TEST(EditSummary, WithoutEditsNothingIsSaidOfThem) {
    const EditSummary s = summaryOf({compared(false, true), compared(false, true)}, std::nullopt);
    EXPECT_EQ(s.edits, 0);
    EXPECT_EQ(s.editFrameMs.count, 0);
    EXPECT_EQ(s.editMs.count, 0);
    EXPECT_EQ(s.framesEqual, 2);
    EXPECT_FALSE(s.framesToCorrect);
}

TEST(EditSummary, FramesToCorrectAreThoseOfTheSlowestEdit) {
    EXPECT_EQ(summaryOf({compared(true, true), compared(false, true)}, {}).framesToCorrect, 1);
    EXPECT_EQ(summaryOf({compared(true, true), compared(true, false), compared(false, false),
                         compared(false, true)},
                        {})
                  .framesToCorrect,
              3);
}

TEST(EditSummary, AnEditThatSawNoRightFrameBeforeTheNextHasNoNumber) {
    EXPECT_FALSE(summaryOf({compared(true, false), compared(true, true)}, {}).framesToCorrect);
    EXPECT_FALSE(summaryOf({compared(true, true), compared(true, false)}, {}).framesToCorrect);
}

TEST(EditSummary, FramesAreCountedByWhatServed) {
    EditRow octree = frame(true, 1, 1);
    octree.structure = "bitfield-octree";
    EditRow swapped = frame(false, 1, 1);
    swapped.progress = LiveProgress::Swapped;
    const EditSummary s = summaryOf({octree, swapped, frame(false, 1, 1)}, std::nullopt);
    EXPECT_EQ(s.framesByStructure,
              (std::map<std::string, int>{{"bitfield-octree", 1}, {"proximity", 2}}));
    EXPECT_EQ(s.handOvers, 1);
}

TEST(EditReplays, TimesAreMediansFrameByFrame) {
    const EditReplays replays{{frame(true, 1, 2), frame(false, 9, 2)},
                              {frame(true, 5, 2), frame(false, 3, 4)},
                              {frame(true, 2, 8), frame(false, 6, 6)}};
    const std::vector<EditRow> rows = mediansOf(replays);
    ASSERT_EQ(rows.size(), 2U);
    EXPECT_EQ(rows[0].frameMs, 2.0);
    EXPECT_EQ(rows[0].octreeMs, 2.0);
    EXPECT_EQ(rows[1].frameMs, 6.0);
    EXPECT_EQ(rows[1].octreeMs, 4.0);
    EXPECT_TRUE(rows[0].edited);
    EXPECT_EQ(worstOverOctree(replays), 4.5); // of any single one: 9 over 2
}

TEST(EditReplays, AFrameIsEqualWhereItAlwaysWas) {
    const EditReplays replays{{compared(true, true), compared(false, true)},
                              {compared(true, false), compared(false, true)}};
    const std::vector<EditRow> rows = mediansOf(replays);
    EXPECT_EQ(rows[0].equal, false);
    EXPECT_EQ(rows[1].equal, true);
}

} // namespace
