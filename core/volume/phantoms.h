#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/volume/volume.h"

namespace slabcast {

struct PhantomInfo {
    std::string name;
    std::string description; // one line
};

std::vector<PhantomInfo> phantomList();

/// A volume from a formula: `phantom:NAME` or `phantom:NAME:SIZE`, SIZE being N (cubic) or XxYxZ,
/// default 128. Voxels are 1 mm, the box is centred on the origin, and shapes are scaled to its
/// shortest edge.
/// Cost: O(voxels), all cores; nothing in it is random.
/// Fails: InvalidArgument (unknown name, malformed size), EmptyVolume (a size of 0), SizeOverflow
/// (over 2^30 voxels).
/// Tested by: phantoms_test.cpp
Result<Volume> makePhantom(std::string_view spec);

} // namespace slabcast
