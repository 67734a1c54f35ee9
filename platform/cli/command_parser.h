#pragma once

#include <optional>
#include <span>

#include "platform/cli/command.h"

namespace slabcast {

enum ExitStatus { kDone = 0, kFailed = 1, kBadUsage = 2 };

/// The command that the arguments name, with its words taken; or the status to leave with, after
/// the help, or one line on stderr with what was wrong and where to read on.
struct ParsedCommand {
    Command* command = nullptr;
    ExitStatus status = kDone;
};

ParsedCommand parseCommandLine(std::span<Command> commands, int argc, char** argv);

} // namespace slabcast
