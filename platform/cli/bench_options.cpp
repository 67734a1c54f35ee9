#include <fmt/core.h>
#include <fmt/ranges.h>

#include "perf/frame_times.h"
#include "platform/cli/scene_options.h"
#include "platform/cli/skip_options.h"

namespace slabcast {

namespace {

constexpr glm::ivec2 kQuickSize(160);      // of `error`
constexpr glm::ivec2 kQuickBenchSize(128); // of `skipbench`
constexpr int kQuickFrames = 5;
const std::vector<int> kBenchSizes{64, 128, 256, 512};
const std::vector<int> kQuickBenchSizes{64, 128, 256};

template <class T>
void takeUnlessGiven(const Given& given, const char* flag, T& value, const T& taken) {
    if (!given(flag)) {
        value = taken;
    }
}

/// The sampling's settings, several values each.
void bindGrid(Command& command, GridAxes& axes) {
    const auto group = "What is varied";
    const GridAxes usual = completed({}, false);
    const auto option = [&](const char* word, const char* help) {
        return Option{.help = help, .word = word, .group = group};
    };
    bindSettingList(
        command, "layer-spacing",
        option("VOXELS,...", "distances of layers in units of the smallest voxel edge"),
        axes.spacings, usual.spacings, [](Settings & s) -> auto& { return s.layerSpacingVoxels; });
    addList(command,
            {.flag = "--layers-per-plane",
             .help = "1 is slicing, 0 is all in one plane: ray casting",
             .word = "N,...",
             .usually = fmt::format("{}", fmt::join(usual.layersPerPlane, ",")),
             .group = group},
            axes.layersPerPlane, numberParser<int>(0, kMaxTotalLayers),
            fmt::format("whole numbers from 0 to {}", kMaxTotalLayers));
    bindSettingList(
        command, "classify", option("WORD,...", "kinds of classification"), axes.classifications,
        usual.classifications, [](Settings & s) -> auto& { return s.classification; });
    bindSettingList(
        command, "target", option("WORD,...", "what planes are blended into"), axes.targets,
        usual.targets, [](Settings & s) -> auto& { return s.target; });
    bindSettingList(
        command, "jitter", option("WORD,...", "layers moved by up to half a layer"), axes.jitter,
        usual.jitter, [](Settings & s) -> auto& { return s.jitter; });
    bindSettingList(
        command, "termination", option("A|off,...", "opacities at which a segment is left, or off"),
        axes.terminations, usual.terminations, [](Settings & s) -> auto& { return s.termination; });
}

void bindFrames(Command& command, int& frames) {
    addNumber(command,
              {.flag = "--frames",
               .help = "timed frames per row, fewer of slow ones",
               .word = "N",
               .usually = fmt::format("{}", frames),
               .group = "Output"},
              frames, kFewestFrames, 10000);
}

} // namespace

void bindError(Command& command, ErrorOptions& o) {
    bindReportFolder(command, o.folder,
                     "error.json, error.csv, report.html, figures and pictures; made where it is "
                     "missing; a run cut short goes on where it was");
    addFlag(command,
            {.flag = "--quick",
             .help = fmt::format("{}x{} pixels and fewer settings", kQuickSize.x, kQuickSize.y),
             .group = "Output"},
            o.quick);
    addChoice(command,
              {.flag = "--verification",
               .help = "refine step, grid and pixel too, in a field by formula, with deliberate "
                       "mistakes beside: does the error have the orders that theory gives it? And "
                       "take the worst ray apart, layer by layer. Some seconds",
               .group = "Output"},
              o.verification, {{"on", true}, {"off", false}})
        .usually = "on, with --quick off";
    bindFrames(command, o.frames);
    bindInput(command, o.input);
    bindTexture(command, o.input);
    o.size = {256, 256};
    bindCamera(command, o);
    bindTransfer(command, o);
    bindDevice(command, o.session);
    bindGrid(command, o.axes);
    bindSettingsBut(command, o.settings,
                    {"layer-spacing", "layers", "planes", "layers-per-plane", "classify", "target",
                     "jitter", "termination", "shade"});
    checkSkipping(command, o);
    command.checks.emplace_back([&o](const Given& given) -> Result<void> {
        if (o.quick) {
            takeUnlessGiven(given, "--size", o.size, kQuickSize);
        }
        return {};
    });
    command.footer = "Example: which setting is worth its time on this device; look at "
                     "err/report.html\n"
                     "  slabcast error phantom:vessels:64 --quick --out err";
}

void bindSkipbench(Command& command, SkipbenchOptions& o) {
    command.options.push_back(
        {.flag = "VOLUME",
         .help = "one or several, as other commands take one: files, folders or "
                 "phantom:NAME[:SIZE]; phantom:gap has its bulk where its preset shows nothing",
         .required = true,
         .several = true,
         .take = [&o](const std::string& word) -> Result<void> {
             o.volumes.push_back(word);
             return {};
         }});
    bindReportFolder(
        command, o.folder,
        "skipbench.json, skipbench.csv, report.html and figures; made where missing; a "
        "run cut short goes on where it was");
    addFlag(command,
            {.flag = "--quick",
             .help = fmt::format("{}x{} pixels, {} frames, fewer parameters and sizes",
                                 kQuickBenchSize.x, kQuickBenchSize.y, kQuickFrames),
             .group = "Output"},
            o.quick);
    bindFrames(command, o.frames);
    addList(command,
            {.flag = "--sizes",
             .help = "edges of the cubes that the first volume is resampled to",
             .word = "N,...",
             .usually = fmt::format("{}", fmt::join(kBenchSizes, ",")),
             .group = "What is varied"},
            o.sizes, numberParser<int>(1, 1024), "whole numbers from 1 to 1024");
    o.size = {256, 256};
    bindCamera(command, o);
    bindTransfer(command, o);
    bindDevice(command, o.session);
    bindSetting(command, o.settings, "space");
    bindSetting(command, o.settings, "partition-budget");
    command.checks.emplace_back([&o](const Given& given) -> Result<void> {
        if (o.quick) {
            takeUnlessGiven(given, "--size", o.size, kQuickBenchSize);
            takeUnlessGiven(given, "--frames", o.frames, kQuickFrames);
        }
        takeUnlessGiven(given, "--sizes", o.sizes, o.quick ? kQuickBenchSizes : kBenchSizes);
        return {};
    });
    command.footer = "Example: which way to skip suits this device; look at bench/report.html\n"
                     "  slabcast skipbench skull.nrrd phantom:gap --quick --out bench";
}

void bindModel(Command& command, ModelOptions& o) {
    bindReportFolder(command, o.folder, "model.json; made where it is missing");
    addList(command,
            {.flag = "--layers",
             .help = "layers per plane; 0 is all: ray casting",
             .word = "N,...",
             .usually = fmt::format("{},0", fmt::join(kUnrollLengths, ",")),
             .group = "What is varied"},
            o.layersPerPlane, numberParser<int>(0, kMaxTotalLayers),
            fmt::format("whole numbers from 0 to {}", kMaxTotalLayers));
    bindInput(command, o.input);
    bindTexture(command, o.input);
    o.stereoIpdMm = 63.0;
    o.fovDegrees = 90.0;
    o.camera.distanceRadii = 2.0;
    bindCamera(command, o);
    bindTransfer(command, o);
    bindSettingsBut(command, o.settings, {"layers", "planes", "layers-per-plane"});
    checkSkipping(command, o);
    command.checks.emplace_back([](const Given& given) -> Result<void> {
        return given("--size") ? fail(ErrorCode::InvalidArgument,
                                      "--size: has no effect here: sizes are the headsets' own")
                               : Result<void>{};
    });
    command.footer = "Example: what a skull takes on Quest 2 and Quest 3, by a model; nothing of "
                     "it is measured\n"
                     "  slabcast model skull.nrrd --out model";
}

} // namespace slabcast
