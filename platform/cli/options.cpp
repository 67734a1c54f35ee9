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

constexpr glm::ivec2 kQuickSize(160);      // of `error`
constexpr glm::ivec2 kQuickBenchSize(128); // of `skipbench`
constexpr int kQuickFrames = 5;
const std::vector<int> kBenchSizes{64, 128, 256, 512};
const std::vector<int> kQuickBenchSizes{64, 128, 256};

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

void bindSkipbench(CLI::App& command, SkipbenchOptions& o) {
    const auto group = "Output";
    command
        .add_option("VOLUME", o.volumes,
                    "one or several, as other commands take one: files, folders or "
                    "phantom:NAME[:SIZE]; phantom:gap has its bulk where its preset shows nothing")
        ->required();
    command
        .add_option("--out", o.outputFolder,
                    "folder for skipbench.json, skipbench.csv and report.html; made where missing")
        ->required()
        ->type_name("FOLDER")
        ->group(group);
    command
        .add_flag("--quick", o.quick,
                  fmt::format("{}x{} pixels, {} frames, fewer parameters and sizes",
                              kQuickBenchSize.x, kQuickBenchSize.y, kQuickFrames))
        ->group(group);
    addNumber(command, "--frames", o.frames, kFewestFrames, 10000,
              "timed frames per row, fewer of slow ones")
        ->type_name("N")
        ->default_str(fmt::format("{}", o.frames))
        ->group(group);
    const auto varied = "What is varied";
    addList<int>(command, "--sizes", o.sizes, numberParser<int>(1, 1024),
                 "whole numbers from 1 to 1024",
                 "edges of the cubes that the first volume is resampled to")
        ->type_name("N,...")
        ->default_str(fmt::format("{}", fmt::join(kBenchSizes, ",")))
        ->group(varied);
    addParsed<std::int64_t>(
        command, "--partition-budget", o.skip.memoryBudgetBytes,
        [](const std::string& word) {
            const std::optional<double> mib = numberParser<double>(0.001, 1e6)(word);
            return mib ? std::optional(static_cast<std::int64_t>(*mib * 1048576.0)) : std::nullopt;
        },
        "a number from 0.001 to 1000000",
        "partitioned maps that take more memory are refused, and named")
        ->type_name("MIB")
        ->default_str(fmt::format("{}", o.skip.memoryBudgetBytes >> 20))
        ->group(varied);
    o.size = {256, 256};
    bindCamera(command, o);
    bindLook(command, o);
    command.final_callback([&command, &o] {
        if (o.quick && command.count("--size") == 0) {
            o.size = kQuickBenchSize;
        }
        if (o.quick && command.count("--frames") == 0) {
            o.frames = kQuickFrames;
        }
        if (command.count("--sizes") == 0) {
            o.sizes = o.quick ? kQuickBenchSizes : kBenchSizes;
        }
    });
    command.footer("Example: which way to skip suits this device; look at bench/report.html\n"
                   "  slabcast skipbench skull.nrrd phantom:gap --quick --out bench");
}

void bindEdit(CLI::App& command, EditOptions& o) {
    const auto output = "Output";
    command
        .add_option("--out", o.outputFolder,
                    "folder for edit.json, edit.csv and report.html; made where it is missing")
        ->required()
        ->type_name("FOLDER")
        ->group(output);
    command
        .add_flag("--verify", o.verify,
                  "compare every frame, bit for bit, with one drawn from scratch without skipping")
        ->group(output);
    addNumber(command, "--budget", o.budgetMs, 0.001, 1e6, "what a frame may take: a line to hold")
        ->type_name("MS")
        ->default_str("1.5 times the median frame of an octree that is there already")
        ->group(output);
    const auto edits = "Edits";
    CLI::Option* script =
        command.add_option("--script", o.scriptFile, "what is edited when, as below")
            ->type_name("FILE")
            ->group(edits);
    addParsed<std::optional<std::array<std::string, 2>>>(
        command, "--interpolate", o.interpolate,
        [](const std::string& word) -> std::optional<std::optional<std::array<std::string, 2>>> {
            const auto names = split(word, ',');
            if (names.size() != 2 || names[0].empty() || names[1].empty()) {
                return std::nullopt;
            }
            return std::array{std::string(names[0]), std::string(names[1])};
        },
        "two presets or files with a comma between",
        "from the first to the second of two presets or files and back, by a sine in time")
        ->type_name("TF_A,TF_B")
        ->group(edits)
        ->excludes(script);
    addNumber(command, "--frames", o.frames, 20, 100000, "frames, where no script says how many")
        ->type_name("N")
        ->default_str(fmt::format("{}", o.frames))
        ->group(edits)
        ->excludes(script);
    addNumber(command, "--turn", o.turnDegrees, -36000.0, 36000.0,
              "turn the volume by so many degrees from first to last")
        ->type_name("DEG")
        ->default_str("0")
        ->group(edits);
    addNumber(command, "--work", o.workBudgetMs, 0.0, 1e6,
              "what a frame may spend on rebuilding the structure that --skip names, at most a "
              "quarter of what the last one took to draw")
        ->type_name("MS")
        ->default_str(fmt::format("{:g}", o.workBudgetMs))
        ->group(edits);
    addNumber(command, "--quiet", o.quietFrames, 0, 100000,
              "frames without an edit before that begins")
        ->type_name("N")
        ->default_str(fmt::format("{}", o.quietFrames))
        ->group(edits);
    addNumber(command, "--replays", o.replays, 1, 1000,
              "replay all of it so many times: each frame's times are medians, which leaves out "
              "what other programs on the machine take")
        ->type_name("N")
        ->default_str(fmt::format("{}", o.replays))
        ->group(edits);
    addNumber(command, "--octree-frames", o.octreeFrames, 1, 1000,
              "frames of the octree, the median of which each frame is compared with")
        ->type_name("N")
        ->default_str(fmt::format("{}", o.octreeFrames))
        ->group(edits);
    o.size = {512, 512};
    bindScene(command, o);
    addNumber(command, "--layers-per-plane", o.settings.layersPerPlane, 1, kMaxLayers,
              "1 is slicing; more than there are is ray casting")
        ->type_name("N")
        ->default_str("the fastest of several, measured")
        ->group(kLayersGroup);
    command.footer(
        R"(A script is {"start": TF, "steps": [STEP, ...]}, where a TF is a preset's name, a file, or what
such a file holds. Every step begins with the TF that the one before it left:
  {"kind": "pause", "frames": 20}
  {"kind": "interpolate", "to": TF, "frames": 60, "periods": 1}  there and back, or 0.5: there
  {"kind": "opacity", "point": 2, "to": 0.05, "frames": 30}      a point's, dragged
  {"kind": "jump", "to": TF, "frames": 15}                       at once, then nothing
  {"kind": "random", "frames": 40, "every": 1, "seed": 7}        bands of values
Example: does any frame of an edit take long; look at edit/report.html
  slabcast edit skull.nrrd --interpolate ct-bone,ct-lung --verify --out edit)");
}

void bindInfo(CLI::App& command, InputOptions& o) {
    bindInput(command, o);
    command.footer("Example: half the resolution of voxels without a header\n"
                   "  slabcast info head.raw --raw 256x256x128,uint16,1x1x1.5 --downsample 2");
}

} // namespace slabcast
