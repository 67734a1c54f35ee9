#pragma once

#include <string>

#include "perf/error/error_table.h"
#include "platform/cli/options.h"

namespace slabcast {

/// One word of a POSIX shell: quoted where it holds anything but plain characters.
std::string shellWord(const std::string& word);

/// The `slabcast render` command that draws this scene with this sampling and the plan that came of
/// it, into `output`.
std::string renderCommandLine(const SceneOptions& scene, const Sampling& sampling,
                              const FramePlan& plan, const std::string& output);

} // namespace slabcast
