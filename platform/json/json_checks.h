#pragma once

#include <initializer_list>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

#include "core/base/error.h"

namespace slabcast {

// How files of ours that people write are read: every complaint names the path of its entry.

struct JsonRange {
    double low;
    double high;
};

inline constexpr JsonRange kAnyNumber = {-1e300, 1e300};
inline constexpr JsonRange kUnitInterval = {0.0, 1.0};

/// Where something is wrong and what; said() makes one line of it.
struct Complaint {
    std::string at;
    std::string what;
};

template <class T>
using Checked = tl::expected<T, Complaint>;

tl::unexpected<Complaint> complain(std::string at, std::string what);
/// "points[2].color[1]: 1.4 is outside 0..1"
std::string said(const Complaint& complaint);

std::string inside(const std::string& at, std::string_view key); // path of a member
std::string element(const std::string& at, std::size_t index);   // path of a list's entry

Checked<void> checkKeys(const nlohmann::json& object, const std::string& at,
                        std::initializer_list<const char*> known);
Checked<double> number(const nlohmann::json& value, const std::string& at, JsonRange range);
Checked<double> numberAt(const nlohmann::json& object, const std::string& at, const char* key,
                         JsonRange range);
/// A whole number.
Checked<int> integerAt(const nlohmann::json& object, const std::string& at, const char* key,
                       JsonRange range);
/// Empty where it is missing.
Checked<std::string> textAt(const nlohmann::json& object, const std::string& at, const char* key);

/// Fails: `code`, with `sourceName` and where the JSON is at fault.
Result<nlohmann::json> parseJson(std::string_view text, std::string_view sourceName,
                                 ErrorCode code);

} // namespace slabcast
