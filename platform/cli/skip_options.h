#pragma once

#include <span>

#include <nlohmann/json.hpp>

#include "core/skip/built_skip.h"
#include "platform/cli/options.h"

namespace slabcast {

/// What can be chosen of a skip structure: the option, its key in reports, whose it is.
struct SkipParameter {
    const char* flag;
    const char* key;
    bool (*isOf)(SkipStructure structure);
    nlohmann::json (*value)(const SkipOptions& options);
};

std::span<const SkipParameter> skipParameters();

std::string wordOf(const nlohmann::json& value); // as options take it

/// What --skip names serves once a TF has settled or, where it depends on none, always.
LiveOptions liveOptions(const SceneOptions& options);

/// --skip, the parameters of all structures and where they are built. Parameters that the structure
/// has no use for are refused, as are block edges that it does not offer.
void bindSkipping(CLI::App& command, SceneOptions& options);
/// The same of the structures that can serve while a TF is edited, which the CPU builds.
void bindLiveSkipping(CLI::App& command, SceneOptions& options);

/// One line: what was built, where, how long it took and what of it is occupied.
std::string describe(const BuiltSkip& skip);
/// null where nothing was built. Keys are stable: people plot them.
nlohmann::json toJson(const BuiltSkip& skip);

} // namespace slabcast
