#include "core/skip/cell_visibility.h"

#include <algorithm>
#include <cmath>

namespace slabcast {

namespace {

constexpr std::uint16_t kNone = 65535;

/// Sampled value to table texel, as a rising line: where the texels' scale is negative (a file may
/// hold a negative rescale slope) the table is read backwards, so that higher codes still reach
/// higher texels.
struct TableAxis {
    double texelsPerSampled = 0.0;
    double texelAtZero = 0.0;
    bool backwards = false;
    bool whole = false; // no axis at all: any value may meet any texel
    int lastTexel = 0;

    /// Table texels, widened before they are clamped: a value well outside the table reads its end
    /// texel exactly and no neighbour, which keeps the air below a TF's first point empty.
    std::uint16_t below(double sampled) const {
        return whole ? 0 : clamped(std::floor(texelsPerSampled * sampled + texelAtZero) - 1.0);
    }
    std::uint16_t above(double sampled) const {
        return whole ? clamped(lastTexel)
                     : clamped(std::ceil(texelsPerSampled * sampled + texelAtZero) + 1.0);
    }
    std::uint16_t clamped(double texel) const {
        return std::uint16_t(std::clamp(texel, 0.0, double(lastTexel)));
    }
};

TableAxis tableAxis(const Texels& texels, const TransferTable& table) {
    TableAxis axis;
    axis.lastTexel = int(table.texels.size()) - 1;
    const double texelsPerValue = axis.lastTexel / (table.lastValue - table.firstValue);
    axis.texelsPerSampled = texelsPerValue * texels.valueScale;
    axis.texelAtZero = texelsPerValue * (texels.valueBias - table.firstValue);
    axis.whole = !std::isfinite(axis.texelsPerSampled) || !std::isfinite(axis.texelAtZero);
    axis.backwards = axis.texelsPerSampled < 0.0;
    if (axis.backwards) {
        axis.texelsPerSampled = -axis.texelsPerSampled;
        axis.texelAtZero = axis.lastTexel - axis.texelAtZero;
    }
    return axis;
}

/// Per texel in reading order: itself or the next one with alpha, kNone where none follows.
std::vector<std::uint16_t> nextWithAlpha(const TransferTable& table, bool backwards) {
    const std::size_t size = table.texels.size();
    std::vector<std::uint16_t> next(size);
    std::uint16_t nearest = kNone;
    for (std::size_t i = size; i-- > 0;) {
        const glm::vec4& texel = table.texels[backwards ? size - 1 - i : i];
        nearest = texel.a > 0.0F ? std::uint16_t(i) : nearest;
        next[i] = nearest;
    }
    return next;
}

} // namespace

bool CellVisibility::anyVisible() const {
    // Neighbouring cells share corners, so their ranges overlap, and together they leave no gap
    // between the volume's smallest and largest code: what is visible in that range is visible in
    // some cell.
    std::uint16_t lowest = kNone;
    std::uint16_t highest = 0;
    for (const std::uint16_t code : texels->codes) {
        lowest = std::min(lowest, code);
        highest = std::max(highest, code);
    }
    return lowest <= highest && visible(lowest, highest);
}

CellVisibility cellVisibility(const TexelCodes& codes, const Texels& texels,
                              const TransferTable& table, double filterErrorSampled) {
    SLABCAST_EXPECTS(!table.texels.empty() && table.texels.size() <= kNone, table.texels.size());
    SLABCAST_EXPECTS(codes.lowSampled.size() == codes.highSampled.size(), codes.lowSampled.size());
    SLABCAST_EXPECTS(filterErrorSampled >= 0.0, filterErrorSampled);
    const TableAxis axis = tableAxis(texels, table);
    const std::vector<std::uint16_t> next = nextWithAlpha(table, axis.backwards);
    const std::size_t count = codes.lowSampled.size();
    CellVisibility visibility{&codes, std::vector<std::uint16_t>(count),
                              std::vector<std::uint16_t>(count)};
    for (std::size_t code = 0; code < count; ++code) {
        const double low = double(codes.lowSampled[code]) - filterErrorSampled;
        const double high = double(codes.highSampled[code]) + filterErrorSampled;
        visibility.firstVisible[code] = next[axis.below(low)];
        visibility.reach[code] = axis.above(high);
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
