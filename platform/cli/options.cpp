#include "platform/cli/options.h"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include "perf/stability/bench.h"
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

void bindTargetError(CLI::App& command, RenderOptions& o) {
    const auto group = "Accuracy";
    CLI::Option* target =
        addNumber(command, "--target-error", o.targetError, 0.0, 1.0,
                  "take the cheapest sampling (--layer-spacing, --layers-per-plane, --classify, "
                  "--target, --termination, --jitter) that is expected to come within this RMSE of "
                  "the exact picture, of those that `slabcast error` measured on this device")
            ->type_name("RMSE")
            ->default_str("off")
            ->group(group);
    for (const char* decided : {"--layer-spacing", "--layers", "--layers-per-plane", "--planes",
                                "--classify", "--target", "--termination", "--jitter"}) {
        target->excludes(command.get_option(decided));
    }
    command
        .add_flag("--verify", o.verify,
                  "integrate the exact picture too, which takes a while, and print how far off "
                  "this one is; --stats gets it as well")
        ->group(group);
    command.final_callback([&o] {
        if (o.settings.shaded && (o.verify || o.targetError)) {
            throw CLI::ValidationError(o.verify ? "--verify" : "--target-error",
                                       "knows pictures without shading only: leave it or --shade "
                                       "phong out");
        }
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

void bindHeatmap(CLI::App& command, RenderOptions& o) {
    const auto group = "Output";
    CLI::Option* heatmap =
        addChoice(command, "--heatmap", o.heatmap,
                  {{"off", std::nullopt},
                   {name(HeatmapQuantity::Iterations), HeatmapQuantity::Iterations},
                   {name(HeatmapQuantity::Fetches), HeatmapQuantity::Fetches},
                   {name(HeatmapQuantity::Layers), HeatmapQuantity::Layers}},
                  "draw what each pixel costs instead: iterations are looks at the skip structure "
                  "and layers evaluated, fetches are of volume and skip structure")
            ->group(group);
    addParsed<HeatmapScale>(
        command, "--heatmap-scale", o.heatmapScale, parseHeatmapScale,
        fmt::format("normalised, absolute or a number from {} to {}", kLeastHeat, kMostHeat),
        "cost of the last colour: the picture's most, the number of layers in all, or a number")
        ->type_name("normalised|absolute|MAXIMUM")
        ->default_str("normalised")
        ->needs(heatmap)
        ->group(group);
}

} // namespace

void bindRender(CLI::App& command, RenderOptions& o) {
    const auto output = "Output";
    command.add_option("-o,--output", o.output, "picture to write, .png or .exr")
        ->required()
        ->type_name("FILE")
        ->group(output);
    addNumber(command, "--frames", o.frames, 1, 100000,
              "turn the volume once around in N frames and time them; the first is written")
        ->type_name("N")
        ->default_str(fmt::format("{}", o.frames))
        ->group(output);
    command
        .add_option("--stats", o.statsFile,
                    "write device, plan, frame times and work counters as JSON")
        ->type_name("FILE")
        ->group(output);
    command.add_flag("--explain", o.explain, "print what the plan chose and why")->group(output);
    bindHeatmap(command, o);
    bindScene(command, o);
    bindBackground(command, o);
    bindSkipping(command, o);
    addNumber(command, "--layers", o.settings.totalLayers, 1, kMaxLayers,
              "layers in all, instead of --layer-spacing")
        ->type_name("N")
        ->default_str("by spacing")
        ->group(kLayersGroup);
    addNumber(command, "--planes", o.settings.planes, 1, kMaxLayers,
              "proxy planes: 1 is ray casting, as many as layers is slicing")
        ->type_name("N")
        ->default_str("the fastest of several, measured")
        ->group(kLayersGroup);
    bindLayersPerPlane(command, o.settings, "instead of --planes: 1 is slicing", "by planes");
    bindTargetError(command, o);
    command.footer("Example: a skull from the side, shaded, with the reasons for what was chosen\n"
                   "  slabcast render skull.nrrd -o skull.png --tf ct-bone --shade phong --camera "
                   "90,10,2.5 --explain");
}

void bindSweep(CLI::App& command, SweepOptions& o) {
    const auto group = "Output";
    o.size = {512, 512};
    command
        .add_option("--out", o.outputFolder,
                    "folder for sweep.json, sweep.csv and report.html; made where it is missing")
        ->required()
        ->type_name("FOLDER")
        ->group(group);
    addList<int>(command, "--layers", o.layersPerPlane, numberParser<int>(0, kMaxLayers),
                 fmt::format("whole numbers from 0 to {}", kMaxLayers),
                 "layers per plane to measure; 1 is slicing, 0 is all in one plane: ray casting")
        ->type_name("N,N,...")
        ->default_str(fmt::format("{},0", fmt::join(kUnrollLengths, ",")))
        ->group(group);
    addNumber(command, "--frames", o.frames, 1, 10000, "frames of one turn per row")
        ->type_name("N")
        ->default_str(fmt::format("{}", o.frames))
        ->group(group);
    bindScene(command, o);
    bindBackground(command, o);
    bindSkipping(command, o);
    command.footer("Example: what each ratio costs on this device; look at sweep/report.html\n"
                   "  slabcast sweep phantom:vessels:128 --layers 1,4,16,64,0 --out sweep");
}

void bindStability(CLI::App& command, StabilityOptions& o) {
    const auto group = "Output";
    command
        .add_option("--out", o.outputFolder,
                    "folder for stability.json, stability.csv and report.html; made where missing")
        ->required()
        ->type_name("FOLDER")
        ->group(group);
    addChoice(command, "--family", o.family, familyWords(), "only the cases of this family")
        ->group(group);
    command.add_flag("--reduced", o.reduced, "fewer sizes, views and repetitions; the same bounds")
        ->group(group);
    command.footer("Example: every case, with its bound and what was measured\n"
                   "  slabcast stability --out stability");
}

void bindInfo(CLI::App& command, InputOptions& o) {
    bindInput(command, o);
    command.footer("Example: half the resolution of voxels without a header\n"
                   "  slabcast info head.raw --raw 256x256x128,uint16,1x1x1.5 --downsample 2");
}

} // namespace slabcast
