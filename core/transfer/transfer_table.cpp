#include "core/transfer/transfer_function.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "core/volume/half.h"

namespace slabcast {
namespace {

/// Values of the table's first and last texel, and how many there are.
struct Span {
    double first;
    double last;
    int size;

    double positionOf(double value) const { return (value - first) * (size - 1) / (last - first); }
};

/// Whether the TF jumps at its very first point: then what holds below it needs a texel of its own.
bool startsWithStep(const TransferFunction& tf) {
    return tf.points.size() > 1 && tf.points[0].value == tf.points[1].value;
}

/// Nothing where the TF is constant over the data.
std::optional<Span> spanFor(const TransferFunction& tf, double dataMin, double dataMax,
                            bool integerData, int maxSize) {
    const double firstKnot = tf.points.front().value;
    const double lastKnot = std::min(tf.points.back().value, dataMax);
    const bool below = startsWithStep(tf) && firstKnot > dataMin;
    const double first = std::max(firstKnot, dataMin);
    if (first > lastKnot || (first == lastKnot && !below)) {
        return std::nullopt;
    }
    if (integerData) {
        double low = below ? std::ceil(firstKnot) - 1.0 : std::floor(first);
        double high = std::ceil(lastKnot);
        if (high - low < 2.0 && tf.points.size() > 2) { // room for a peak between the end texels
            low -= 1.0;
            high += 1.0;
        }
        if (high - low < maxSize) {
            return Span{low, high, static_cast<int>(high - low) + 1};
        }
    }
    if (!below) {
        return Span{first, lastKnot, maxSize};
    }
    const double texel = (lastKnot - first) / (maxSize - 2);
    const double low = texel > 0.0 ? std::max(dataMin, first - texel) : dataMin;
    return Span{low, lastKnot, maxSize};
}

/// A visible extinction stays visible, were it 38 decades below the largest.
glm::vec4 texelOf(const TransferSample& sample, const TransferFunction& tf, double unitPerMm,
                  CompositingSpace space) {
    const double extinction = extinctionPerMm(sample.opacity, tf.opacityUnitMm) / unitPerMm;
    const auto kept = static_cast<float>(extinction);
    const float least = extinction > 0.0 ? std::numeric_limits<float>::min() : 0.0F;
    return {glm::vec3(colorIn(space, sample.color)), std::max(kept, least)};
}

/// Whether fp16 would lose digits of a point's extinction. (On its way to zero a ramp passes what
/// fp16 loses, but not for longer than a texel.)
bool spansMoreThanHalfs(const TransferFunction& tf, double unitPerMm) {
    return std::any_of(tf.points.begin(), tf.points.end(), [&](const TransferPoint& point) {
        const double extinction = extinctionPerMm(point.opacity, tf.opacityUnitMm) / unitPerMm;
        return extinction > 0.0 && extinction < double{kSmallestNormalHalf};
    });
}

/// What is visible stays visible.
glm::vec4 narrowed(const glm::vec4& t) {
    const float extinction = t.a > 0.0F ? std::max(kSmallestHalf, roundedToHalf(t.a)) : 0.0F;
    return {roundedToHalf(t.x), roundedToHalf(t.y), roundedToHalf(t.z), extinction};
}

/// Gives every peak that lies between two texels and above both to the nearer one, but not to an
/// end texel: that holds for all values beyond. The first point
/// of a step belongs to the interval on its left: at its own value the second one holds.
/// `give(texel, point)` is called for these, the highest of a texel last.
template <class Give>
void forNarrowPeaks(const TransferFunction& tf, const Span& span, const TransferTable& table,
                    Give give) {
    if (span.size < 3) {
        return; // end texels only
    }
    const auto opacityAt = [&](std::size_t texel) {
        return evaluate(tf, table.valueAt(texel)).opacity;
    };
    std::size_t texel = 0; // that the last peak was nearest to, and what it shows so far
    double shown = 0.0;
    for (const TransferPoint& point : tf.points) {
        const double position = span.positionOf(point.value);
        if (position <= 0.0 || position > span.size - 1) {
            continue;
        }
        const auto right = static_cast<std::size_t>(std::ceil(position));
        if (point.opacity <= std::max(opacityAt(right - 1), opacityAt(right))) {
            continue;
        }
        const auto nearest =
            static_cast<std::size_t>(std::clamp(std::lround(position), 1L, span.size - 2L));
        if (nearest != texel) { // points are sorted: no peak of an earlier one follows
            texel = nearest;
            shown = opacityAt(texel);
        }
        if (point.opacity > shown) {
            shown = point.opacity;
            give(texel, point);
        }
    }
}

} // namespace

double extinctionUnitPerMm(const TransferFunction& tf) {
    constexpr int kLargestExponent = 14; // 15 is the largest of fp16
    double most = 0.0;
    for (const TransferPoint& point : tf.points) {
        most = std::max(most, extinctionPerMm(point.opacity, tf.opacityUnitMm));
    }
    return most > 0.0 ? std::ldexp(1.0, std::ilogb(most) - kLargestExponent) : 1.0;
}

void makeTable(const TransferFunction& tf, double dataMin, double dataMax, bool integerData,
               CompositingSpace space, int maxSize, TransferTable& table) {
    SLABCAST_EXPECTS(!tf.points.empty(), tf.points.size());
    SLABCAST_EXPECTS(dataMin <= dataMax, dataMax - dataMin);
    SLABCAST_EXPECTS(maxSize >= 4, maxSize);
    const double unitPerMm = extinctionUnitPerMm(tf);
    const bool wide = spansMoreThanHalfs(tf, unitPerMm);
    const auto toTexel = [&](const TransferSample& sample) {
        const glm::vec4 texel = texelOf(sample, tf, unitPerMm, space);
        return wide ? texel : narrowed(texel);
    };
    table.extinctionPerMm = unitPerMm;
    table.wide = wide;
    table.texels.reserve(static_cast<std::size_t>(maxSize)); // the next one may be longer
    const std::optional<Span> span = spanFor(tf, dataMin, dataMax, integerData, maxSize);
    if (!span) {
        const double width = std::max(1.0, std::abs(dataMin) * 1e-3); // any that is not zero
        table.firstValue = dataMin;
        table.lastValue = dataMin + width;
        table.texels.assign(2, toTexel(evaluate(tf, dataMin)));
        return;
    }
    table.firstValue = span->first;
    table.lastValue = span->last;
    table.texels.resize(static_cast<std::size_t>(span->size));
    for (std::size_t texel = 0; texel < table.texels.size(); ++texel) {
        table.texels[texel] = toTexel(evaluate(tf, table.valueAt(texel)));
    }
    forNarrowPeaks(tf, *span, table, [&](std::size_t texel, const TransferPoint& point) {
        table.texels[texel] = toTexel({point.color, point.opacity});
    });
}

TransferTable makeTable(const TransferFunction& tf, double dataMin, double dataMax,
                        bool integerData, CompositingSpace space, int maxSize) {
    TransferTable table;
    makeTable(tf, dataMin, dataMax, integerData, space, maxSize, table);
    return table;
}

void bakeLength(std::vector<glm::vec4>& texels, double depthPerExtinction) {
    for (glm::vec4& texel : texels) {
        const auto alpha = static_cast<float>(-std::expm1(-texel.a * depthPerExtinction));
        const float kept = texel.a > 0.0F ? std::max(kSmallestHalf, alpha) : 0.0F;
        texel = glm::vec4(glm::vec3(texel) * kept, kept);
    }
}

glm::dvec4 lookUp(const TransferTable& table, double value) {
    SLABCAST_EXPECTS(table.texels.size() >= 2, table.texels.size());
    const auto last = static_cast<double>(table.texels.size() - 1);
    // Multiplied first: a value on a texel then finds it exactly, its neighbour not leaking in.
    const double position = std::clamp(
        (value - table.firstValue) * last / (table.lastValue - table.firstValue), 0.0, last);
    const double below = std::min(std::floor(position), last - 1.0);
    const auto index = static_cast<std::size_t>(below);
    return glm::mix(glm::dvec4(table.texels[index]), glm::dvec4(table.texels[index + 1]),
                    position - below) *
           glm::dvec4(1.0, 1.0, 1.0, table.extinctionPerMm);
}

} // namespace slabcast
