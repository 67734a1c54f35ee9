#include "platform/io/volumes/length_unit.h"

#include <map>
#include <string>

#include "platform/io/base/parse_text.h"

namespace slabcast {

namespace {

/// "micrometers", "micrometre" and "micron" alike as "micrometer"; every micro sign as "u".
std::string spelledAlike(std::string_view unit) {
    std::string text = lowerCase(trimmed(unit));
    for (const std::string_view micro : {"\xC2\xB5", "\xCE\xBC", "\xB5"}) {
        if (text.starts_with(micro)) {
            text.erase(0, micro.size() - 1);
            text.front() = 'u';
        }
    }
    if (text.size() > 2 && text.ends_with('s')) {
        text.pop_back();
    }
    if (text.ends_with("metre")) {
        text.replace(text.size() - 2, 2, "er");
    }
    return text;
}

} // namespace

std::optional<double> millimetresPer(std::string_view unit) {
    static const std::map<std::string, double> kUnits = {
        {"mm", 1.0},      {"millimeter", 1.0},  {"um", 1e-3},       {"micrometer", 1e-3},
        {"micron", 1e-3}, {"umeter", 1e-3},     {"nm", 1e-6},       {"nanometer", 1e-6},
        {"cm", 10.0},     {"centimeter", 10.0}, {"dm", 100.0},      {"decimeter", 100.0},
        {"m", 1e3},       {"meter", 1e3},       {"km", 1e6},        {"kilometer", 1e6},
        {"pm", 1e-9},     {"picometer", 1e-9},  {"angstrom", 1e-7}, {"inch", 25.4},
        {"inche", 25.4},  {"in", 25.4}};
    const auto found = kUnits.find(spelledAlike(unit));
    return found == kUnits.end() ? std::nullopt : std::optional(found->second);
}

bool isNoUnit(std::string_view unit) {
    const std::string text = lowerCase(trimmed(unit));
    return text.empty() || text == "???" || text == "?" || text == "none" || text == "unknown";
}

} // namespace slabcast
