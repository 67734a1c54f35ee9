#pragma once

#include "platform/cli/options.h"

namespace slabcast {

Result<void> renderCommand(const RenderOptions& options);
Result<void> sweepCommand(const SweepOptions& options);
Result<void> infoCommand(const InputOptions& options);
Result<void> deviceCommand();

} // namespace slabcast
