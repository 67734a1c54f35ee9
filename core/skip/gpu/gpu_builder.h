#pragma once

#include "core/gl/caps.h"
#include "core/skip/cell_visibility.h"
#include "core/skip/gpu/gpu_passes.h"
#include "core/skip/gpu/gpu_pyramid.h"
#include "core/skip/gpu/skip_texture.h"
#include "core/skip/skip_structure.h"
#include "core/skip/value_bins.h"
#include "core/volume/volume.h"

namespace slabcast {

/// Partitioned maps on the GPU: a map's bytes lie in the buffer as in the texture of free lengths,
/// one map after the other.
struct GpuPartitions {
    glm::ivec3 blocks{0};
    int blockEdgeVoxels = 4;
    int count = 0;
    gl::Buffer maps;
    std::int64_t bytes = 0;
};

/// Builds skip structures from the volume's texture by compute shaders of core GLES 3.2, texel by
/// texel as the CPU's builders do and uploads lay them. Builds are queued, never waited for; the
/// GL state is left as it was found. All fail: VolumeTooLarge (beyond the device's textures, its
/// storage blocks or a budget), DeviceOutOfMemory, ShaderCompile. Tested by:
/// gpu_builder_gl_test.cpp
class GpuSkipBuilder {
public:
    /// Fails: DeviceUnsupported, naming the capacity that the device lacks: build on the CPU.
    static Result<GpuSkipBuilder> create(const gl::Caps& caps);

    /// Blocks, Chebyshev and Proximity. Contract: such a structure, and valid options.
    Result<SkipTexture> freeLengths(const GpuVoxels& voxels, const CellVisibility& visibility,
                                    const VolumeGeometry& geometry, const SkipOptions& options);

    Result<SkipTexture> booleanOctree(const GpuVoxels& voxels, const CellVisibility& visibility,
                                      const SkipOptions& options);
    Result<SkipTexture> minMaxOctree(const GpuVoxels& voxels, const SkipOptions& options);
    Result<SkipTexture> bitfieldOctree(const GpuVoxels& voxels, const ValueBins& bins,
                                       const SkipOptions& options);

    Result<GpuPartitions> partitions(const GpuVoxels& voxels, const ValueBins& bins,
                                     const SkipOptions& options);

    /// One dispatch, into a texture of free lengths that is made where there is none. Contract: it
    /// is one of the same blocks.
    Result<void> merge(const GpuPartitions& partitions, const BinSet& set, SkipTexture& into);

    /// For a context that is lost: drops names without a GL call. The builder is of no more use.
    void forget();

private:
    explicit GpuSkipBuilder(const gl::Caps& caps);

    void clearFound() const;
    Result<SkipTexture> octree(const GpuVoxels& voxels, const RangeTable& table,
                               NodeContent content, int bits, const SkipOptions& options);

    gl::Caps caps_;
    BuildPrograms programs_;
    gl::Buffer found_; // whether any block is occupied
};

/// What partitioned maps take on the GPU, known before they are built.
std::int64_t partitionBytes(glm::ivec3 dims, const SkipOptions& options);

} // namespace slabcast
