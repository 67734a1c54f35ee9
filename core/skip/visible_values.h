#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/skip/cell_visibility.h"
#include "core/skip/value_bins.h"

namespace slabcast {

/// Which values a TF shows, as the smallest cells that it makes visible: those of one code, and
/// those of a code and the next. Any cell is visible iff one of these that lie between its least
/// and its greatest corner is.
struct VisibleValues {
    static constexpr std::uint8_t kAlone = 1;    // [c, c]
    static constexpr std::uint8_t kWithNext = 2; // [c, c + 1]

    std::vector<std::uint8_t> shown; // per code

    bool operator==(const VisibleValues&) const = default;
};

/// Cost: O(codes). Tested by: live_skip_test.cpp
VisibleValues visibleValues(const CellVisibility& visibility);
/// The same in place of others: nothing is allocated where those were of as many codes.
void findVisibleValues(const CellVisibility& visibility, VisibleValues& values);

/// Whether `all` shows every cell that `some` shows. Cost: O(codes).
bool covers(const VisibleValues& all, const VisibleValues& some);

/// Codes of which one at least lies between the least and the greatest corner of every cell that
/// only one of the two shows; nothing where they show the same. Cost: O(codes).
std::optional<CodeRange> changedCodes(const VisibleValues& a, const VisibleValues& b);

/// The bins of all such codes, gaps between them left out. Cost: O(codes).
BinSet changedBins(const ValueBins& bins, const VisibleValues& a, const VisibleValues& b);

} // namespace slabcast
