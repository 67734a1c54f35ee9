#include "core/skip/gpu/gpu_pyramid.h"

#include <algorithm>
#include <bit>

#include "core/skip/skip_structure.h"

namespace slabcast {

namespace {

constexpr TexelLayout kWordTable = {GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, GL_NEAREST, 4};
constexpr TexelLayout kFloatTable = {GL_R32F, GL_RED, GL_FLOAT, GL_NEAREST, 4};

/// Entries by code, 256 to a row.
template <class Value>
Result<gl::Texture> uploadByCode(const char* label, const TexelLayout& layout,
                                 const std::vector<Value>& values) {
    constexpr int kRow = 256;
    return upload2d(label, layout, {kRow, int(values.size()) / kRow}, values.data());
}

void setLevel(const gl::Program& program, const char* texels, const char* address,
              const SkipLevel& level) {
    setUniform(program, texels, level.texels);
    const glm::ivec4 a = level.address();
    gl::Uniform4i(program.uniform(address), a.x, a.y, a.z, a.w);
}

/// Writes the first level of `nodes`. Contract: leaves of at most a tile.
Result<void> writeLeaves(BuildPrograms& programs, const GpuVoxels& voxels, const RangeTable& table,
                         const PyramidDesc& desc, const gl::Texture& nodes,
                         const gl::Buffer& found) {
    const SkipLayout& layout = desc.layout;
    gl::Texture ranges;
    if (!table.words.empty()) {
        Result<gl::Texture> uploaded = uploadByCode("ranges of codes", kWordTable, table.words);
        if (!uploaded) {
            return tl::unexpected(uploaded.error());
        }
        ranges = std::move(*uploaded);
    }
    const Result<const gl::Program*> program = programs.use(
        leavesPass(voxels.coding, desc.content, table.words.empty(), desc.edgeVoxels, layout.bits));
    if (!program) {
        return tl::unexpected(program.error());
    }
    bindInput(0, GL_TEXTURE_3D, gl::Texture::borrow(voxels.texture));
    bindInput(1, GL_TEXTURE_2D, ranges);
    bindInput(2, GL_TEXTURE_2D, voxels.codeStarts);
    bindOutput(nodes, texelLayoutOf(layout).internalFormat);
    gl::BindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, found.id());
    gl::Uniform2f((*program)->uniform("codeEstimate"), voxels.leastFloat, voxels.codesPerFloat);
    setUniform(**program, "dims", voxels.dims);
    setUniform(**program, "leaves", blocksOf(voxels.dims, desc.edgeVoxels));
    setLevel(**program, "texels", "address", layout.levels.front());
    const int leaves = kTileVoxels / desc.edgeVoxels;
    const glm::ivec3 texelsPerGroup(std::max(1, leaves / layout.perTexel), leaves, leaves);
    runGroups((layout.levels.front().texels + texelsPerGroup - 1) / texelsPerGroup);
    return {};
}

/// A level, and the texture that it lies in.
struct PlacedLevel {
    const gl::Texture& texture;
    const SkipLevel& level;
};

/// Joins a level's nodes to those of the level above.
Result<void> writeParents(BuildPrograms& programs, NodeContent content, const SkipLayout& layout,
                          const PlacedLevel& children, const PlacedLevel& nodes) {
    const Result<const gl::Program*> program = programs.use(parentsPass(content, layout.bits));
    if (!program) {
        return tl::unexpected(program.error());
    }
    bindInput(0, GL_TEXTURE_3D, children.texture);
    bindOutput(nodes.texture, texelLayoutOf(layout).internalFormat);
    setLevel(**program, "childTexels", "childAddress", children.level);
    setLevel(**program, "texels", "address", nodes.level);
    runPerTexel(**program, nodes.level.texels);
    return {};
}

/// The levels above the first one.
Result<void> writeLevels(BuildPrograms& programs, const PyramidDesc& desc,
                         const gl::Texture& nodes) {
    const std::vector<SkipLevel>& levels = desc.layout.levels;
    Result<void> done;
    for (std::size_t i = 1; i < levels.size() && done; ++i) {
        done = writeParents(programs, desc.content, desc.layout, {nodes, levels[i - 1]},
                            {nodes, levels[i]});
    }
    return done;
}

/// Leaves that several tiles make up: a pyramid of its own below them, whose next level would be
/// the first of `nodes`.
Result<void> joinLeaves(BuildPrograms& programs, const gl::Caps& caps, const GpuVoxels& voxels,
                        const RangeTable& table, const PyramidDesc& desc, const gl::Texture& nodes,
                        const gl::Buffer& found) {
    const int below = std::countr_zero(unsigned(desc.edgeVoxels / kTileVoxels));
    const PyramidDesc fine{
        desc.content, kTileVoxels,
        octreeLayout(blocksOf(voxels.dims, kTileVoxels), below, desc.layout.bits)};
    const Result<SkipTexture> leaves = allocateSkip("leaves", fine.layout, caps);
    if (!leaves) {
        return tl::unexpected(leaves.error());
    }
    return writeLeaves(programs, voxels, table, fine, leaves->texture, found)
        .and_then([&] { return writeLevels(programs, fine, leaves->texture); })
        .and_then([&] {
            return writeParents(programs, desc.content, desc.layout,
                                {leaves->texture, fine.layout.levels.back()},
                                {nodes, desc.layout.levels.front()});
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
    Result<SkipTexture> nodes = allocateSkip("skip nodes", desc.layout, caps);
    if (!nodes) {
        return nodes;
    }
    const Result<void> leaves =
        desc.edgeVoxels <= kTileVoxels
            ? writeLeaves(programs, voxels, table, desc, nodes->texture, found)
            : joinLeaves(programs, caps, voxels, table, desc, nodes->texture, found);
    return leaves.and_then([&] { return writeLevels(programs, desc, nodes->texture); }).map([&] {
        return std::move(*nodes);
    });
}

} // namespace slabcast
