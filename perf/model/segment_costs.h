#pragma once

#include <optional>
#include <string_view>

#include "core/plan/shader_variant.h"
#include "perf/model/frame_model.h"

namespace slabcast {

/// A segment shader in parts, as a GPU's compiler has it: from the whole of it with other lengths,
/// and without skipping. By segment_costs.inc, which costs.py makes. Nothing where it, or what it
/// is compared with, is not in there. Tested by: segment_costs_test.cpp
std::optional<SegmentCosts> segmentCosts(std::string_view gpu, const ShaderVariant& variant);

/// Layers that are evaluated in a row after one look.
int layersPerGroup(const ShaderVariant& variant);

} // namespace slabcast
