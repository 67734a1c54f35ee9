#include "core/skip/cell_visibility.h"

#include <algorithm>
#include <cmath>

#include "core/transfer/table_axis.h"

namespace slabcast {

namespace {

constexpr std::uint16_t kNone = 65535;

/// The table texels that sampled values can reach, with grace on either side: one texel, or more
/// where float32 is coarser than the table. Widened before they are clamped: a value well outside
/// the table reads its end texel exactly and no neighbour, which keeps the air below a TF's first
/// point empty.
struct TableReach {
    TableAxis axis;

    std::uint16_t below(double sampled) const {
        return axis.hasSpan ? clamped(std::floor(axis.texelAt(sampled) - grace(sampled))) : 0;
    }
    std::uint16_t above(double sampled) const {
        return clamped(axis.hasSpan ? std::ceil(axis.texelAt(sampled) + grace(sampled))
                                    : axis.lastTexel);
    }

private:
    double grace(double sampled) const {
        // Three interpolations in the shader, each of two roundings, and those of its uniforms.
        const double rounding = 0x1p-21 * (std::abs(sampled) + std::abs(axis.firstSampled));
        return std::max(1.0, 2.0 * rounding * axis.texelsPerSampled);
    }
    std::uint16_t clamped(double texel) const {
        return std::uint16_t(std::clamp(texel, 0.0, double(axis.lastTexel)));
    }
};

/// Per texel: itself or the next one with alpha, kNone where none follows.
void findNextWithAlpha(const TransferTable& table, std::vector<std::uint16_t>& next) {
    next.reserve(table.texels.capacity());
    next.resize(table.texels.size());
    std::uint16_t nearest = kNone;
    for (std::size_t i = next.size(); i-- > 0;) {
        nearest = table.texels[i].a > 0.0F ? std::uint16_t(i) : nearest;
        next[i] = nearest;
    }
}

/// of(0), of(1), ... of a function that rises with its argument, which is asked only where it may
/// change: most codes of halves lie between two texels of a table, and an edited TF's frame waits.
template <class Of>
void fillRising(std::vector<std::uint16_t>& values, std::size_t count, Of of) {
    values.resize(count);
    const auto fillBetween = [&](auto& self, std::size_t first, std::size_t last) -> void {
        if (values[first] == values[last]) {
            std::fill(values.begin() + std::ptrdiff_t(first), values.begin() + std::ptrdiff_t(last),
                      values[first]);
        } else if (last - first > 1) {
            const std::size_t middle = (first + last) / 2;
            values[middle] = of(middle);
            self(self, first, middle);
            self(self, middle, last);
        }
    };
    values.front() = of(0);
    values.back() = of(count - 1);
    fillBetween(fillBetween, 0, count - 1);
}

} // namespace

void findVisibility(const TexelCodes& codes, const Texels& texels, const TransferTable& table,
                    double filterErrorSampled, CellVisibility& into) {
    SLABCAST_EXPECTS(!table.texels.empty() && table.texels.size() <= kNone, table.texels.size());
    SLABCAST_EXPECTS(codes.lowSampled.size() == codes.highSampled.size(), codes.lowSampled.size());
    SLABCAST_EXPECTS(filterErrorSampled >= 0.0, filterErrorSampled);
    const TableReach reach{tableAxis(texels, table)};
    findNextWithAlpha(table, into.nextWithAlpha);
    const auto firstVisible = [&](std::size_t code) {
        return into.nextWithAlpha[reach.below(double(codes.lowSampled[code]) - filterErrorSampled)];
    };
    const auto last = [&](std::size_t code) {
        return reach.above(double(codes.highSampled[code]) + filterErrorSampled);
    };
    const std::size_t count = codes.lowSampled.size();
    into.texels = &codes;
    fillRising(into.firstVisible, count, firstVisible);
    fillRising(into.reach, count, last);
}

CellVisibility cellVisibility(const TexelCodes& codes, const Texels& texels,
                              const TransferTable& table, double filterErrorSampled) {
    CellVisibility visibility;
    findVisibility(codes, texels, table, filterErrorSampled, visibility);
    return visibility;
}

CellVisibility cellVisibilityOfAlpha(const TexelCodes& alphaCodes) {
    // Alpha is its own table here: every entry but zero is visible, and a cell reaches its largest
    // corner.
    CellVisibility visibility{
        &alphaCodes, std::vector<std::uint16_t>(256), std::vector<std::uint16_t>(256), {}};
    for (std::uint16_t alpha = 0; alpha < 256; ++alpha) {
        visibility.firstVisible[alpha] = std::max<std::uint16_t>(alpha, 1);
        visibility.reach[alpha] = alpha;
    }
    return visibility;
}

} // namespace slabcast
