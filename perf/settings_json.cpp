#include "perf/settings_json.h"

#include <nlohmann/json.hpp>

#include "perf/report_json.h"

namespace slabcast {

using nlohmann::json;

json toJson(const Setting& setting, const SettingValue& value) {
    if (value.count == 0) {
        return nullptr;
    }
    if (value.count == 2) {
        return value.numbers;
    }
    if (setting.kind != SettingKind::Choice) {
        const bool whole = setting.kind == SettingKind::Whole;
        return whole ? json(static_cast<std::int64_t>(value.numbers[0])) : json(value.numbers[0]);
    }
    const std::string word = setting.text(value);
    return word == "on" || word == "off" ? json(word == "on") : json(word);
}

json toJson(const Settings& settings) {
    json all = json::object();
    for (const Setting& setting : settingsTable()) {
        all[keyOf(setting.name)] = toJson(setting, setting.read(settings));
    }
    return all;
}

} // namespace slabcast
