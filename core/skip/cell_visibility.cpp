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
std::vector<std::uint16_t> nextWithAlpha(const TransferTable& table) {
    std::vector<std::uint16_t> next(table.texels.size());
    std::uint16_t nearest = kNone;
    for (std::size_t i = next.size(); i-- > 0;) {
        nearest = table.texels[i].a > 0.0F ? std::uint16_t(i) : nearest;
        next[i] = nearest;
    }
    return next;
}

} // namespace

CellVisibility cellVisibility(const TexelCodes& codes, const Texels& texels,
                              const TransferTable& table, double filterErrorSampled) {
    SLABCAST_EXPECTS(!table.texels.empty() && table.texels.size() <= kNone, table.texels.size());
    SLABCAST_EXPECTS(codes.lowSampled.size() == codes.highSampled.size(), codes.lowSampled.size());
    SLABCAST_EXPECTS(filterErrorSampled >= 0.0, filterErrorSampled);
    const TableReach reach{tableAxis(texels, table)};
    const std::vector<std::uint16_t> next = nextWithAlpha(table);
    const std::size_t count = codes.lowSampled.size();
    CellVisibility visibility{&codes, std::vector<std::uint16_t>(count),
                              std::vector<std::uint16_t>(count)};
    for (std::size_t code = 0; code < count; ++code) {
        const double low = double(codes.lowSampled[code]) - filterErrorSampled;
        const double high = double(codes.highSampled[code]) + filterErrorSampled;
        visibility.firstVisible[code] = next[reach.below(low)];
        visibility.reach[code] = reach.above(high);
    }
    return visibility;
}

CellVisibility cellVisibilityOfAlpha(const TexelCodes& alphaCodes) {
    // Alpha is its own table here: every entry but zero is visible, and a cell reaches its largest
    // corner.
    CellVisibility visibility{&alphaCodes, std::vector<std::uint16_t>(256),
                              std::vector<std::uint16_t>(256)};
    for (std::uint16_t alpha = 0; alpha < 256; ++alpha) {
        visibility.firstVisible[alpha] = std::max<std::uint16_t>(alpha, 1);
        visibility.reach[alpha] = alpha;
    }
    return visibility;
}

} // namespace slabcast
