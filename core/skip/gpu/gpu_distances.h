#pragma once

#include "core/gl/caps.h"
#include "core/skip/gpu/gpu_passes.h"
#include "core/skip/gpu/skip_texture.h"
#include "core/skip/proximity_cloud.h"

namespace slabcast {

// Free lengths from marks of occupied blocks, a byte each, four to a texel, on the GPU. Contract: a
// state guard stands. Fail: VolumeTooLarge, DeviceOutOfMemory, ShaderCompile.

/// 0 where occupied, else 1.
Result<SkipTexture> blocksFromMarks(BuildPrograms& programs, const gl::Caps& caps,
                                    const SkipTexture& marks, glm::ivec3 blocks);

/// The closest site along a line is looked for from each block outwards, as far as it may still
/// count. The marks serve as scratch.
Result<SkipTexture> chebyshevFromMarks(BuildPrograms& programs, const gl::Caps& caps,
                                       SkipTexture marks, glm::ivec3 blocks);

/// In the integers of the transform on the CPU, and with its counts. `found`: whether any block is
/// occupied.
Result<SkipTexture> proximityFromMarks(BuildPrograms& programs, const gl::Caps& caps,
                                       const SkipTexture& marks, glm::ivec3 blocks,
                                       const ProximityUnits& units, const gl::Buffer& found);

/// Chebyshev maps of partitions [0, count) from the range of partitions that each block holds. A
/// map's bytes lie in `maps` as in a texture, one map after the other.
Result<void> chebyshevOfPartitions(BuildPrograms& programs, const gl::Caps& caps,
                                   const SkipTexture& ranges, glm::ivec3 blocks, int count,
                                   const gl::Buffer& maps);

} // namespace slabcast
