#pragma once

#include <string>

#include "perf/json.h"
#include "perf/skip/row.h"

namespace slabcast::skipbench {

const char* name(Table table);

/// A row as the report has it; docs/reports.md has the keys.
Json toJson(const Row& row);

/// What a row is of, with nothing that was measured: the same in every run of the same key.
std::string idOf(const Row& row);

/// A structure's builds as a store keeps them, and back: all that toJson() needs of them.
Json keptOf(const Build& build);
Build buildOf(const Json& kept);

std::vector<double> numbersOf(const Json& list);

} // namespace slabcast::skipbench
