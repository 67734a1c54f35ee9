#pragma once

#include "platform/cli/options.h"

namespace slabcast {

Result<void> renderCommand(const RenderOptions& options);
/// `command`: as it was typed, for the report.
Result<void> sweepCommand(const SweepOptions& options, const std::string& command);
Result<void> stabilityCommand(const StabilityOptions& options, const std::string& command);
Result<void> errorCommand(const ErrorOptions& options, const std::string& command);
Result<void> skipbenchCommand(const SkipbenchOptions& options, const std::string& command);
Result<void> modelCommand(const ModelOptions& options, const std::string& command);
Result<void> editCommand(const EditOptions& options, const std::string& command);
Result<void> infoCommand(const InputOptions& options);
Result<void> deviceCommand(const SessionOptions& options);

} // namespace slabcast
