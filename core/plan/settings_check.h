#pragma once

#include <string>

#include "core/plan/frame_plan.h"
#include "core/plan/settings.h"

namespace slabcast {

/// Three significant digits, as reasons and refusals say it.
std::string shortNumber(double value);

/// What is wrong with settings by themselves. Fails: InvalidArgument (a number outside its range of
/// the table, settings that exclude each other), with what to do instead.
Result<void> check(const Settings& settings);

/// And for a scene. Fails: as check(), InvalidArgument (a skip structure other than what was
/// built).
Result<void> check(const Settings& settings, const SceneFacts& facts);

} // namespace slabcast
