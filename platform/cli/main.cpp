#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <iostream>
#include <new>
#include <string>
#include <system_error>

#include <fmt/core.h>

#include "platform/cli/command_line.h"
#include "platform/cli/command_parser.h"
#include "platform/cli/commands.h"
#include "platform/cli/interrupt.h"

namespace {

using namespace slabcast;

/// What no option's check can tell beforehand, as a form that some volume's layers do not fit, is
/// bad usage all the same.
int finished(const Result<void>& result) {
    if (result) {
        return kDone;
    }
    fmt::print(stderr, "slabcast: {}\n", result.error().detail);
    return result.error().code == ErrorCode::InvalidArgument ? kBadUsage : kFailed;
}

int unwritten(int error) {
    return finished(fail(ErrorCode::FileUnwritable,
                         fmt::format("standard output cannot be written ({}): send it elsewhere, "
                                     "or make room",
                                     std::strerror(error != 0 ? error : EIO))));
}

std::string commandLine(int argc, char** argv) {
    std::string line = "slabcast";
    for (int k = 1; k < argc; ++k) {
        line += " " + shellWord(argv[k]);
    }
    return line;
}

int run(int argc, char** argv) {
    RenderOptions render;
    SweepOptions sweep;
    StabilityOptions stability;
    ErrorOptions error;
    SkipbenchOptions skipbench;
    EditOptions edit;
    ModelOptions model;
    InputOptions info;
    SessionOptions device;
    const std::string typed = commandLine(argc, argv);
    Command commands[] = {
        {.name = "render", .help = "Draws a picture", .run = [&] { return renderCommand(render); }},
        {.name = "sweep",
         .help = "Measures the planes to layers ratio, with and without skipping",
         .run = [&] { return sweepCommand(sweep, typed); }},
        {.name = "stability",
         .help = "Puts the renderer through stiff and extreme cases",
         .run = [&] { return stabilityCommand(stability, typed); }},
        {.name = "error",
         .help = "Measures the error of pictures against the time that they take",
         .run = [&] { return errorCommand(error, typed); }},
        {.name = "skipbench",
         .help = "Compares the ways of skipping empty space",
         .run = [&] { return skipbenchCommand(skipbench, typed); }},
        {.name = "edit",
         .help = "Replays edits of the transfer function and times every frame",
         .run = [&] { return editCommand(edit, typed); }},
        {.name = "model",
         .help = "Predicts frame times of headsets that are not at hand, by a model",
         .run = [&] { return modelCommand(model, typed); }},
        {.name = "info",
         .help = "Tells what a volume is and what drawing it takes",
         .run = [&] { return infoCommand(info); }},
        {.name = "device",
         .help = "Tells what the GPU can do, which texel formats were chosen and why",
         .footer = "Example: what a headset without float extensions would get\n"
                   "  SLABCAST_MASK_EXTENSIONS=mobile-strict slabcast device",
         .run = [&] { return deviceCommand(device); }},
    };
    bindRender(commands[0], render);
    bindSweep(commands[1], sweep);
    bindStability(commands[2], stability);
    bindError(commands[3], error);
    bindSkipbench(commands[4], skipbench);
    bindEdit(commands[5], edit);
    bindModel(commands[6], model);
    bindInfo(commands[7], info);
    bindDevice(commands[8], device);
    const ParsedCommand parsed = parseCommandLine(commands, argc, argv);
    return parsed.command == nullptr ? parsed.status : finished(parsed.command->run());
}

/// What is still held back is written now, or never: a full disk is no success.
int withWrittenOutput(int status) {
    errno = 0;
    const bool written = std::cout.flush() && std::fflush(stdout) == 0 && std::ferror(stdout) == 0;
    return written || status != kDone ? status : unwritten(errno);
}

} // namespace

int main(int argc, char** argv) try {
    endWhenInterrupted();
    // EGL's loader else reports on stderr, over several lines, what our own error says in one.
    setenv("EGL_LOG_LEVEL", "fatal", 0);
    return withWrittenOutput(run(argc, argv));
} catch (const std::system_error& error) { // of what prints to stdout
    return unwritten(error.code().value());
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
