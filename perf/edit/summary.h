#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "perf/edit/row.h"
#include "perf/frame_times.h"

namespace slabcast {

/// Of replays of the same script: each frame's times are medians, and it is equal where it always
/// was; all else is the first replay's. Contract: one replay at least, all of as many frames.
/// Tested by: summary_test.cpp
std::vector<EditRow> mediansOf(const EditReplays& replays);

/// The slowest frame of any replay, in octree frames of its own time.
double worstOverOctree(const EditReplays& replays);

inline constexpr double kBudgetOverOctree = 1.5; // what a frame may take, in octree frames

/// What all frames come to. Ratios are each of a frame to the octree frame of the same picture.
struct EditSummary {
    int frames = 0;
    int edits = 0;
    FrameTimes frameMs, octreeMs, naiveMs;
    FrameTimes editFrameMs, editMs, naiveEditFrameMs; // of frames with an edit
    FrameTimes overOctree;
    double worstAdded = 0.0;        // 1 and the share that edit, work and uploads are
    double worstOctreeSpread = 0.0; // of the octree's frames, over their median
    double worstNaive = 0.0;
    double budgetMs = 0.0;
    int framesOverOctreeBudget = 0; // over kBudgetOverOctree
    int framesOverBudget = 0;
    int naiveFramesOverBudget = 0;
    std::map<std::string, int> framesByStructure;
    int handOvers = 0; // how often a rebuilt structure took over
    int framesEqual = 0;
    /// From an edit to the first frame that equals one from scratch, that one counted, of the edit
    /// that took most; nothing without edits, and where one saw no such frame before the next.
    std::optional<int> framesToCorrect;
};

/// `budgetMs`: what a frame may take; by the octree's median where none is given.
/// Tested by: summary_test.cpp
EditSummary summaryOf(const std::vector<EditRow>& rows, std::optional<double> budgetMs);

} // namespace slabcast
