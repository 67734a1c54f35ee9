#pragma once

#include "core/gl/caps.h"
#include "core/skip/gpu/gpu_passes.h"
#include "core/skip/gpu/skip_texture.h"
#include "core/skip/value_bins.h"

namespace slabcast {

/// A volume's texture as builders on the GPU read it. The texture is not theirs and must live as
/// long.
struct GpuVoxels {
    GLuint texture = 0; // 3D, one level
    glm::ivec3 dims{0};
    TexelCoding coding = TexelCoding::Unorm8;
    // Of floats alone: the least float of every code, and what finds a code near by.
    gl::Texture codeStarts;
    float leastFloat = 0.0F;
    float codesPerFloat = 0.0F;
};

/// Scalars as uploadTexels() laid them. Fails: DeviceOutOfMemory, Internal.
Result<GpuVoxels> gpuVoxels(GLuint texture, TexelFormat format, const TexelCodes& codes);
/// Pre-classified texels: the codes are their alpha bytes.
GpuVoxels gpuVoxelsOfAlpha(GLuint texture, glm::ivec3 dims);

/// What leaves are made from: ranges by code, two halves of a word. Empty: the codes themselves.
struct RangeTable {
    std::vector<std::uint32_t> words;
};

RangeTable rangesOf(const CellVisibility& visibility); // first visible table texel, and reach
RangeTable rangesOf(const ValueBins& bins);            // the bin, twice

struct PyramidDesc {
    NodeContent content = NodeContent::Occupied;
    int edgeVoxels = 4; // of a leaf, a power of two
    SkipLayout layout;
};

/// Leaves, and levels above them, on the GPU. Leaves of more than 8 voxels are joined from smaller
/// ones. `found` gets 1 if any is occupied; only marks look at it. Fails: VolumeTooLarge,
/// DeviceOutOfMemory, ShaderCompile. Contract: a state guard stands.
Result<SkipTexture> buildPyramid(BuildPrograms& programs, const gl::Caps& caps,
                                 const GpuVoxels& voxels, const RangeTable& table,
                                 const PyramidDesc& desc, const gl::Buffer& found);

} // namespace slabcast
