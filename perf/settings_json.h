#pragma once

#include <span>
#include <string_view>

#include "core/plan/settings_table.h"
#include "perf/json.h"

namespace slabcast {

struct StageDesc;

/// A setting's value in a report: a number, two of them, true or false for on and off, another
/// word; null where it has none.
Json toJson(const Setting& setting, const SettingValue& value);

/// All settings of the table, each by keyOf() its name. Tested by: settings_json_test.cpp
Json toJson(const Settings& settings);

/// What is asked of every picture of a stage: its size, camera, and all settings by their names.
Json conditionsOf(const StageDesc& stage);

/// Takes over what such an object of settings holds, or the `settings` of a report; what it does
/// not name stays, as do those of `left`. Fails: InvalidArgument, as "no_such: is no setting" or
/// "layers: '0' is not ..."; then nothing has changed. Tested by: settings_json_test.cpp
Result<void> takeSettings(Settings& settings, const Json& given,
                          std::span<const std::string_view> left = {});

} // namespace slabcast
