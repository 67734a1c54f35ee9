#include "platform/json/json_checks.h"

#include <algorithm>
#include <cmath>

#include "core/base/number_text.h"
#include "core/base/printable.h"

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
    // Both quote keys and texts of the file.
    return withoutControls(complaint.at + (complaint.at.empty() ? "" : ": ") + complaint.what);
}

std::string inside(const std::string& at, std::string_view key) {
    return at.empty() ? std::string(key) : at + "." + std::string(key);
}

std::string element(const std::string& at, std::size_t index) {
    return at + "[" + std::to_string(index) + "]";
}

Checked<void> checkKeys(const json& object, const std::string& at,
                        std::initializer_list<const char*> known) {
    if (!object.is_object()) {
        return complain(at, std::string("is ") + object.type_name() + ", expected an object");
    }
    for (const auto& entry : object.items()) {
        if (std::find(known.begin(), known.end(), entry.key()) == known.end()) {
            std::string all;
            for (const char* key : known) {
                all += all.empty() ? key : std::string(", ") + key;
            }
            return complain(inside(at, entry.key()), "unknown key; known are " + all);
        }
    }
    return {};
}

Checked<double> number(const json& value, const std::string& at, JsonRange range) {
    if (!value.is_number()) {
        return complain(at, std::string("is ") + value.type_name() + ", expected a number");
    }
    const double x = value.get<double>();
    if (!(x >= range.low && x <= range.high)) {
        return complain(at, numberText(x) + " is outside " + numberText(range.low) + ".." +
                                numberText(range.high));
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
            return complain(inside(at, key), numberText(x) + " is no whole number");
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
        return complain(inside(at, key),
                        std::string("is ") + found->type_name() + ", expected a text");
    }
    return found->get<std::string>();
}

Result<json> parseJson(std::string_view text, std::string_view sourceName, ErrorCode code) {
    try {
        return json::parse(text);
    } catch (const json::exception& exception) {
        return fail(code, std::string(sourceName) + ": " + withoutTag(exception.what()) +
                              "; correct the JSON there");
    }
}

} // namespace slabcast
