#include "platform/cli/options.h"

#include <filesystem>

#include <fmt/core.h>
#include <fmt/ranges.h>

#include "core/plan/settings_check.h"
#include "perf/stability/bench.h"
#include "platform/cli/picture_file.h"
#include "platform/cli/scene_options.h"
#include "platform/cli/skip_options.h"

namespace slabcast {

namespace {

/// The families of `stability`, each by its name.
Choices<std::string> familyWords() {
    Choices<std::string> words{{"all", ""}};
    for (const stability::Family& family : stability::families()) {
        words.emplace_back(family.name, family.name);
    }
    return words;
}

void bindTargetError(Command& command, RenderOptions& o) {
    const auto group = "Accuracy";
    addNumber(command,
              {.flag = "--target-error",
               .help = "take the cheapest sampling (--layer-spacing, --layers-per-plane, "
                       "--classify, --target, --termination, --jitter) that is expected to come "
                       "within this RMSE of the exact picture, of those that `slabcast error` "
                       "measured on this device",
               .word = "RMSE",
               .usually = "off",
               .group = group,
               .hides = {"--layer-spacing", "--layers", "--layers-per-plane", "--planes",
                         "--classify", "--target", "--termination", "--jitter"}},
              o.targetError, 0.0, 1.0);
    addFlag(command,
            {.flag = "--verify",
             .help = "integrate the exact picture too, which takes a while, and print how far off "
                     "this one is; --stats gets it as well",
             .group = group},
            o.verify);
    command.checks.emplace_back([&o](const Given&) -> Result<void> {
        if (o.settings.shaded && (o.verify || o.targetError)) {
            return fail(ErrorCode::InvalidArgument,
                        fmt::format("{}: knows pictures without shading only: leave it or --shade "
                                    "phong out",
                                    o.verify ? "--verify" : "--target-error"));
        }
        return {};
    });
}

constexpr double kLeastHeat = 0.01; // of a heatmap's last colour
constexpr double kMostHeat = 1e9;

std::optional<HeatmapScale> parseHeatmapScale(const std::string& word) {
    if (word == "normalised" || word == "absolute") {
        return HeatmapScale{.absolute = word == "absolute"};
    }
    const auto maximum = numberParser<double>(kLeastHeat, kMostHeat)(word);
    return maximum ? std::optional(HeatmapScale{.maximum = maximum}) : std::nullopt;
}

void bindHeatmap(Command& command, RenderOptions& o) {
    const auto group = "Output";
    addChoice(command,
              {.flag = "--heatmap",
               .help = "draw what each pixel costs instead: iterations are looks at the skip "
                       "structure and layers evaluated, fetches are of volume and skip structure",
               .group = group,
               .hides = {"--background"}},
              o.heatmap,
              {{"off", std::nullopt},
               {name(HeatmapQuantity::Iterations), HeatmapQuantity::Iterations},
               {name(HeatmapQuantity::Fetches), HeatmapQuantity::Fetches},
               {name(HeatmapQuantity::Layers), HeatmapQuantity::Layers}});
    addParsed(command,
              {.flag = "--heatmap-scale",
               .help =
                   "cost of the last colour: the picture's most, the number of layers in all, or a "
                   "number",
               .word = "normalised|absolute|MAXIMUM",
               .usually = "normalised",
               .group = group,
               .needs = {"--heatmap"}},
              o.heatmapScale, parseHeatmapScale,
              fmt::format("normalised, absolute or a number from {} to {}", kLeastHeat, kMostHeat));
}

/// What settings that go together cannot be: core's own words.
void checkSettings(Command& command, const Settings& settings) {
    command.checks.emplace_back([&settings](const Given&) { return check(settings); });
}

void checkOutputs(Command& command, const RenderOptions& o) {
    command.checks.emplace_back([&o](const Given&) -> Result<void> {
        const std::filesystem::path picture = o.output;
        const auto place = [](const std::string& file) {
            return std::filesystem::absolute(file).lexically_normal();
        };
        if (!isPictureName(picture)) {
            return fail(ErrorCode::InvalidArgument,
                        fmt::format("--output: '{}' is not the name of a .png or .exr file: give "
                                    "a name that ends so",
                                    o.output));
        }
        if (!o.statsFile.empty() && place(o.statsFile) == place(o.output)) {
            return fail(ErrorCode::InvalidArgument,
                        fmt::format("--stats: {} is named for both picture and statistics; give "
                                    "--stats another name",
                                    o.statsFile));
        }
        return {};
    });
}

void bindOutputs(Command& command, RenderOptions& o) {
    const auto group = "Output";
    addText(command,
            {.flag = "-o,--output",
             .help = "picture to write, .png or .exr",
             .word = "FILE",
             .group = group,
             .required = true},
            o.output);
    addNumber(command,
              {.flag = "--frames",
               .help = "turn the volume once around in N frames and time them, for --stats; the "
                       "first is written. Ratios that are left open are measured before, once per "
                       "device, scene and settings; of a single frame they go by device alone",
               .word = "N",
               .usually = fmt::format("{}", o.frames),
               .group = group,
               .needs = {"--stats"}},
              o.frames, 1, 100000);
    addText(command,
            {.flag = "--stats",
             .help = "write device, plan, frame times and work counters as JSON",
             .word = "FILE",
             .group = group},
            o.statsFile);
    addFlag(command,
            {.flag = "--explain", .help = "print what the plan chose and why", .group = group},
            o.explain);
    checkOutputs(command, o);
}

} // namespace

void bindRender(Command& command, RenderOptions& o) {
    bindOutputs(command, o);
    bindHeatmap(command, o);
    bindScene(command, o);
    bindBackground(command, o);
    bindSettingsBut(command, o.settings, {});
    bindTargetError(command, o);
    checkSettings(command, o.settings);
    checkSkipping(command, o);
    command.footer =
        "Example: a skull from the side, shaded, with the reasons for what was chosen\n"
        "  slabcast render skull.nrrd -o skull.png --tf ct-bone --shade phong "
        "--camera 90,10,2.5 --explain";
}

void bindSweep(Command& command, SweepOptions& o) {
    const auto group = "Output";
    o.size = {512, 512};
    bindReportFolder(command, o.folder,
                     "sweep.json, sweep.csv, report.html, figures and thumbnails; made where it is "
                     "missing; a run cut short goes on where it was");
    addList(
        command,
        {.flag = "--layers",
         .help = "layers per plane to measure; 1 is slicing, 0 is all in one plane: ray casting",
         .word = "N,N,...",
         .usually = fmt::format("{},0", fmt::join(kUnrollLengths, ",")),
         .group = group},
        o.layersPerPlane, numberParser<int>(0, kMaxTotalLayers),
        fmt::format("whole numbers from 0 to {}", kMaxTotalLayers));
    addNumber(command,
              {.flag = "--frames",
               .help = "rounds of one turn, in each of which every row draws a frame; percentiles "
                       "need 9",
               .word = "N",
               .usually = fmt::format("{}", o.frames),
               .group = group},
              o.frames, 1, 10000);
    bindScene(command, o);
    bindBackground(command, o);
    bindSettingsBut(command, o.settings, {"layers", "planes", "layers-per-plane"});
    checkSettings(command, o.settings);
    checkSkipping(command, o);
    command.footer = "Example: what each ratio costs on this device; look at sweep/report.html\n"
                     "  slabcast sweep phantom:vessels:128 --layers 1,4,16,64,0 --out sweep";
}

void bindStability(Command& command, StabilityOptions& o) {
    const auto group = "Output";
    bindReportFolder(command, o.folder,
                     "stability.json, stability.csv, report.html, figures and pictures; made where "
                     "missing");
    const Choices<std::string> families = familyWords();
    addChoice(command,
              {.flag = "--family",
               .help = "only the cases of this family: " + wordsOf(families, ", "),
               .group = group},
              o.family, families)
        .word = "FAMILY";
    bindDevice(command, o.session);
    addFlag(command,
            {.flag = "--reduced",
             .help = "fewer sizes, views and repetitions; the same bounds",
             .group = group},
            o.reduced);
    command.footer = "Example: every case, with its bound and what was measured\n"
                     "  slabcast stability --out stability";
}

void bindInfo(Command& command, InputOptions& o) {
    bindInput(command, o);
    command.footer = "Example: half the resolution of voxels without a header\n"
                     "  slabcast info head.raw --raw 256x256x128,uint16,1x1x1.5 --downsample 2";
}

} // namespace slabcast
