#pragma once

#include <string>

#include <nlohmann/json.hpp>

namespace slabcast {

/// The figures to reach, each worked out from measured rows: `key`, `name`, `volume`, `value` (null
/// where its rows were not measured), `goal`, `sense` (">=" or "<="), `reached` (null without a
/// value or a goal) and `from`, in words. A goal stands only where it is meant for: skull CT under
/// bone, the gap phantom, or any volume.
nlohmann::json figuresOf(const nlohmann::json& volumes, const nlohmann::json& rows);

/// Numbers alone: how many were `judged` and `reached`, and in `volumes`, by name and key, each
/// figure's value beside what was asked for.
nlohmann::json summaryOf(const nlohmann::json& figures);

/// One line for the terminal.
std::string lineOf(const nlohmann::json& summary, const nlohmann::json& figures);

} // namespace slabcast
