#include "perf/settings_json.h"

#include <algorithm>

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

namespace {

/// As Setting::parse() reads it; a list or an object as what it is, which no setting takes.
std::string textOf(const Setting& setting, const Json& value) {
    if (value.isNull() && setting.unset != nullptr) {
        return setting.unset;
    }
    if (value.isBool()) {
        return value.flag() ? "on" : "off";
    }
    if (value.isText()) {
        return value.text();
    }
    const bool isPair = value.isList() && value.size() == 2;
    return isPair ? value.at(std::size_t{0}).dump() + "," + value.at(std::size_t{1}).dump()
                  : value.dump();
}

const Setting* settingOfKey(std::string_view key) {
    for (const Setting& setting : settingsTable()) {
        if (keyOf(setting.name) == key) {
            return &setting;
        }
    }
    return nullptr;
}

} // namespace

Result<void> takeSettings(Settings& settings, const Json& given,
                          std::span<const std::string_view> left) {
    const Json& all = given.at("settings").isObject() ? given.at("settings") : given;
    if (!all.isObject()) {
        return fail(ErrorCode::InvalidArgument, "holds no settings");
    }
    Settings taken = settings;
    for (const std::string& key : all.names()) {
        const Setting* setting = settingOfKey(key);
        if (setting == nullptr) {
            return fail(ErrorCode::InvalidArgument, key + ": is no setting");
        }
        const Result<SettingValue> value = setting->parse(textOf(*setting, all.at(key)));
        if (!value) {
            return tl::unexpected(value.error());
        }
        if (std::find(left.begin(), left.end(), setting->name) == left.end()) {
            setting->write(taken, *value);
        }
    }
    settings = taken;
    return {};
}

} // namespace slabcast
