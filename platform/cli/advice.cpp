#include "platform/cli/advice.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <optional>

#include <fmt/format.h>

#include "core/scene/texel_format.h"

namespace slabcast {

namespace {

constexpr double kFaint = 4.0 / 255.0; // of white: hardly told from black

using Line = std::optional<std::string>;

std::string text(double value) {
    return fmt::format("{:.6g}", value);
}

std::string text(ValueRange range) {
    const double resolution = (range.max - range.min) * 1e-3;
    return valueText(range.min, resolution) + " to " + valueText(range.max, resolution);
}

ValueRange rangeOf(const VolumeStatistics& s) {
    return {s.min, s.max};
}

/// The largest opacity that the TF has for values of a range.
double mostOpacity(const TransferFunction& tf, ValueRange range) {
    double most = std::max(evaluate(tf, range.min).opacity, evaluate(tf, range.max).opacity);
    for (const TransferPoint& point : tf.points) {
        if (point.value >= range.min && point.value <= range.max) {
            most = std::max(most, point.opacity);
        }
    }
    return most;
}

std::string textOfVisible(const TransferFunction& tf) {
    const std::optional<ValueRange> visible = visibleValues(tf);
    if (!visible) {
        return "all its opacities are 0";
    }
    return std::isinf(visible->min) ? "it shows values below " + text(visible->max)
           : std::isinf(visible->max)
               ? "it shows values above " + text(visible->min)
               : "it shows " + text(visible->min) + " to " + text(visible->max);
}

Line nothingVisible(const PictureSubject& s) {
    const VolumeStatistics& data = s.statistics;
    if (mostOpacity(s.tf, rangeOf(data)) > 0.0) {
        return s.anythingVisible ? Line()
                                 : fmt::format("nothing is visible: no values of this volume are "
                                               "among those that the transfer function shows ({}); "
                                               "--tf linear is laid over its values",
                                               textOfVisible(s.tf));
    }
    return data.min == data.max
               ? fmt::format("all voxels hold {}, which is not visible under this transfer "
                             "function: {}; give one that has an opacity there",
                             valueText(data.min, 0.0), textOfVisible(s.tf))
               : fmt::format("nothing from {} is visible under this transfer function: {}; give "
                             "one for these values, or --tf linear, which is laid over them",
                             text(rangeOf(data)), textOfVisible(s.tf));
}

Line constantVolume(const PictureSubject& s) {
    if (s.mayBeConstant || s.statistics.min != s.statistics.max) {
        return std::nullopt;
    }
    return fmt::format("all voxels hold {}: there is nothing to see but the box; check that this "
                       "is the file, series or --time that was meant",
                       valueText(s.statistics.min, 0.0));
}

/// What stands for no value and is visible all the same.
Line fillValue(const PictureSubject& s) {
    const std::optional<BulkOfValues>& bulk = s.statistics.bulk;
    const auto shows = [&](bool fill, double value) {
        return fill && evaluate(s.tf, value).opacity > 0.0;
    };
    const bool above = bulk && shows(bulk->fillAbove, s.statistics.max);
    const bool below = bulk && shows(bulk->fillBelow, s.statistics.min);
    if (!above && !below) {
        return std::nullopt;
    }
    return fmt::format(
        "{} voxels hold {}, most likely a fill value, and are visible; all others lie from {}: "
        "give a transfer function that is 0 {} these{}",
        above ? bulk->voxelsAbove : bulk->voxelsBelow,
        text(above ? s.statistics.max : s.statistics.min), text(bulk->range),
        above ? "above" : "below", s.texelStep > 0.0 ? ", with --exact" : "");
}

Line laidOverBulk(const PictureSubject& s) {
    if (!s.laidOverBulk) {
        return std::nullopt;
    }
    const BulkOfValues& bulk = *s.statistics.bulk;
    const std::int64_t outside = bulk.voxelsBelow + bulk.voxelsAbove;
    return fmt::format("values reach from {}, but all except {} lie from {}: the transfer function "
                       "is laid over these; give one with values of its own to show others",
                       text(rangeOf(s.statistics)),
                       outside == 1 ? "one voxel" : fmt::format("{} voxels", outside),
                       text(bulk.range));
}

/// Opacity is per length: what is small in mm hardly absorbs.
Line unitOfLength(const PictureSubject& s) {
    const glm::dvec3 box = glm::dvec3(s.dims) * s.spacingMm;
    const double opacity = mostOpacity(s.tf, rangeOf(s.statistics));
    const double depth = extinctionPerMm(opacity, s.tf.opacityUnitMm) * glm::length(box);
    const double absorbed = -std::expm1(-depth);
    if (opacity <= 0.0 || absorbed >= kFaint) {
        return std::nullopt;
    }
    return fmt::format("opacity is per {:.6g} mm and the box is {:.6g} x {:.6g} x {:.6g} mm: at "
                       "most {:.2g} % of the light is absorbed; give --spacing X,Y,Z in mm, or a "
                       "transfer function whose opacityUnitMm is about {:.1g}",
                       s.tf.opacityUnitMm, box.x, box.y, box.z, 100.0 * absorbed,
                       std::max(glm::length(box) / 30.0, 1e-6));
}

/// Finer texels were wanted.
Line coarseTexels(const PictureSubject& s) {
    if (s.texelStep <= longestTexelStep(s.statistics, s.tf)) {
        return std::nullopt;
    }
    const std::optional<ValueRange> visible = visibleValues(s.tf);
    return fmt::format(
        "the texels have steps of {:.3g}, since values reach from {}: too coarse "
        "for a transfer function that shows {}; --downsample 2 makes room for exact ones",
        s.texelStep, text(rangeOf(s.statistics)), text(visible.value_or(s.statistics.shown())));
}

/// Every value is kept, at eight fetches a sample.
Line fineTexels(const PictureSubject& s) {
    if (s.filteredStep <= longestTexelStep(s.statistics, s.tf) || s.texelStep > 0.0) {
        return std::nullopt;
    }
    return fmt::format("values reach from {}, and filtered texels would have steps of {:.3g}, too "
                       "coarse for what is shown: every value is kept, as by --exact, at eight "
                       "fetches a sample",
                       text(rangeOf(s.statistics)), s.filteredStep);
}

} // namespace

std::vector<std::string> adviceOn(const PictureSubject& subject) {
    std::vector<std::string> lines;
    const auto add = [&](Line line) {
        if (line) {
            lines.push_back(*std::move(line));
        }
        return line.has_value();
    };
    if (add(nothingVisible(subject))) {
        return lines; // whatever else is odd, it is not seen
    }
    add(constantVolume(subject));
    if (!add(fillValue(subject))) {
        add(laidOverBulk(subject));
    }
    add(coarseTexels(subject));
    add(fineTexels(subject));
    add(unitOfLength(subject));
    return lines;
}

std::string valueText(double value, double resolution) {
    constexpr double kWhole = 0x1p53; // below it float64 has every whole number
    if (std::abs(value) < kWhole && value == std::trunc(value)) {
        return fmt::format("{:.0f}", value + 0.0); // no "-0"
    }
    for (int digits = 6; digits < std::numeric_limits<double>::max_digits10; ++digits) {
        std::string shorter = fmt::format("{:.{}g}", value, digits);
        const double read = std::strtod(shorter.c_str(), nullptr);
        if (read == value || std::abs(read - value) < 0.5 * resolution) {
            return shorter;
        }
    }
    return fmt::format("{:.{}g}", value, std::numeric_limits<double>::max_digits10);
}

} // namespace slabcast
