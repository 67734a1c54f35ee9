#include "platform/json/transfer_json.h"

#include <algorithm>
#include <cmath>

#include "platform/json/json_checks.h"
#include "platform/json/read_text.h"

namespace slabcast {

namespace {

using nlohmann::json;

Checked<glm::dvec3> parseColor(const json& point, const std::string& at) {
    const std::string path = inside(at, "color");
    const auto found = point.find("color");
    if (found == point.end()) {
        return complain(path, "is missing");
    }
    if (!found->is_array() || found->size() != 3) {
        return complain(path, "expected three numbers: red, green, blue");
    }
    glm::dvec3 color{0.0};
    for (int channel = 0; channel < 3; ++channel) {
        const Checked<double> x = number((*found)[channel], element(path, channel), kUnitInterval);
        if (!x) {
            return tl::unexpected(x.error());
        }
        color[channel] = *x;
    }
    return color;
}

Checked<TransferPoint> parsePoint(const json& point, const std::string& at) {
    TransferPoint parsed;
    return checkKeys(point, at, {"value", "color", "opacity"})
        .and_then([&]() { return numberAt(point, at, "value", kAnyNumber); })
        .and_then([&](double value) {
            parsed.value = value;
            return parseColor(point, at);
        })
        .and_then([&](glm::dvec3 color) {
            parsed.color = color;
            return numberAt(point, at, "opacity", kUnitInterval);
        })
        .map([&](double opacity) {
            parsed.opacity = opacity;
            return parsed;
        });
}

Checked<std::vector<TransferPoint>> parsePoints(const json& object) {
    const auto found = object.find("points");
    if (found == object.end() || !found->is_array() || found->empty()) {
        return complain("points", "expected a list of at least one point");
    }
    std::vector<TransferPoint> points;
    for (std::size_t i = 0; i < found->size(); ++i) {
        const Checked<TransferPoint> point = parsePoint((*found)[i], element("points", i));
        if (!point) {
            return tl::unexpected(point.error());
        }
        points.push_back(*point);
    }
    return points;
}

/// A transfer function as it is written.
struct Written {
    TransferFunction tf;
    double rangeShare = 1.0;
};

constexpr const char* kRelative = "range"; // the unit of values from 0 to 1

Checked<double> parseRangeShare(const json& object, const std::string& unit) {
    constexpr JsonRange kShares = {0.5, 1.0};
    if (!object.contains("rangeShare")) {
        return 1.0;
    }
    return unit == kRelative ? numberAt(object, "", "rangeShare", kShares)
                             : complain("rangeShare", "is of the unit \"range\" alone: leave it "
                                                      "out, or give that unit");
}

Checked<Written> parseObject(const json& object) {
    constexpr JsonRange kOpacityUnitMm = {1e-6, 1e6};
    Written written;
    TransferFunction& tf = written.tf;
    return checkKeys(object, "", {"name", "unit", "rangeShare", "opacityUnitMm", "points"})
        .and_then([&]() { return textAt(object, "", "name"); })
        .and_then([&](const std::string& name) {
            tf.name = name;
            return textAt(object, "", "unit");
        })
        .and_then([&](const std::string& unit) {
            tf.unit = unit;
            return parseRangeShare(object, unit);
        })
        .and_then([&](double share) -> Checked<double> {
            written.rangeShare = share;
            return object.contains("opacityUnitMm")
                       ? numberAt(object, "", "opacityUnitMm", kOpacityUnitMm)
                       : tf.opacityUnitMm;
        })
        .and_then([&](double opacityUnitMm) {
            tf.opacityUnitMm = opacityUnitMm;
            return parsePoints(object);
        })
        .map([&](const std::vector<TransferPoint>& points) {
            tf.points = points;
            return written;
        });
}

Checked<Written> withKnownUnit(Written written, std::string_view unitOfVolume) {
    const std::string& unit = written.tf.unit;
    if (unit.empty() || unit == kRelative || unit == "HU" || unit == unitOfVolume) {
        return written;
    }
    const bool another = !unitOfVolume.empty() && unitOfVolume != "HU";
    return complain("unit", "'" + unit + "' is not known; known are HU, " +
                                (another ? std::string(unitOfVolume) + ", " : "") +
                                "and range for values of 0 to 1 laid over the data's; or leave it "
                                "out");
}

/// The upper edge of the histogram's bin up to which `share` of the voxels lie.
double percentile(const VolumeStatistics& statistics, double share) {
    std::int64_t total = 0;
    for (const std::int64_t count : statistics.histogram) {
        total += count;
    }
    const auto wanted = static_cast<std::int64_t>(std::ceil(share * static_cast<double>(total)));
    std::int64_t below = 0;
    std::size_t bin = 0;
    while (bin < statistics.histogram.size() && below < wanted) {
        below += statistics.histogram[bin++];
    }
    const double position =
        static_cast<double>(bin) / static_cast<double>(statistics.histogram.size());
    return statistics.min + position * (statistics.max - statistics.min);
}

/// A fill value stands for nothing: the end value that would hold for it ends shortly beyond the
/// bulk.
void hideFills(TransferFunction& tf, const BulkOfValues& bulk) {
    const double beyond = (bulk.range.max - bulk.range.min) / 64.0;
    if (bulk.fillAbove && tf.points.back().opacity > 0.0) {
        TransferPoint end = tf.points.back();
        end.value = std::max(end.value, bulk.range.max) + beyond;
        tf.points.push_back(end);
        end.opacity = 0.0;
        tf.points.push_back(end);
    }
    if (bulk.fillBelow && tf.points.front().opacity > 0.0) {
        TransferPoint end = tf.points.front();
        end.value = std::min(end.value, bulk.range.min) - beyond;
        tf.points.insert(tf.points.begin(), end);
        end.opacity = 0.0;
        tf.points.insert(tf.points.begin(), end);
    }
}

/// In values of the data.
TransferFunction absolute(Written written, const VolumeStatistics& statistics) {
    TransferFunction& tf = written.tf;
    if (tf.unit != kRelative) {
        return std::move(tf);
    }
    const ValueRange shown = statistics.shown();
    const double low = shown.min;
    const double high = written.rangeShare < 1.0
                            ? std::min(percentile(statistics, written.rangeShare), shown.max)
                            : shown.max;
    const double span = high > low ? high - low : 1.0; // keeps the points of flat data in order
    for (TransferPoint& point : tf.points) {
        point.value = low + point.value * span;
    }
    if (statistics.bulk) {
        hideFills(tf, *statistics.bulk);
    }
    tf.unit.clear();
    return std::move(tf);
}

} // namespace

Result<TransferFunction> parseTransferFunction(std::string_view text, std::string_view sourceName,
                                               const TransferSubject& subject) {
    Result<json> document = parseJson(text, sourceName, ErrorCode::InvalidTransferFunction);
    if (!document) {
        return tl::unexpected(document.error());
    }
    return parseObject(*document)
        .and_then([&](Written written) { return withKnownUnit(std::move(written), subject.unit); })
        .map_error([](const Complaint& complaint) {
            return Error{ErrorCode::InvalidTransferFunction, said(complaint)};
        })
        .and_then([](Written written) {
            return validated(written.tf).map([&](TransferFunction tf) {
                return Written{std::move(tf), written.rangeShare};
            });
        })
        .map([&](Written written) { return absolute(std::move(written), subject.statistics); })
        .map_error([&](const Error& error) {
            return Error{error.code, std::string(sourceName) + ": " + error.detail};
        });
}

Result<TransferFunction> loadTransferFunction(const std::filesystem::path& path,
                                              const TransferSubject& subject) {
    return readText(path.string(), "transfer function file").and_then([&](const std::string& text) {
        return parseTransferFunction(text, path.filename().string(), subject);
    });
}

} // namespace slabcast
