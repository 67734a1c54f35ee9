#include <fmt/core.h>

#include "platform/cli/scene_options.h"
#include "platform/cli/skip_options.h"

namespace slabcast {

namespace {

using TwoNames = std::array<std::string, 2>;

std::optional<std::optional<TwoNames>> parseTwo(const std::string& word) {
    const auto names = split(word, ',');
    if (names.size() != 2 || names[0].empty() || names[1].empty()) {
        return std::nullopt;
    }
    return TwoNames{std::string(names[0]), std::string(names[1])};
}

void bindEdits(Command& command, EditOptions& o) {
    const auto group = "Edits";
    addText(command,
            {.flag = "--script",
             .help = "what is edited when, as below",
             .word = "FILE",
             .group = group,
             .hides = {"--tf", "--interpolate", "--frames"}},
            o.scriptFile);
    addParsed(command,
              {.flag = "--interpolate",
               .help = "from the first to the second of two presets or files and back, by a sine "
                       "in time",
               .word = "TF_A,TF_B",
               .group = group,
               .hides = {"--tf"}},
              o.interpolate, parseTwo, "two presets or files with a comma between");
    addNumber(command,
              {.flag = "--frames",
               .help = "frames, where no script says how many",
               .word = "N",
               .usually = fmt::format("{}", o.frames),
               .group = group},
              o.frames, 20, 100000);
    addNumber(command,
              {.flag = "--turn",
               .help = "turn the volume by so many degrees from first to last",
               .word = "DEG",
               .usually = "0",
               .group = group},
              o.turnDegrees, -36000.0, 36000.0);
    addNumber(command,
              {.flag = "--replays",
               .help = "replay all of it so many times: each frame's times are medians, which "
                       "leaves out what other programs on the machine take",
               .word = "N",
               .usually = fmt::format("{}", o.replays),
               .group = group},
              o.replays, 1, 1000);
    addNumber(command,
              {.flag = "--octree-frames",
               .help = "frames by what serves under any transfer function, an octree if --skip "
                       "does not say otherwise: each frame is compared with their median",
               .word = "N",
               .usually = fmt::format("{}", o.octreeFrames),
               .group = group},
              o.octreeFrames, 1, 1000);
}

/// How the structure that --skip names is rebuilt, where a transfer function changes it.
void bindRebuilding(Command& command, EditOptions& o) {
    const auto group = "Edits";
    addNumber(command,
              {.flag = "--work",
               .help = "what a frame may spend on rebuilding the structure that --skip names, at "
                       "most a tenth of what the last one took to draw, or 0.1 ms where that is "
                       "more",
               .word = "MS",
               .usually = fmt::format("{:g}", o.workBudgetMs),
               .group = group},
              o.workBudgetMs, 0.0, 1e6);
    addNumber(command,
              {.flag = "--quiet",
               .help = "frames without an edit before that begins",
               .word = "N",
               .usually = fmt::format("{}", o.quietFrames),
               .group = group},
              o.quietFrames, 0, 100000);
    command.checks.emplace_back([&o](const Given& given) -> Result<void> {
        const bool rebuilds = liveOptions(o).settled.structure != SkipStructure::None;
        for (const char* flag : {"--work", "--quiet"}) {
            if (given(flag) && !rebuilds) {
                return fail(ErrorCode::InvalidArgument,
                            fmt::format("{}: does nothing beside --skip {}, which no edit "
                                        "rebuilds: leave one out",
                                        flag, name(*o.settings.skip)));
            }
        }
        return {};
    });
}

} // namespace

void bindEdit(Command& command, EditOptions& o) {
    const auto output = "Output";
    bindReportFolder(command, o.folder,
                     "edit.json, edit.csv, report.html and figures; made where it is missing");
    addFlag(command,
            {.flag = "--verify",
             .help = "compare every frame, bit for bit, with one drawn from scratch without "
                     "skipping",
             .group = output},
            o.verify);
    addNumber(
        command,
        {.flag = "--budget",
         .help = "what a frame may take: a line to hold",
         .word = "MS",
         .usually =
             "1.5 times the frame by what serves under any transfer function, each by its own",
         .group = output},
        o.budgetMs, 0.001, 1e6);
    bindEdits(command, o);
    bindRebuilding(command, o);
    o.size = {512, 512};
    bindScene(command, o);
    // The CPU rebuilds while a function is edited, and bins are laid once: no builder is chosen.
    bindSettingsBut(command, o.settings, {"layers", "planes", "skip", "skip-builder"});
    bindLiveSkipping(command, o);
    command.footer =
        R"(A script is {"start": TF, "steps": [STEP, ...]}, where a TF is a preset's name, a file, or what
such a file holds. Every step begins with the TF that the one before it left:
  {"kind": "pause", "frames": 20}
  {"kind": "interpolate", "to": TF, "frames": 60, "periods": 1}  there and back, or 0.5: there
  {"kind": "opacity", "point": 2, "to": 0.05, "frames": 30}      a point's, dragged
  {"kind": "jump", "to": TF, "frames": 15}                       at once, then nothing
  {"kind": "random", "frames": 40, "every": 1, "seed": 7}        bands of values
Example: does any frame of an edit take long; look at edit/report.html
  slabcast edit skull.nrrd --interpolate ct-bone,ct-lung --verify --out edit)";
}

} // namespace slabcast
