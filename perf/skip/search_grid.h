#pragma once

#include <vector>

#include "core/skip/skip_structure.h"

namespace slabcast::skipbench {

/// Parameters that a search tries, for a volume of these dims: edges of blocks or leaves, an
/// octree's initial levels and traversals, a bitfield octree's bits; fewer of each where `quick`.
/// Octrees that would begin below their leaves are left out. Tested by: search_grid_test.cpp
std::vector<SkipOptions> searchGrid(SkipStructure structure, glm::ivec3 dims, bool quick);

} // namespace slabcast::skipbench
