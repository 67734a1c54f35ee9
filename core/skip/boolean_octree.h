#pragma once

#include "core/skip/minmax_octree.h"

namespace slabcast {

/// Octree of occupied nodes, for one TF: occupied as blocks are, see core/skip/occupancy.h. Cost:
/// O(nodes), all cores.
/// Source: Faludi et al. 2021, section 4.4. Tested by: octree_test.cpp
Octree booleanOctree(const Octree& minMax, const CellVisibility& visibility);

/// The same from the volume. Cost and failures: as buildMinMaxOctree().
Result<Octree> buildBooleanOctree(const CellVisibility& visibility, const SkipOptions& options,
                                  const CancelToken* cancel = nullptr);

/// The test of the TF that the octree was built for.
NodeTest booleanNodeTest();

} // namespace slabcast
