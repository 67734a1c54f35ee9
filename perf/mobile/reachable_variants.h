#pragma once

#include <set>

#include "core/plan/shader_variant.h"

namespace slabcast {

/// What plan() answers, whatever facts and device, to settings that differ from the default in at
/// most so many choices; and the same variants counting work. Pure. Cost: 400 plans for each way
/// to choose, of which two choices have 300 and three 2300. `extremes`: of scenes and devices only
/// those that take no shortcut, or, dense with a proximity cloud, all. Tested by:
/// shader_variant_test.cpp
std::set<ShaderVariant> reachableVariants(int choices, bool extremes = false);

/// Every variant there is, reached or not: values of all axes that go together.
std::set<ShaderVariant> validVariants();

} // namespace slabcast
