#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "core/draw/renderer.h"
#include "core/plan/frame_plan.h"
#include "perf/error/error_grid.h"
#include "perf/heatmap.h"
#include "perf/stage.h"
#include "platform/cli/report_files.h"
#include "platform/cli/session.h"

namespace CLI {
class App;
}

namespace slabcast {

/// What render and sweep have in common: the scene, the camera and the settings of the plan.
struct SceneOptions {
    SessionOptions session;
    InputOptions input;
    std::string tf;
    glm::ivec2 size{1024, 1024};
    OrbitCamera camera;
    double fovDegrees = 40.0;
    std::optional<double> stereoIpdMm;
    Settings settings;
    std::optional<glm::dvec3> background = glm::dvec3(0.0); // sRGB-encoded; none: transparent
};

struct RenderOptions : SceneOptions {
    std::string output;
    std::string statsFile;
    int frames = 1;
    bool explain = false;
    std::optional<double> targetError; // RMSE: decides the sampling
    bool verify = false;
    std::optional<HeatmapQuantity> heatmap; // of the first frame, instead of its picture
    HeatmapScale heatmapScale;
};

struct SweepOptions : SceneOptions {
    FolderOptions folder;
    std::vector<int> layersPerPlane;
    int frames = 12;
};

struct StabilityOptions {
    SessionOptions session;
    FolderOptions folder;
    std::string family; // empty: all
    bool reduced = false;
};

struct ErrorOptions : SceneOptions {
    FolderOptions folder;
    bool quick = false;
    GridAxes axes;
    int frames = 5;                   // of a row, at most
    std::optional<bool> verification; // none: unless quick
};

struct SkipbenchOptions : SceneOptions {
    std::vector<std::string> volumes; // instead of the input's one
    FolderOptions folder;
    bool quick = false;
    int frames = 9;         // of a row, at most
    std::vector<int> sizes; // edges of cubes that the first volume is resampled to
};

struct EditOptions : SceneOptions {
    FolderOptions folder;
    std::string scriptFile;
    std::optional<std::array<std::string, 2>> interpolate; // transfer functions
    int frames = 240;                                      // without a script
    double turnDegrees = 0.0;                              // of the volume, over all frames
    double workBudgetMs = 2.0;
    int quietFrames = LiveOptions{}.quietFrames;
    std::optional<double> budgetMs; // of a frame; none: by the octree's
    int octreeFrames = 3;           // that one is measured against
    int replays = 1;
    bool verify = false;
};

struct ModelOptions : SceneOptions {
    FolderOptions folder;
    std::vector<int> layersPerPlane;
};

struct Command;

// Each binds the options of one command, with its help. `options` must outlive the parsing.
void bindRender(Command& command, RenderOptions& options);
void bindSweep(Command& command, SweepOptions& options);
void bindStability(Command& command, StabilityOptions& options);
void bindError(Command& command, ErrorOptions& options);
void bindSkipbench(Command& command, SkipbenchOptions& options);
void bindModel(Command& command, ModelOptions& options);
void bindEdit(Command& command, EditOptions& options);
void bindDevice(Command& command, SessionOptions& options);
void bindInfo(Command& command, InputOptions& options);

} // namespace slabcast
