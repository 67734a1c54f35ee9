#pragma once

#include <array>

#include "core/plan/shader_variant.h"

namespace slabcast {

/// How a plane's colour, premultiplied, joins what is there.
enum class PlaneBlend : std::uint8_t { Over, Under };

/// What follows for planes from how a ray's layers are combined: the same must be right between
/// planes.
struct AccumulateRule {
    PlaneBlend backToFront; // of planes in this order
    PlaneBlend frontToBack;
    bool terminates; // what is in front may make all behind it change nothing
};

/// By Accumulate.
inline constexpr std::array kAccumulateRules = {
    AccumulateRule{PlaneBlend::Over, PlaneBlend::Under, true}, // composite
};

constexpr const AccumulateRule& ruleOf(Accumulate accumulate) {
    return kAccumulateRules[static_cast<std::size_t>(accumulate)];
}

} // namespace slabcast
