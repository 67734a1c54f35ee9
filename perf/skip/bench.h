#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "perf/frame_times.h"
#include "perf/json.h"
#include "perf/report_folder.h"
#include "perf/skip/row.h"
#include "perf/stage.h"

namespace slabcast {
struct RunInfo;
}

namespace slabcast::skipbench {

/// A volume that is looked at.
struct Input {
    std::string volume;         // as Host::open knows it
    std::string voxels{};       // their fingerprint()
    bool usualTransfer = false; // under the TF that it has unless another was asked for
    Json key{};                 // all that its pictures depend on, voxels and TF among it
};

/// Whose goals hold: those of the project's own scenes, under the TF that they were set with.
/// Tested by: figures_test.cpp
OwnScene ownSceneOf(const Input& input, const std::string& transferFunction);

/// What is compared, and on what.
struct Desc {
    std::vector<Input> volumes;
    gl::Caps device; // that draws
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
/// figures. Takes minutes: what is finished is kept in the folder's RunStore (a round of a race, a
/// choice of parameters tried, the builds of a volume, a transfer function merged), and a run cut
/// short goes on. Fails: InvalidArgument (nothing of a volume is shown), and as the host, plan(),
/// the renderer and RunStore::open() do. Contract: frames >= kFewestFrames. Tested by:
/// skipbench_test.py
Result<Report> run(const Desc& desc, const Host& host, const RunInfo& info, ReportFolder& folder);

} // namespace slabcast::skipbench
