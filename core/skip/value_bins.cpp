#include "core/skip/value_bins.h"

#include <algorithm>
#include <cmath>
#include <mutex>

#include "core/base/parallel.h"

namespace slabcast {

CodeRange codeRange(const TexelCodes& codes) {
    constexpr std::int64_t kGrain = 1 << 18;
    SLABCAST_EXPECTS(codes.count() > 0, codes.count());
    return codes.visit([&](const auto* code) {
        std::mutex mutex;
        CodeRange range{*code, *code};
        parallelFor(codes.count(), kGrain, [&](std::int64_t begin, std::int64_t end) {
            auto least = code[begin];
            auto most = code[begin];
            for (std::int64_t i = begin; i < end; ++i) {
                least = std::min(least, code[i]);
                most = std::max(most, code[i]);
            }
            const std::lock_guard lock(mutex);
            range.least = std::min(range.least, std::uint16_t(least));
            range.most = std::max(range.most, std::uint16_t(most));
        });
        return range;
    });
}

ValueBins valueBins(const TexelCodes& codes, CodeRange range, int count, bool separateMinimum,
                    std::optional<std::array<double, 2>> trimmedSampled) {
    SLABCAST_EXPECTS(count >= 2 && count <= kMaxBins, count);
    SLABCAST_EXPECTS(range.least <= range.most, range.least);
    SLABCAST_EXPECTS(range.most < codes.lowSampled.size(), range.most);
    const auto sampled = [&](std::size_t code) { return double(codes.lowSampled[code]); };
    const int first = separateMinimum ? 1 : 0; // of the even bins
    const int even = count - first;
    const std::size_t least = std::min(std::size_t(range.least) + first, std::size_t(range.most));
    const auto [low, high] =
        trimmedSampled.value_or(std::array{sampled(least), sampled(range.most)});
    const auto evenBin = [&, low = low, high = high](std::size_t code) {
        const double position = high > low ? (sampled(code) - low) / (high - low) * even : 0.0;
        return first + int(std::clamp(position, 0.0, double(even - 1)));
    };
    ValueBins bins{count, std::vector<std::uint8_t>(codes.lowSampled.size())};
    for (std::size_t code = 0; code < bins.binOfCode.size(); ++code) {
        const bool isMinimum = separateMinimum && code <= range.least;
        bins.binOfCode[code] = std::uint8_t(isMinimum ? 0 : evenBin(code));
    }
    return bins;
}

// From the last bin down, a bin of the codes [first, last] is in the set if values between two of
// its codes are visible, or if some between its last code and the next bin's first are and the next
// bin is not in the set.
//
// That suffices. Let the cell of codes [a, b] be visible: t, the first visible table texel that a
// can reach or that lies above, is within reach of b. Let k be the least code from a on that
// reaches t. Where k = a, [a, a] is visible, and so is a's bin. Else k - 1 does not reach t, but t
// is also the first visible one for it: [k - 1, k] is visible. If both are of one bin, that bin is
// in the set; if not, one of their two bins is. Every one of these lies between those of a and b.
//
// Nothing less does. By the first rule a bin alone has [first, last]; by the second the cell from
// its last code to the next has no other bin of the set.
BinSet visibleBins(const ValueBins& bins, const CellVisibility& visibility) {
    const std::vector<std::uint8_t>& binOf = bins.binOfCode;
    SLABCAST_EXPECTS(binOf.size() == visibility.reach.size(), binOf.size());
    const auto visible = [&](std::size_t least, std::size_t greatest) {
        return visibility.visible(std::uint16_t(least), std::uint16_t(greatest));
    };
    BinSet set{};
    bool nextInSet = true; // beyond the last bin there is nothing to account for
    for (std::size_t end = binOf.size(); end > 0;) {
        const std::size_t last = end - 1;
        std::size_t first = last;
        while (first > 0 && binOf[first - 1] == binOf[last]) {
            --first;
        }
        nextInSet = visible(first, last) || (!nextInSet && visible(last, end));
        set[binOf[last] / 32] |= std::uint32_t(nextInSet) << (binOf[last] % 32);
        end = first;
    }
    return set;
}

} // namespace slabcast
