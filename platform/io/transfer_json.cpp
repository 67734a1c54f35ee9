#include "platform/io/transfer_json.h"

#include <algorithm>
#include <fstream>
#include <iterator>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

namespace slabcast {

namespace {

using nlohmann::json;

struct Range {
    double low;
    double high;
};

constexpr Range kAnyNumber = {-1e300, 1e300};
constexpr Range kUnitInterval = {0.0, 1.0};

/// Where something is wrong and what; the border of parseTransferFunction turns it into an Error.
struct Complaint {
    std::string at;
    std::string what;
};

template <class T>
using Checked = tl::expected<T, Complaint>;

tl::unexpected<Complaint> complain(std::string at, std::string what) {
    return tl::unexpected(Complaint{std::move(at), std::move(what)});
}

std::string inside(const std::string& at, std::string_view key) {
    return at.empty() ? std::string(key) : fmt::format("{}.{}", at, key);
}

Checked<void> checkKeys(const json& object, const std::string& at,
                        std::initializer_list<const char*> known) {
    if (!object.is_object()) {
        return complain(at, fmt::format("is {}, expected an object", object.type_name()));
    }
    for (const auto& entry : object.items()) {
        if (std::find(known.begin(), known.end(), entry.key()) == known.end()) {
            return complain(inside(at, entry.key()),
                            fmt::format("unknown key; known are {}", fmt::join(known, ", ")));
        }
    }
    return {};
}

Checked<double> number(const json& value, const std::string& at, Range range) {
    if (!value.is_number()) {
        return complain(at, fmt::format("is {}, expected a number", value.type_name()));
    }
    const double x = value.get<double>();
    if (!(x >= range.low && x <= range.high)) {
        return complain(at, fmt::format("{} is outside {}..{}", x, range.low, range.high));
    }
    return x;
}

Checked<double> numberAt(const json& object, const std::string& at, const char* key, Range range) {
    const auto found = object.find(key);
    return found == object.end() ? complain(inside(at, key), "is missing")
                                 : number(*found, inside(at, key), range);
}

Checked<std::string> text(const json& object, const char* key) {
    const auto found = object.find(key);
    if (found == object.end()) {
        return std::string();
    }
    if (!found->is_string()) {
        return complain(key, fmt::format("is {}, expected a text", found->type_name()));
    }
    return found->get<std::string>();
}

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
    constexpr Range kOpacityUnitMm = {1e-6, 1e6};
    TransferFunction tf;
    return checkKeys(object, "", {"name", "unit", "opacityUnitMm", "points"})
        .and_then([&]() { return text(object, "name"); })
        .and_then([&](const std::string& name) {
            tf.name = name;
            return text(object, "unit");
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

/// nlohmann's texts begin with "[json.exception.parse_error.101] "; people need what follows.
std::string withoutTag(std::string_view what) {
    const std::size_t end = what.find("] ");
    return std::string(end == std::string_view::npos ? what : what.substr(end + 2));
}

} // namespace

Result<TransferFunction> parseTransferFunction(std::string_view text, std::string_view sourceName) {
    json document;
    try {
        document = json::parse(text);
    } catch (const json::exception& exception) {
        return fail(ErrorCode::InvalidTransferFunction,
                    fmt::format("{}: {}; correct the JSON there", sourceName,
                                withoutTag(exception.what())));
    }
    return parseObject(document)
        .map_error([](const Complaint& complaint) {
            return Error{ErrorCode::InvalidTransferFunction,
                         fmt::format("{}{}{}", complaint.at, complaint.at.empty() ? "" : ": ",
                                     complaint.what)};
        })
        .and_then([](TransferFunction tf) { return validated(std::move(tf)); })
        .map_error([&](const Error& error) {
            return Error{error.code, fmt::format("{}: {}", sourceName, error.detail)};
        });
}

Result<TransferFunction> loadTransferFunction(const std::filesystem::path& path) {
    std::error_code ignored;
    if (!std::filesystem::exists(path, ignored)) {
        return fail(
            ErrorCode::FileNotFound,
            fmt::format("{}: no such transfer function file; check the path", path.string()));
    }
    std::ifstream file(path, std::ios::binary);
    if (!file || std::filesystem::is_directory(path, ignored)) {
        return fail(ErrorCode::FileUnreadable,
                    fmt::format("{}: cannot be read; check that it is a file and its permissions",
                                path.string()));
    }
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    return parseTransferFunction(text, path.filename().string());
}

} // namespace slabcast
