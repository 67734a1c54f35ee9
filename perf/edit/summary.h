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

/// What this frame may take, ms: what was given for all of them, or by the octree's frame of the
/// same view and transfer function.
double budgetOf(const EditRow& row, std::optional<double> givenMs);

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
    int framesOverBudget = 0; // each over its own: budgetOf()
    int naiveFramesOverBudget = 0;
    std::map<std::string, int> framesByStructure;
    int handOvers = 0; // how often a rebuilt structure took over
    int framesEqual = 0;
    /// From an edit to the first frame that equals one from scratch, that one counted, of the edit
    /// that took most; nothing without edits, and where one saw no such frame before the next.
    std::optional<int> framesToCorrect;
};

/// `givenMs`: what any frame may take; by budgetOf() each where none is given.
/// Tested by: summary_test.cpp
EditSummary summaryOf(const std::vector<EditRow>& rows, std::optional<double> givenMs);

} // namespace slabcast
