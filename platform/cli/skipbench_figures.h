#pragma once

#include <string>

#include <nlohmann/json.hpp>

namespace slabcast {

/// The figures to reach, each worked out from measured rows: `name`, `volume`, `value` (null where
/// its rows were not measured), `goal`, `sense` (">=" or "<="), `reached` (null without a value or
/// a goal) and `from`, in words. A goal stands only where it is meant for: skull CT under bone, the
/// gap phantom, or any volume.
nlohmann::json figuresOf(const nlohmann::json& volumes, const nlohmann::json& rows);

/// One line for the terminal.
std::string summaryOf(const nlohmann::json& figures);

} // namespace slabcast
