#include "perf/settings_json.h"

#include "perf/report_json.h"
#include "perf/stage.h"

namespace slabcast {

Json toJson(const Setting& setting, const SettingValue& value) {
    if (value.count == 0) {
        return nullptr;
    }
    if (value.count == 2) {
        return Json::listOf(value.numbers);
    }
    if (setting.kind != SettingKind::Choice) {
        const bool whole = setting.kind == SettingKind::Whole;
        return whole ? Json(static_cast<std::int64_t>(value.numbers[0])) : Json(value.numbers[0]);
    }
    const std::string word = setting.text(value);
    return word == "on" || word == "off" ? Json(word == "on") : Json(word);
}

Json toJson(const Settings& settings) {
    Json all = Json::object();
    for (const Setting& setting : settingsTable()) {
        all[keyOf(setting.name)] = toJson(setting, setting.read(settings));
    }
    return all;
}

Json conditionsOf(const StageDesc& stage) {
    return {{"size", Json::list({stage.size.x, stage.size.y})},
            {"camera", toJson(stage.camera)},
            {"fov_degrees", stage.fovDegrees},
            {"settings", toJson(stage.settings)}};
}

} // namespace slabcast
