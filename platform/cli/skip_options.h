#pragma once

#include <span>
#include <string>

#include "core/skip/built_skip.h"
#include "platform/cli/options.h"

namespace slabcast {

/// What can be chosen of a skip structure: the option, whose it is, and its value as the option
/// takes it; empty where there is none.
struct SkipParameter {
    const char* flag;
    bool (*isOf)(SkipStructure structure);
    std::string (*word)(const SkipOptions& options);
};

std::span<const SkipParameter> skipParameters();

/// What --skip names serves once a TF has settled or, where it depends on none, always.
LiveOptions liveOptions(const SceneOptions& options);

/// --skip, the parameters of all structures and where they are built. Parameters that the structure
/// has no use for are refused, as are block edges that it does not offer.
void bindSkipping(CLI::App& command, SceneOptions& options);
/// The same of the structures that can serve while a TF is edited, which the CPU builds.
void bindLiveSkipping(CLI::App& command, SceneOptions& options);

/// One line: what was built, where, how long it took and what of it is occupied.
std::string describe(const BuiltSkip& skip);

} // namespace slabcast
