#pragma once

#include "core/skip/gpu/gpu_builder.h"

namespace slabcast {

/// What builders left on the GPU, as the CPU's builders return it. Wait for the GPU; leave its
/// state as they found it. Fail: DeviceUnsupported (a texture that cannot be read), Internal.
/// Tested by: gpu_builder_gl_test.cpp

/// The words of all texels, x fastest, as the layout has them; what no level holds is undefined.
Result<std::vector<std::uint32_t>> downloadTexels(const SkipTexture& structure,
                                                  const SkipLayout& layout);

/// Of that many blocks. `quantumMm`: of Euclidean lengths, else 0.
Result<FreeLengths> downloadFreeLengths(const SkipTexture& lengths, glm::ivec3 blocks,
                                        int blockEdgeVoxels, double quantumMm = 0.0);

/// Of that many leaves and levels.
Result<Octree> downloadOctree(const SkipTexture& octree, NodeContent content, int bitsPerNode,
                              int leafEdgeVoxels, glm::ivec3 leaves, int levels);

/// Partition by partition, of each blocks x fastest.
Result<std::vector<std::uint8_t>> downloadDistances(const GpuPartitions& partitions);

} // namespace slabcast
