#pragma once

#include <algorithm>
#include <array>
#include <set>
#include <vector>

#include "core/plan/shader_axes.h"
#include "perf/mobile/reachable_variants.h"

/// Which shader variants tests walk: those that plans reach, and pairs of axis values for the rest.
namespace slabcast::test {

/// Of so many that every text is looked at.
inline std::set<ShaderVariant> reachableVariants(int choices) {
    return slabcast::reachableVariants(choices, true);
}

/// Values of two axes, by their places.
struct AxisPair {
    std::array<std::size_t, 2> axes;
    std::array<std::size_t, 2> values;
    auto operator<=>(const AxisPair&) const = default;
};

inline std::vector<AxisPair> pairsOf(const ShaderVariant& variant) {
    std::vector<AxisPair> pairs;
    for (std::size_t a = 0; a < std::size(kAxes); ++a) {
        for (std::size_t b = a + 1; b < std::size(kAxes); ++b) {
            pairs.push_back({{a, b}, {kAxes[a].valueOf(variant), kAxes[b].valueOf(variant)}});
        }
    }
    return pairs;
}

/// A valid variant with these values, or one that is not valid where there is none.
inline ShaderVariant variantWith(const AxisPair& pair) {
    ShaderVariant variant;
    const auto isFree = [&](Axis axis) {
        const auto place = static_cast<std::size_t>(axis);
        return place != pair.axes[0] && place != pair.axes[1];
    };
    for (const int k : {0, 1}) {
        kAxes[pair.axes[k]].choose(variant, pair.values[k]);
    }
    for (const Requirement& one : kRequirements) {
        const bool asked = kAxes[static_cast<std::size_t>(one.axis)].valueOf(variant) == one.value;
        if (asked && isFree(one.other)) {
            kAxes[static_cast<std::size_t>(one.other)].choose(variant, *one.among.begin());
        }
    }
    return variant;
}

/// All pairs of values that go together.
inline std::set<AxisPair> allPairs() {
    std::set<AxisPair> pairs;
    for (std::size_t a = 0; a < std::size(kAxes); ++a) {
        for (std::size_t b = a + 1; b < std::size(kAxes); ++b) {
            for (std::size_t i = 0; i < kAxes[a].count * kAxes[b].count; ++i) {
                const AxisPair pair{{a, b}, {i / kAxes[b].count, i % kAxes[b].count}};
                if (variantWith(pair).valid()) {
                    pairs.insert(pair);
                }
            }
        }
    }
    return pairs;
}

/// Adds variants until every pair of `missing` occurs: of each axis the value that brings most.
inline void addPairs(std::set<ShaderVariant>& variants, std::set<AxisPair> missing) {
    const auto gain = [&](const ShaderVariant& variant) {
        const std::vector<AxisPair> pairs = pairsOf(variant);
        return std::count_if(pairs.begin(), pairs.end(),
                             [&](const AxisPair& pair) { return missing.count(pair) > 0; });
    };
    while (!missing.empty()) {
        const AxisPair first = *missing.begin();
        ShaderVariant best = variantWith(first);
        for (std::size_t axis = 0; axis < std::size(kAxes); ++axis) {
            for (std::size_t value = 0; value < kAxes[axis].count; ++value) {
                ShaderVariant other = best;
                kAxes[axis].choose(other, value);
                const bool keeps = axis != first.axes[0] && axis != first.axes[1];
                if (keeps && other.valid() && gain(other) > gain(best)) {
                    best = other;
                }
            }
        }
        variants.insert(best);
        for (const AxisPair& pair : pairsOf(best)) {
            missing.erase(pair);
        }
    }
}

/// The walk: what plans reach from settings that differ in one choice from the default, and pairs.
inline const std::vector<ShaderVariant>& walkedVariants() {
    static const std::vector<ShaderVariant> walked = [] {
        std::set<ShaderVariant> variants = reachableVariants(1);
        std::set<AxisPair> missing = allPairs();
        for (const ShaderVariant& variant : variants) {
            for (const AxisPair& pair : pairsOf(variant)) {
                missing.erase(pair);
            }
        }
        addPairs(variants, missing);
        return std::vector<ShaderVariant>(variants.begin(), variants.end());
    }();
    return walked;
}

} // namespace slabcast::test
