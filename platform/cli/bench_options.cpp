#include <fmt/core.h>
#include <fmt/ranges.h>

#include "perf/frame_times.h"
#include "platform/cli/options.h"
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
void takeUnlessGiven(const CLI::App& command, const char* flag, T& value, const T& taken) {
    if (command.count(flag) == 0) {
        value = taken;
    }
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

} // namespace

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
        if (o.quick) {
            takeUnlessGiven(command, "--size", o.size, kQuickSize);
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
    bindSkipping(command, o);
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
        if (o.quick) {
            takeUnlessGiven(command, "--size", o.size, kQuickBenchSize);
            takeUnlessGiven(command, "--frames", o.frames, kQuickFrames);
        }
        takeUnlessGiven(command, "--sizes", o.sizes, o.quick ? kQuickBenchSizes : kBenchSizes);
    });
    command.footer("Example: which way to skip suits this device; look at bench/report.html\n"
                   "  slabcast skipbench skull.nrrd phantom:gap --quick --out bench");
}

} // namespace slabcast
