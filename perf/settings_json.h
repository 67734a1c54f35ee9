#pragma once

#include <nlohmann/json_fwd.hpp>

#include "core/plan/settings_table.h"

namespace slabcast {

/// A setting's value in a report: a number, two of them, true or false for on and off, another
/// word; null where it has none.
nlohmann::json toJson(const Setting& setting, const SettingValue& value);

/// All settings of the table, each by keyOf() its name. Tested by: settings_json_test.cpp
nlohmann::json toJson(const Settings& settings);

} // namespace slabcast
