#include "core/skip/visible_values.h"

#include <algorithm>

namespace slabcast {

// Let the cell of codes [a, b] be visible: t, the first visible table texel that a can reach or
// that lies above, is within reach of b. Let k be the least code from a on that reaches t. Where
// k = a, [a, a] is visible. Else k - 1 does not reach t, so t is the first visible texel for it
// too, and [k - 1, k] is visible. Conversely a cell is visible if one between its corners is:
// firstVisible and reach rise with the code.
//
// Hence where two TFs show a cell differently they differ in one of these within it, whose lower
// code lies between the cell's corners.
void findVisibleValues(const CellVisibility& visibility, VisibleValues& values) {
    const std::size_t codes = visibility.reach.size();
    values.shown.resize(codes);
    for (std::size_t c = 0; c < codes; ++c) {
        const bool alone = visibility.firstVisible[c] <= visibility.reach[c];
        const bool withNext =
            c + 1 < codes && visibility.firstVisible[c] <= visibility.reach[c + 1];
        values.shown[c] = std::uint8_t(alone * VisibleValues::kAlone) |
                          std::uint8_t(withNext * VisibleValues::kWithNext);
    }
}

VisibleValues visibleValues(const CellVisibility& visibility) {
    VisibleValues values;
    findVisibleValues(visibility, values);
    return values;
}

bool covers(const VisibleValues& all, const VisibleValues& some) {
    SLABCAST_EXPECTS(all.shown.size() == some.shown.size(), all.shown.size());
    return std::equal(all.shown.begin(), all.shown.end(), some.shown.begin(),
                      [](std::uint8_t a, std::uint8_t s) { return (s & ~a) == 0; });
}

std::optional<CodeRange> changedCodes(const VisibleValues& a, const VisibleValues& b) {
    SLABCAST_EXPECTS(a.shown.size() == b.shown.size(), a.shown.size());
    const auto first = std::mismatch(a.shown.begin(), a.shown.end(), b.shown.begin()).first;
    if (first == a.shown.end()) {
        return std::nullopt;
    }
    const auto last = std::mismatch(a.shown.rbegin(), a.shown.rend(), b.shown.rbegin()).first;
    return CodeRange{std::uint16_t(first - a.shown.begin()),
                     std::uint16_t(a.shown.rend() - last - 1)};
}

BinSet changedBins(const ValueBins& bins, const VisibleValues& a, const VisibleValues& b) {
    SLABCAST_EXPECTS(a.shown.size() == b.shown.size(), a.shown.size());
    SLABCAST_EXPECTS(a.shown.size() == bins.binOfCode.size(), bins.binOfCode.size());
    BinSet set{};
    for (std::size_t c = 0; c < a.shown.size(); ++c) {
        const std::uint8_t bin = bins.binOfCode[c];
        set[bin / 32] |= std::uint32_t(a.shown[c] != b.shown[c]) << (bin % 32);
    }
    return set;
}

} // namespace slabcast
