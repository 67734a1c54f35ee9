#include "platform/io/json_checks.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace slabcast {

using nlohmann::json;

namespace {

/// nlohmann's texts begin with "[json.exception.parse_error.101] "; people need what follows.
std::string withoutTag(std::string_view what) {
    const std::size_t end = what.find("] ");
    return std::string(end == std::string_view::npos ? what : what.substr(end + 2));
}

} // namespace

tl::unexpected<Complaint> complain(std::string at, std::string what) {
    return tl::unexpected(Complaint{std::move(at), std::move(what)});
}

std::string said(const Complaint& complaint) {
    return complaint.at + (complaint.at.empty() ? "" : ": ") + complaint.what;
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

Checked<double> number(const json& value, const std::string& at, JsonRange range) {
    if (!value.is_number()) {
        return complain(at, fmt::format("is {}, expected a number", value.type_name()));
    }
    const double x = value.get<double>();
    if (!(x >= range.low && x <= range.high)) {
        return complain(at, fmt::format("{} is outside {}..{}", x, range.low, range.high));
    }
    return x;
}

Checked<double> numberAt(const json& object, const std::string& at, const char* key,
                         JsonRange range) {
    const auto found = object.find(key);
    return found == object.end() ? complain(inside(at, key), "is missing")
                                 : number(*found, inside(at, key), range);
}

Checked<int> integerAt(const json& object, const std::string& at, const char* key,
                       JsonRange range) {
    return numberAt(object, at, key, range).and_then([&](double x) -> Checked<int> {
        if (x != std::floor(x)) {
            return complain(inside(at, key), fmt::format("{} is no whole number", x));
        }
        return static_cast<int>(x);
    });
}

Checked<std::string> textAt(const json& object, const std::string& at, const char* key) {
    const auto found = object.find(key);
    if (found == object.end()) {
        return std::string();
    }
    if (!found->is_string()) {
        return complain(inside(at, key), fmt::format("is {}, expected a text", found->type_name()));
    }
    return found->get<std::string>();
}

Result<json> parseJson(std::string_view text, std::string_view sourceName, ErrorCode code) {
    try {
        return json::parse(text);
    } catch (const json::exception& exception) {
        return fail(code, fmt::format("{}: {}; correct the JSON there", sourceName,
                                      withoutTag(exception.what())));
    }
}

Result<std::string> readText(const std::string& path, const std::string& what) {
    std::error_code ignored;
    if (!std::filesystem::exists(path, ignored)) {
        return fail(ErrorCode::FileNotFound,
                    fmt::format("{}: no such {}; check the path", path, what));
    }
    std::ifstream file(path, std::ios::binary);
    if (!file || std::filesystem::is_directory(path, ignored)) {
        return fail(
            ErrorCode::FileUnreadable,
            fmt::format("{}: cannot be read; check that it is a file and its permissions", path));
    }
    return std::string{std::istreambuf_iterator<char>(file), {}};
}

} // namespace slabcast
