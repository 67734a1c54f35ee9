#include "core/transfer/preintegrated.h"

#include <algorithm>
#include <cmath>

#include "core/base/parallel.h"
#include "core/transfer/transfer_integral.h"
#include "core/volume/half.h"

namespace slabcast {

namespace {

constexpr std::int64_t kRowGrain = 16;

/// Rounded to fp16; what is visible stays visible.
glm::u16vec4 texelOf(glm::dvec4 mean) {
    const glm::vec4 kept(mean);
    const auto extinction = halfFromFloat(kept.w);
    return {halfFromFloat(kept.x), halfFromFloat(kept.y), halfFromFloat(kept.z),
            mean.w > 0.0 ? std::max<std::uint16_t>(extinction, 1) : extinction};
}

/// Means between neighbouring texels, in the table's unit. Values that no datum has are left out.
std::vector<glm::dvec4> cellMeans(const TransferIntegral& integral, const TransferTable& diagonal,
                                  double dataMax) {
    const auto cells = static_cast<std::int64_t>(diagonal.texels.size()) - 1;
    const auto valueAt = [&](std::int64_t texel) {
        return std::min(diagonal.valueAt(static_cast<std::size_t>(texel)), dataMax);
    };
    std::vector<glm::dvec4> means(static_cast<std::size_t>(cells));
    parallelFor(cells, kRowGrain, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t k = begin; k < end; ++k) {
            means[static_cast<std::size_t>(k)] =
                integral.mean(valueAt(k), valueAt(k + 1)) / diagonal.extinctionPerMm;
        }
    });
    return means;
}

/// What is visible between two texels is so in one of them, which is what skipping goes by: also
/// where rounding moved a knot past a texel. Not in an end texel, which holds for all beyond.
void markVisible(const std::vector<glm::dvec4>& cells, std::vector<glm::vec4>& diagonal) {
    for (std::size_t k = 0; k < cells.size(); ++k) {
        if (cells[k].w > 0.0 && diagonal[k].w == 0.0F && diagonal[k + 1].w == 0.0F) {
            diagonal[k + 2 < diagonal.size() ? k + 1 : k].w = kSmallestHalf;
        }
    }
}

/// Values of one axis, in texels: within the table, and how far beyond.
struct Span {
    double low, high;

    double inside(double last) const {
        return std::clamp(high, 0.0, last) - std::clamp(low, 0.0, last);
    }
    double below() const { return std::max(std::min(high, 0.0) - low, 0.0); }
    double above(double last) const { return std::max(high - std::max(low, last), 0.0); }
};

} // namespace

glm::vec4 PreintegratedTable::at(int front, int back) const {
    const glm::u16vec4 half =
        texels[static_cast<std::size_t>(back) * diagonal.texels.size() + front];
    return {floatFromHalf(half.x), floatFromHalf(half.y), floatFromHalf(half.z),
            floatFromHalf(half.w)};
}

PreintegratedTable makePreintegratedTable(const TransferFunction& tf, double dataMin,
                                          double dataMax, bool integerData, CompositingSpace space,
                                          int maxSize) {
    PreintegratedTable table{makeTable(tf, dataMin, dataMax, integerData, space, maxSize), {}};
    const std::vector<glm::dvec4> cells =
        cellMeans(TransferIntegral(tf, space), table.diagonal, dataMax);
    markVisible(cells, table.diagonal.texels);
    const std::size_t size = table.diagonal.texels.size();
    table.texels.resize(size * size);
    // Cells are of equal width, so the mean over several is the mean of theirs.
    parallelFor(std::int64_t(size), kRowGrain, [&](std::int64_t begin, std::int64_t end) {
        for (auto row = static_cast<std::size_t>(begin); row < std::size_t(end); ++row) {
            const glm::dvec4 same(table.diagonal.texels[row]);
            table.texels[row * size + row] = texelOf({glm::dvec3(same) * same.w, same.w});
            glm::dvec4 sum(0.0);
            for (std::size_t k = row + 1; k < size; ++k) {
                sum += cells[k - 1];
                const glm::u16vec4 texel = texelOf(sum / static_cast<double>(k - row));
                table.texels[row * size + k] = texel;
                table.texels[k * size + row] = texel;
            }
        }
    });
    return table;
}

glm::dvec4 lookUp(const PreintegratedTable& table, double front, double back) {
    const TransferTable& axis = table.diagonal;
    const int last = table.size() - 1;
    const auto texelAt = [&](double value) {
        return (value - axis.firstValue) * last / (axis.lastValue - axis.firstValue);
    };
    const glm::dvec2 place(texelAt(front), texelAt(back));
    const glm::dvec2 within = glm::clamp(place, 0.0, static_cast<double>(last));
    const glm::ivec2 low = glm::min(glm::ivec2(within), last - 1);
    const glm::dvec2 f = within - glm::dvec2(low);
    const auto row = [&](int back_) {
        return glm::mix(glm::dvec4(table.at(low.x, back_)), glm::dvec4(table.at(low.x + 1, back_)),
                        f.x);
    };
    glm::dvec4 mean = glm::mix(row(low.y), row(low.y + 1), f.y);
    const Span span{std::min(place.x, place.y), std::max(place.x, place.y)};
    if (span.low < span.high) {
        mean = (mean * span.inside(last) + glm::dvec4(table.at(0, 0)) * span.below() +
                glm::dvec4(table.at(last, last)) * span.above(last)) /
               (span.high - span.low);
    }
    return mean * axis.extinctionPerMm;
}

double preintegratedColorError(double depth) {
    if (depth < 1e-2) {
        return depth / 8.0; // off by less than 1e-6 of itself
    }
    // The two weights cross where exp(-t) is the mean transmittance.
    const double opacity = -std::expm1(-depth);
    const double crossing = opacity / depth;
    return (1.0 - crossing) / opacity + std::log(crossing) / depth;
}

double visibleColorRange(const TransferFunction& tf, double dataMin, double dataMax,
                         CompositingSpace space) {
    glm::dvec3 least(1.0);
    glm::dvec3 most(0.0);
    const auto include = [&](const TransferSample& sample) {
        const glm::dvec3 color = colorIn(space, sample.color);
        least = glm::min(least, color);
        most = glm::max(most, color);
    };
    const auto includeBetween = [&](const TransferSample& a, const TransferSample& b) {
        if (a.opacity > 0.0 || b.opacity > 0.0) {
            include(a);
            include(b);
        }
    };
    TransferSample before = evaluate(tf, dataMin);
    for (const TransferPoint& point : tf.points) {
        if (point.value >= dataMin && point.value <= dataMax) {
            const TransferSample here{point.color, point.opacity};
            includeBetween(before, here);
            before = here;
        }
    }
    includeBetween(before, evaluate(tf, dataMax));
    const glm::dvec3 range = glm::max(most - least, 0.0);
    return std::max({range.x, range.y, range.z});
}

} // namespace slabcast
