#include <fmt/core.h>

#include "platform/cli/options.h"
#include "platform/cli/scene_options.h"
#include "platform/cli/skip_options.h"

namespace slabcast {

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
        ->default_str("1.5 times the median frame by what serves under any transfer function")
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
              "tenth of what the last one took to draw, or 0.1 ms where that is more")
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
              "frames by what serves under any transfer function, an octree if --skip does not say "
              "otherwise: each frame is compared with their median")
        ->type_name("N")
        ->default_str(fmt::format("{}", o.octreeFrames))
        ->group(edits);
    o.size = {512, 512};
    bindScene(command, o);
    bindLiveSkipping(command, o);
    bindLayersPerPlane(command, o.settings, "1 is slicing; more than there are is ray casting",
                       "the fastest of several, measured");
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

} // namespace slabcast
