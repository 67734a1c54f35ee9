#pragma once

#include "core/skip/built_skip.h"
#include "core/skip/gpu/gpu_builder.h"

namespace slabcast {

/// A structure that was built on the GPU: its texture, and the host's copy, which facts, tight
/// planes and a lost context need.
struct GpuBuiltSkip {
    BuiltSkip skip;
    SkipTexture texture;
};

/// As buildSkip() builds, texel by texel; waits for the GPU, to read back. Partitioned maps and
/// their merged map are read back too: later TFs may merge on either side. Fails: as check(),
/// GpuSkipBuilder and its downloads. Tested by: gpu_builder_gl_test.cpp
Result<GpuBuiltSkip> buildSkipOnGpu(GpuSkipBuilder& builder, const GpuVoxels& voxels,
                                    const SkipSource& source, const SkipOptions& options);

} // namespace slabcast
