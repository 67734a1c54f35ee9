#pragma once

#include <cstdint>

#include "core/skip/skip_structure.h"

namespace slabcast {

/// How empty space is skipped while a TF is edited. Tested by: live_skip_test.cpp
struct LiveOptions {
    /// The structure that serves while the TF changes. It is built once and is exact under any TF:
    /// a bitfield octree, a min-max octree, or partitioned maps.
    SkipOptions always{.structure = SkipStructure::BitfieldOctree};
    /// The structure that serves once the TF rests. It skips more, but is exact under the one TF
    /// that it was built for: proximity, chebyshev or blocks. None: the first one always serves.
    SkipOptions settled{.structure = SkipStructure::Proximity};
    /// Rebuilding begins after so many calls of work() without an edit. While a TF is dragged, an
    /// edit comes in every frame or two, and what was begun in between would be thrown away. Three
    /// frames without one, 50 ms at 60 Hz, mean that the hand rests.
    int quietFrames = 3;
};

/// What LiveScene::work() did, or waits for.
enum class LiveProgress : std::uint8_t {
    Settled,  // nothing to do: the settled structure serves and fits the TF
    Waiting,  // the last edit was too few frames ago, or the budget is 0
    Building, // the settled structure is being rebuilt
    Incoming, // it is rebuilt; its texture is being uploaded, a share a frame
    Swapped,  // it serves from this call on
};

const char* name(LiveProgress progress);

} // namespace slabcast
