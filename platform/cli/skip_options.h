#pragma once

#include <string>
#include <vector>

#include "core/plan/settings_table.h"
#include "core/skip/built_skip.h"
#include "core/skip/live_skip.h"
#include "platform/cli/options.h"

namespace slabcast {

/// What --skip names serves once a TF has settled or, where it depends on none, always.
LiveOptions liveOptions(const SceneOptions& options);

/// Parameters that the structure has no use for are refused, as are block edges that it does not
/// offer.
void checkSkipping(Command& command, const SceneOptions& options);
/// --skip of the structures that can serve while a TF is edited, and the same of them. Their
/// parameters are bound already.
void bindLiveSkipping(Command& command, SceneOptions& options);

/// The settings that make a structure of this kind what it is.
std::vector<const Setting*> parametersOf(SkipStructure structure);

/// One line: what was built, where, how long it took and what of it is occupied.
std::string describe(const BuiltSkip& skip);

} // namespace slabcast
