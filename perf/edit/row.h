#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/draw/renderer.h"
#include "core/skip/live_skip.h"

namespace slabcast {

/// One frame of an edit as it was replayed. "Octree" stands for the structure that is right under
/// any transfer function: frames by it, nothing else being done, are what the others are measured
/// by.
struct EditRow {
    std::string step;
    bool edited = false;
    LiveProgress progress = LiveProgress::Settled; // of the work in the background
    std::string structure{};                       // that skipped in this frame
    double frameMs = 0.0; // from the edit to the end of drawing: the sum of the next four
    double editMs = 0.0;
    double workMs = 0.0;
    double prepareMs = 0.0;     // plan and uploads
    double drawMs = 0.0;        // clearing included
    double octreeMs = 0.0;      // the same picture by the octree
    double octreeWorstMs = 0.0; // of the frames of which that is the median
    double naiveMs = 0.0;       // the same picture, all being built anew at every edit
    Result<WorkCounters> counters = tl::unexpected(Error{});
    std::optional<bool> equal{}; // to a picture from scratch, where that was asked for
};

/// All frames of each replay of one script.
using EditReplays = std::vector<std::vector<EditRow>>;

} // namespace slabcast
