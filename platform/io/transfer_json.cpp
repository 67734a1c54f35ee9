#include "platform/io/transfer_json.h"

#include <fmt/format.h>

#include "platform/io/json_checks.h"

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
        const Checked<double> x =
            number((*found)[channel], fmt::format("{}[{}]", path, channel), kUnitInterval);
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
        const Checked<TransferPoint> point = parsePoint((*found)[i], fmt::format("points[{}]", i));
        if (!point) {
            return tl::unexpected(point.error());
        }
        points.push_back(*point);
    }
    return points;
}

Checked<TransferFunction> parseObject(const json& object) {
    constexpr JsonRange kOpacityUnitMm = {1e-6, 1e6};
    TransferFunction tf;
    return checkKeys(object, "", {"name", "unit", "opacityUnitMm", "points"})
        .and_then([&]() { return textAt(object, "", "name"); })
        .and_then([&](const std::string& name) {
            tf.name = name;
            return textAt(object, "", "unit");
        })
        .and_then([&](const std::string& unit) -> Checked<double> {
            tf.unit = unit;
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
            return tf;
        });
}

} // namespace

Result<TransferFunction> parseTransferFunction(std::string_view text, std::string_view sourceName) {
    Result<json> document = parseJson(text, sourceName, ErrorCode::InvalidTransferFunction);
    if (!document) {
        return tl::unexpected(document.error());
    }
    return parseObject(*document)
        .map_error([](const Complaint& complaint) {
            return Error{ErrorCode::InvalidTransferFunction, said(complaint)};
        })
        .and_then([](TransferFunction tf) { return validated(std::move(tf)); })
        .map_error([&](const Error& error) {
            return Error{error.code, fmt::format("{}: {}", sourceName, error.detail)};
        });
}

Result<TransferFunction> loadTransferFunction(const std::filesystem::path& path) {
    return readText(path.string(), "transfer function file").and_then([&](const std::string& text) {
        return parseTransferFunction(text, path.filename().string());
    });
}

} // namespace slabcast
