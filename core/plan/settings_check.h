#pragma once

#include <string>

#include "core/plan/frame_plan.h"
#include "core/plan/settings.h"

namespace slabcast {

/// Three significant digits, as reasons and refusals say it.
std::string shortNumber(double value);

/// Fails: InvalidArgument (a number outside its range, settings that exclude each other, a skip
/// structure other than what was built), with what to do instead.
Result<void> check(const Settings& settings, const SceneFacts& facts);

} // namespace slabcast
