#include <cstdlib>
#include <exception>
#include <functional>
#include <new>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "platform/cli/command_line.h"
#include "platform/cli/commands.h"
#include "platform/cli/help_formatter.h"

namespace {

using namespace slabcast;

enum ExitStatus { kDone = 0, kFailed = 1, kBadUsage = 2 };

int finished(const Result<void>& result) {
    if (result) {
        return kDone;
    }
    fmt::print(stderr, "slabcast: {}\n", result.error().detail);
    return kFailed;
}

std::string commandLine(int argc, char** argv) {
    std::string line = "slabcast";
    for (int k = 1; k < argc; ++k) {
        line += " " + shellWord(argv[k]);
    }
    return line;
}

int run(int argc, char** argv) {
    CLI::App app("Slabcast draws volumes (CT, MR, simulation) on GLES 3.2 class GPUs.", "slabcast");
    app.formatter(std::make_shared<HelpFormatter>());
    app.failure_message(usageMessage);
    app.require_subcommand(0, 1); // none is answered below, with the help
    app.set_help_all_flag("--help-all", "help of all commands");
    app.footer(
        "Start with: slabcast render phantom:marschner-lobb -o picture.png\n"
        "Exit status: 0 done; 1 failed, with one line that says why and what to do; 2 bad usage");

    std::vector<std::pair<CLI::App*, std::function<Result<void>()>>> commands;
    const auto add = [&](const char* name, const char* help, std::function<Result<void>()> action) {
        commands.emplace_back(app.add_subcommand(name, help), std::move(action));
        return commands.back().first;
    };
    RenderOptions render;
    bindRender(*add("render", "Draws a picture", [&] { return renderCommand(render); }), render);
    SweepOptions sweep;
    bindSweep(*add("sweep", "Measures the planes to layers ratio, with and without skipping",
                   [&] { return sweepCommand(sweep, commandLine(argc, argv)); }),
              sweep);
    StabilityOptions stability;
    bindStability(*add("stability", "Puts the renderer through stiff and extreme cases",
                       [&] { return stabilityCommand(stability, commandLine(argc, argv)); }),
                  stability);
    ErrorOptions error;
    bindError(*add("error", "Measures the error of pictures against the time that they take",
                   [&] { return errorCommand(error, commandLine(argc, argv)); }),
              error);
    SkipbenchOptions skipbench;
    bindSkipbench(*add("skipbench", "Compares the ways of skipping empty space",
                       [&] { return skipbenchCommand(skipbench, commandLine(argc, argv)); }),
                  skipbench);
    EditOptions edit;
    bindEdit(*add("edit", "Replays edits of the transfer function and times every frame",
                  [&] { return editCommand(edit, commandLine(argc, argv)); }),
             edit);
    InputOptions info;
    bindInfo(*add("info", "Tells what a volume is and what drawing it takes",
                  [&] { return infoCommand(info); }),
             info);
    add("device", "Tells what the GPU can do, which texel formats were chosen and why",
        deviceCommand)
        ->footer("Example: what a headset without float extensions would get\n"
                 "  SLABCAST_MASK_EXTENSIONS=mobile-strict slabcast device");

    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& misuse) {
        return app.exit(misuse) == 0 ? kDone : kBadUsage;
    }
    for (const auto& [command, action] : commands) {
        if (command->parsed()) {
            return finished(action());
        }
    }
    fmt::print(stderr, "{}\n", app.help());
    return kBadUsage;
}

} // namespace

int main(int argc, char** argv) try {
    // EGL's loader else reports on stderr, over several lines, what our own error says in one.
    setenv("EGL_LOG_LEVEL", "fatal", 0);
    return run(argc, argv);
} catch (const std::bad_alloc&) {
    return finished(
        fail(ErrorCode::Internal,
             "out of memory: take a smaller --size, or a smaller volume with --downsample"));
} catch (const std::exception& defect) {
    const std::string what = defect.what();
    return finished(fail(ErrorCode::Internal, "a defect of this program (" +
                                                  what.substr(0, what.find('\n')) +
                                                  "): report it with the command that led here"));
}
