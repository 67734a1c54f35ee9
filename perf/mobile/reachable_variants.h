#pragma once

#include <set>

#include "core/plan/shader_variant.h"

namespace slabcast {

/// What plan() answers, whatever facts and device, to settings of which at most `choices`, 1 or 2,
/// differ from the default; and the same variants counting work. Pure. Cost: of two choices some
/// ten thousand plans. Tested by: shader_variant_test.cpp
std::set<ShaderVariant> reachableVariants(int choices);

} // namespace slabcast
