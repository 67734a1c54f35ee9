#include "platform/cli/options.h"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include "perf/stability/bench.h"
#include "platform/cli/scene_options.h"

namespace slabcast {

namespace {

void bindScene(CLI::App& command, SceneOptions& o) {
    bindInput(command, o.input);
    bindTexture(command, o.input);
    bindCamera(command, o);
    bindEyes(command, o);
    bindLook(command, o);
    bindShading(command, o.settings);
    bindSampling(command, o.settings);
    bindStack(command, o);
}

constexpr glm::ivec2 kQuickSize(160); // of `error`

/// The families of `stability`, each by its name.
Choices<std::string> familyWords() {
    Choices<std::string> words{{"all", ""}};
    for (const stability::Family& family : stability::families()) {
        words.emplace_back(family.name, family.name);
    }
    return words;
}

/// The sampling's options, several values each.
void bindGrid(CLI::App& command, GridAxes& axes) {
    const auto group = "What is varied";
    const GridAxes usual = completed({}, false);
    addList<double>(command, "--layer-spacing", axes.spacings,
                    numberParser<double>(kLeastSpacing, kMostSpacing),
                    fmt::format("numbers from {} to {}", kLeastSpacing, kMostSpacing),
                    "distances of layers in units of the smallest voxel edge")
        ->type_name("VOXELS,...")
        ->default_str(fmt::format("{}", fmt::join(usual.spacings, ",")))
        ->group(group);
    addList<int>(command, "--layers-per-plane", axes.layersPerPlane,
                 numberParser<int>(0, kMaxLayers),
                 fmt::format("whole numbers from 0 to {}", kMaxLayers),
                 "1 is slicing, 0 is all in one plane: ray casting")
        ->type_name("N,...")
        ->default_str(fmt::format("{}", fmt::join(usual.layersPerPlane, ",")))
        ->group(group);
    const auto addWords = [&](const char* flag, auto& values, const auto& usually,
                              const auto& choices, const char* help) {
        std::vector<std::string> words;
        for (const auto value : usually) {
            words.push_back(wordFor(choices, value));
        }
        addList(command, flag, values, choiceParser(choices),
                "one or several of " + wordsOf(choices, ", "), help)
            ->type_name("WORD,...")
            ->default_str(fmt::format("{}", fmt::join(words, ",")))
            ->group(group);
    };
    addWords("--classify", axes.classifications, usual.classifications, classificationWords(),
             "kinds of classification");
    addWords("--target", axes.targets, usual.targets, targetWords(),
             "what planes are blended into");
    addWords("--jitter", axes.jitter, usual.jitter, onOffWords(),
             "layers moved by up to half a layer");
    std::vector<std::string> opacities;
    for (const std::optional<double>& opacity : usual.terminations) {
        opacities.push_back(opacity ? fmt::format("{:.4f}", *opacity) : "off");
    }
    addList<std::optional<double>>(command, "--termination", axes.terminations, parseTermination,
                                   "opacities above 0 and up to 1, or off,",
                                   "opacities at which a segment is left, or off")
        ->type_name("A|off,...")
        ->default_str(fmt::format("{}", fmt::join(opacities, ",")))
        ->group(group);
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
    bindScene(command, o);
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
    addNumber(command, "--layers-per-plane", o.settings.layersPerPlane, 1, kMaxLayers,
              "instead of --planes: 1 is slicing")
        ->type_name("N")
        ->default_str("by planes")
        ->group(kLayersGroup);
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

void bindError(CLI::App& command, ErrorOptions& o) {
    const auto group = "Output";
    command
        .add_option("--out", o.outputFolder,
                    "folder for error.json, error.csv, report.html and pictures; made where it is "
                    "missing; a run cut short goes on where it was")
        ->required()
        ->type_name("FOLDER")
        ->group(group);
    command
        .add_flag("--quick", o.quick,
                  fmt::format("{}x{} pixels and fewer settings", kQuickSize.x, kQuickSize.y))
        ->group(group);
    command.final_callback([&command, &o] {
        if (o.quick && command.count("--size") == 0) {
            o.size = kQuickSize;
        }
    });
    addNumber(command, "--frames", o.frames, kFewestFrames, 10000,
              "timed frames per row, fewer of slow ones")
        ->type_name("N")
        ->default_str(fmt::format("{}", o.frames))
        ->group(group);
    bindInput(command, o.input);
    bindTexture(command, o.input);
    o.size = {256, 256};
    bindCamera(command, o);
    bindLook(command, o);
    bindGrid(command, o.axes);
    bindStack(command, o);
    command.footer("Example: which setting is worth its time on this device; look at "
                   "err/report.html\n"
                   "  slabcast error phantom:vessels:64 --quick --out err");
}

void bindInfo(CLI::App& command, InputOptions& o) {
    bindInput(command, o);
    command.footer("Example: half the resolution of voxels without a header\n"
                   "  slabcast info head.raw --raw 256x256x128,uint16,1x1x1.5 --downsample 2");
}

} // namespace slabcast
