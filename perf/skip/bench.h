#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "perf/frame_times.h"
#include "perf/stage.h"

namespace slabcast {
struct RunInfo;
}

namespace slabcast::skipbench {

/// What is compared, and on what.
struct Desc {
    std::vector<std::string> volumes; // as Host::open knows them
    /// Picture, camera and what all plans have in common; its skip options' memory budget is that
    /// of partitioned maps.
    StageDesc stage;
    std::vector<int> sizes; // edges of cubes that the first volume is resampled to
    int frames = 9;         // of a row, at most
    bool quick = false;     // fewer parameters
};

/// What the program that measures brings along.
struct Host {
    /// Opens a volume under a transfer function that shows something of it, all else as the desc
    /// has it; resampled to so many voxels along each axis, or as it is for 0. Called for one stage
    /// after the other, each gone before the next.
    std::function<Result<Stage>(const std::string& volume, int cubeEdge, StageDesc desc)> open;
    /// One more that suits the volume, and is not what it is shown with.
    std::function<Result<TransferFunction>(const Stage& stage)> otherTransfer;
    Watcher watcher;
};

/// As files hold it; docs/reports.md has the keys.
struct Report {
    std::string json;
    std::string csv;
    std::string line; // of the figures, for people
};

/// Every way to skip empty space against none and against each other: frames by ray casting, hybrid
/// and slicing, work, building, merging, memory, growth with the volume's size, beside the papers'
/// figures. Takes minutes. Fails: InvalidArgument (nothing of a volume is shown), and as the host,
/// plan() and the renderer do. Contract: frames >= kFewestFrames. Tested by: skipbench_test.py
Result<Report> run(const Desc& desc, const Host& host, const RunInfo& info);

} // namespace slabcast::skipbench
