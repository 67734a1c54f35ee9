#pragma once

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

} // namespace slabcast
