#include "core/skip/gpu_pyramid.h"

#include <algorithm>
#include <bit>

namespace slabcast {

namespace {

constexpr int kTileVoxels = 8; // edge of what a workgroup looks at: also the longest leaf it makes

constexpr TexelLayout kWordTable = {GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, GL_NEAREST, 4};
constexpr TexelLayout kFloatTable = {GL_R32F, GL_RED, GL_FLOAT, GL_NEAREST, 4};

/// Entries by code, 256 to a row.
template <class Value>
Result<gl::Texture> uploadByCode(const char* label, const TexelLayout& layout,
                                 const std::vector<Value>& values) {
    constexpr int kRow = 256;
    return upload2d(label, layout, {kRow, int(values.size()) / kRow}, values.data());
}

/// Writes level 0 of `nodes`, padding included. Contract: leaves of at most 8 voxels.
Result<void> writeLeaves(BuildPrograms& programs, const GpuVoxels& voxels, const RangeTable& table,
                         const PyramidDesc& desc, const SkipLayout& layout,
                         const gl::Texture& nodes, const gl::Buffer& found) {
    gl::Texture ranges;
    if (!table.words.empty()) {
        Result<gl::Texture> uploaded = uploadByCode("ranges of codes", kWordTable, table.words);
        if (!uploaded) {
            return tl::unexpected(uploaded.error());
        }
        ranges = std::move(*uploaded);
    }
    const Result<const gl::Program*> program = programs.use(
        leavesPass(voxels.coding, desc.content, table.words.empty(), desc.edgeVoxels, desc.bits));
    if (!program) {
        return tl::unexpected(program.error());
    }
    bindInput(0, GL_TEXTURE_3D, gl::Texture::borrow(voxels.texture));
    bindInput(1, GL_TEXTURE_2D, ranges);
    bindInput(2, GL_TEXTURE_2D, voxels.codeStarts);
    bindOutput(nodes, 0, texelLayoutOf(layout).internalFormat);
    gl::BindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, found.id());
    gl::Uniform2f((*program)->uniform("codeEstimate"), voxels.leastFloat, voxels.codesPerFloat);
    setUniform(**program, "dims", voxels.dims);
    setUniform(**program, "leaves", blocksOf(voxels.dims, desc.edgeVoxels));
    const int leaves = kTileVoxels / desc.edgeVoxels;
    const glm::ivec3 texelsPerGroup(std::max(1, leaves / layout.perTexel), leaves, leaves);
    runGroups((layout.texels + texelsPerGroup - 1) / texelsPerGroup);
    return {};
}

/// Joins a level's nodes to those of another, of half as many texels along each axis.
Result<void> writeParents(BuildPrograms& programs, const PyramidDesc& desc,
                          const gl::Texture& children, int childLevel, const SkipLayout& layout,
                          const gl::Texture& nodes, int level) {
    const Result<const gl::Program*> program = programs.use(parentsPass(desc.content, layout.bits));
    if (!program) {
        return tl::unexpected(program.error());
    }
    bindInput(0, GL_TEXTURE_3D, children);
    bindOutput(nodes, level, texelLayoutOf(layout).internalFormat);
    setUniform(**program, "childLevel", childLevel);
    runPerTexel(**program, layout.texelsOf(level));
    return {};
}

/// The levels above level 0.
Result<void> writeLevels(BuildPrograms& programs, const PyramidDesc& desc, const SkipLayout& layout,
                         const gl::Texture& nodes) {
    Result<void> done;
    for (int level = 1; level < layout.levels && done; ++level) {
        done = writeParents(programs, desc, nodes, level - 1, layout, nodes, level);
    }
    return done;
}

/// Leaves that several tiles make up: a pyramid of its own below them, which is padded so that its
/// next level would be level 0 of `nodes`.
Result<void> joinLeaves(BuildPrograms& programs, const gl::Caps& caps, const GpuVoxels& voxels,
                        const RangeTable& table, const PyramidDesc& desc, const SkipLayout& layout,
                        const gl::Texture& nodes, const gl::Buffer& found) {
    const int below = std::countr_zero(unsigned(desc.edgeVoxels / kTileVoxels));
    PyramidDesc fine = desc;
    fine.edgeVoxels = kTileVoxels;
    SkipLayout fineLayout =
        octreeLayout(blocksOf(voxels.dims, kTileVoxels), below + layout.levels, desc.bits);
    fineLayout.levels = below;
    Result<SkipTexture> leaves = allocate("leaves", fineLayout, caps);
    if (!leaves) {
        return tl::unexpected(leaves.error());
    }
    return writeLeaves(programs, voxels, table, fine, fineLayout, leaves->texture, found)
        .and_then([&] { return writeLevels(programs, fine, fineLayout, leaves->texture); })
        .and_then([&] {
            return writeParents(programs, desc, leaves->texture, below - 1, layout, nodes, 0);
        });
}

} // namespace

Result<GpuVoxels> gpuVoxels(GLuint texture, TexelFormat format, const TexelCodes& codes) {
    GpuVoxels voxels{.texture = texture, .dims = codes.dims, .coding = codingOf(format)};
    if (voxels.coding == TexelCoding::Float) {
        Result<gl::Texture> starts = uploadByCode("code starts", kFloatTable, codeStarts(codes));
        if (!starts) {
            return tl::unexpected(starts.error());
        }
        voxels.codeStarts = std::move(*starts);
        voxels.leastFloat = codes.lowSampled.front();
        const double range = double(codes.highSampled.back()) - double(voxels.leastFloat);
        voxels.codesPerFloat =
            range > 0.0 ? float(std::min(double(codes.lowSampled.size()) / range, 0x1p126)) : 0.0F;
    }
    return voxels;
}

GpuVoxels gpuVoxelsOfAlpha(GLuint texture, glm::ivec3 dims) {
    return {.texture = texture, .dims = dims, .coding = TexelCoding::Alpha};
}

RangeTable rangesOf(const CellVisibility& visibility) {
    RangeTable table;
    for (std::size_t code = 0; code < visibility.reach.size(); ++code) {
        table.words.push_back(visibility.firstVisible[code] | std::uint32_t(visibility.reach[code])
                                                                  << 16);
    }
    return table;
}

RangeTable rangesOf(const ValueBins& bins) {
    RangeTable table;
    for (const std::uint32_t bin : bins.binOfCode) {
        table.words.push_back(bin | bin << 16);
    }
    return table;
}

Result<SkipTexture> buildPyramid(BuildPrograms& programs, const gl::Caps& caps,
                                 const GpuVoxels& voxels, const RangeTable& table,
                                 const PyramidDesc& desc, const gl::Buffer& found) {
    const SkipLayout layout =
        octreeLayout(blocksOf(voxels.dims, desc.edgeVoxels), desc.levels, desc.bits);
    Result<SkipTexture> nodes = allocate("skip nodes", layout, caps);
    if (!nodes) {
        return nodes;
    }
    const Result<void> leaves =
        desc.edgeVoxels <= kTileVoxels
            ? writeLeaves(programs, voxels, table, desc, layout, nodes->texture, found)
            : joinLeaves(programs, caps, voxels, table, desc, layout, nodes->texture, found);
    return leaves.and_then([&] { return writeLevels(programs, desc, layout, nodes->texture); })
        .map([&] { return std::move(*nodes); });
}

Result<SkipTexture> allocate(const char* label, const SkipLayout& layout, const gl::Caps& caps) {
    return checkFits(layout, caps)
        .and_then(
            [&] { return allocate3d(label, texelLayoutOf(layout), layout.texels, layout.levels); })
        .map([&](gl::Texture&& texture) {
            return SkipTexture{std::move(texture), layout.bytes()};
        });
}

glm::ivec3 blocksOf(glm::ivec3 dims, int edgeVoxels) {
    return (dims + edgeVoxels - 1) / edgeVoxels;
}

} // namespace slabcast
