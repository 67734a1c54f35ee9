#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/skip/cell_visibility.h"
#include "core/volume/texels.h"

namespace slabcast {

inline constexpr int kMaxBins = 256;

/// The data's range of values cut into bins of even width in value, up to 256: what bitfields and
/// partitions tell apart. A bin holds consecutive codes, possibly none; all codes have a bin.
struct ValueBins {
    int count = 0;
    std::vector<std::uint8_t> binOfCode;
};

/// What of the codes occurs in a volume.
struct CodeRange {
    std::uint16_t least = 0;
    std::uint16_t most = 0;
};

CodeRange codeRange(const TexelCodes& codes); // O(voxels), all cores

/// Bins between the sampled values of `range`, or between `trimmed` sampled values; what lies
/// beyond falls into the bins at the ends. `separateMinimum`: bin 0 is the range's least code
/// alone. Source: Faludi et al. 2021, section 3.1; Rauter et al. 2024, section 3.1.
/// Tested by: value_bins_test.cpp
ValueBins valueBins(const TexelCodes& codes, CodeRange range, int count, bool separateMinimum,
                    std::optional<std::array<double, 2>> trimmedSampled = std::nullopt);

/// A set of bins: bit b % 32 of word b / 32.
using BinSet = std::array<std::uint32_t, kMaxBins / 32>;

/// The bins of which a cell with a visible value has one at least: a cell has every bin from that
/// of its least corner to that of its greatest. Between two bins lie values that no code stands
/// for: where only those are visible, the lower bin counts. Cost: O(codes).
BinSet visibleBins(const ValueBins& bins, const CellVisibility& visibility);

} // namespace slabcast
