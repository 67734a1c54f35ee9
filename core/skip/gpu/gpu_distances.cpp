#include "core/skip/gpu/gpu_distances.h"

#include <algorithm>
#include <array>

#include "core/skip/gpu/gpu_pyramid.h"

namespace slabcast {

namespace {

constexpr std::int64_t kScratchBytes = 16 << 20;

/// What a pass over texels of bytes reads and writes.
struct BytePass {
    const gl::Texture& from;
    const gl::Texture& to;
};

Result<void> run(BuildPrograms& programs, const BuildPass& pass, const BytePass& textures,
                 glm::ivec3 blocks, glm::ivec3 texels, int firstPartition = 0) {
    const Result<const gl::Program*> program = programs.use(pass);
    if (!program) {
        return tl::unexpected(program.error());
    }
    bindInput(0, GL_TEXTURE_3D, textures.from);
    bindOutput(textures.to, GL_R32UI);
    setUniform(**program, "blocks", blocks);
    setUniform(**program, "firstPartition", firstPartition);
    runPerTexel(**program, texels);
    return {};
}

/// A texture of free lengths, with what fill(texture, texels) writes to it.
template <class Fill>
Result<SkipTexture> filled(glm::ivec3 blocks, const gl::Caps& caps, Fill fill) {
    const SkipLayout layout = freeLengthLayout(blocks);
    Result<SkipTexture> counts = allocateSkip("free lengths", layout, caps);
    if (!counts) {
        return counts;
    }
    return fill(counts->texture, layout.texels).map([&] { return std::move(*counts); });
}

/// Per count the least square that gives it, by the CPU's own arithmetic; no square gives 0.
std::array<std::uint32_t, 256> countStarts(const ProximityUnits& units) {
    std::array<std::uint32_t, 256> starts{};
    for (int count = 1; count < 256; ++count) {
        std::int64_t least = 0;
        std::int64_t most = std::int64_t(ProximityUnits::kFarSquared) + 1;
        while (least < most) {
            const std::int64_t middle = (least + most) / 2;
            const bool enough = 1 + units.wholeQuanta(std::uint32_t(middle)) >= count;
            (enough ? most : least) = enough ? middle : middle + 1;
        }
        starts[count] = std::uint32_t(least);
    }
    return starts;
}

/// What both Euclidean passes are told.
Result<const gl::Program*> useEuclid(BuildPrograms& programs, const BuildPass& pass,
                                     glm::ivec3 blocks, const ProximityUnits& units, int firstRow) {
    return programs.use(pass).map([&](const gl::Program* program) {
        setUniform(*program, "blocks", blocks);
        setUniform(*program, "unitsPerBlock",
                   glm::ivec3(units.stepOfBlock[0], units.stepOfBlock[1], units.stepOfBlock[2]));
        setUniform(*program, "firstRow", firstRow);
        return program;
    });
}

struct EuclidTextures {
    const gl::Texture& alongX;
    const gl::Texture& squares;
    const gl::Texture& countStarts;
    const gl::Texture& counts;
};

/// Rows [firstRow, firstRow + texels.y) of the last two axes.
Result<void> finishRows(BuildPrograms& programs, const EuclidTextures& textures, glm::ivec3 blocks,
                        const ProximityUnits& units, int firstRow, glm::ivec3 texels) {
    const auto y = useEuclid(programs, euclidYPass(), blocks, units, firstRow);
    if (!y) {
        return tl::unexpected(y.error());
    }
    bindInput(0, GL_TEXTURE_3D, textures.alongX);
    bindOutput(textures.squares, GL_RGBA32UI);
    runPerTexel(**y, texels);
    const auto z = useEuclid(programs, euclidZPass(), blocks, units, firstRow);
    if (!z) {
        return tl::unexpected(z.error());
    }
    bindInput(0, GL_TEXTURE_3D, textures.squares);
    bindInput(1, GL_TEXTURE_2D, textures.countStarts);
    bindInput(2, GL_TEXTURE_3D, textures.alongX);
    bindOutput(textures.counts, GL_R32UI);
    runPerTexel(**z, texels);
    return {};
}

} // namespace

Result<SkipTexture> blocksFromMarks(BuildPrograms& programs, const gl::Caps& caps,
                                    const SkipTexture& marks, glm::ivec3 blocks) {
    return filled(blocks, caps, [&](const gl::Texture& counts, glm::ivec3 texels) {
        return run(programs, blocksPass(), {marks.texture, counts}, blocks, texels);
    });
}

Result<SkipTexture> chebyshevFromMarks(BuildPrograms& programs, const gl::Caps& caps,
                                       SkipTexture marks, glm::ivec3 blocks) {
    return filled(blocks, caps, [&](const gl::Texture& counts, glm::ivec3 texels) {
        // There and back and there again.
        const BytePass there{marks.texture, counts};
        const BytePass back{counts, marks.texture};
        return run(programs, alongXPass(false), there, blocks, texels)
            .and_then([&] { return run(programs, chebyshevPass(1, false), back, blocks, texels); })
            .and_then(
                [&] { return run(programs, chebyshevPass(2, false), there, blocks, texels); });
    });
}

Result<SkipTexture> proximityFromMarks(BuildPrograms& programs, const gl::Caps& caps,
                                       const SkipTexture& marks, glm::ivec3 blocks,
                                       const ProximityUnits& units, const gl::Buffer& found) {
    const SkipLayout layout = freeLengthLayout(blocks);
    // Squares take 16 bytes for four blocks: as many rows at a time as fit the scratch.
    SkipLayout wide = layout;
    wide.bits = 128;
    const std::int64_t rowBytes = std::int64_t(wide.texels.x) * wide.texels.z * 16;
    wide.texels.y = int(std::clamp<std::int64_t>(kScratchBytes / rowBytes, 1, layout.texels.y));
    Result<SkipTexture> squares = allocateSkip("squared lengths", wide, caps);
    Result<SkipTexture> alongX = allocateSkip("lengths along x", layout, caps);
    Result<SkipTexture> counts = allocateSkip("free lengths", layout, caps);
    const std::array starts = countStarts(units);
    const Result<gl::Texture> startTexture =
        upload2d("count starts", {GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, GL_NEAREST, 4},
                 {int(starts.size()), 1}, starts.data());
    for (const Result<SkipTexture>* part : {&squares, &alongX, &counts}) {
        if (!*part) {
            return tl::unexpected(part->error());
        }
    }
    if (!startTexture) {
        return tl::unexpected(startTexture.error());
    }
    Result<void> done =
        run(programs, alongXPass(false), {marks.texture, alongX->texture}, blocks, layout.texels);
    gl::BindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, found.id());
    const EuclidTextures textures{alongX->texture, squares->texture, *startTexture,
                                  counts->texture};
    for (int row = 0; row < layout.texels.y && done; row += wide.texels.y) {
        const int rows = std::min(wide.texels.y, layout.texels.y - row);
        done = finishRows(programs, textures, blocks, units, row,
                          {layout.texels.x, rows, layout.texels.z});
    }
    return done.map([&] { return std::move(*counts); });
}

Result<void> chebyshevOfPartitions(BuildPrograms& programs, const gl::Caps& caps,
                                   const SkipTexture& ranges, glm::ivec3 blocks, int count,
                                   const gl::Buffer& maps) {
    const SkipLayout map = freeLengthLayout(blocks);
    // Several partitions' grids above each other, for fewer and larger passes.
    const std::int64_t most =
        std::min(kScratchBytes / map.bytes(), caps.maxTexture3DSize / blocks.z);
    const int together = int(std::clamp<std::int64_t>(most, 1, count));
    SkipLayout stacked = map;
    stacked.texels.z *= together;
    const Result<SkipTexture> alongX = allocateSkip("lengths along x", stacked, caps);
    const Result<SkipTexture> inPlane = allocateSkip("lengths in the plane", stacked, caps);
    if (!alongX || !inPlane) {
        return tl::unexpected(alongX ? inPlane.error() : alongX.error());
    }
    for (int first = 0; first < count; first += together) {
        glm::ivec3 texels = map.texels;
        texels.z *= std::min(together, count - first);
        Result<void> done = run(programs, alongXPass(true), {ranges.texture, alongX->texture},
                                blocks, texels, first)
                                .and_then([&] {
                                    return run(programs, chebyshevPass(1, false),
                                               {alongX->texture, inPlane->texture}, blocks, texels);
                                });
        const Result<const gl::Program*> last = programs.use(chebyshevPass(2, true));
        if (!done || !last) {
            return done ? tl::unexpected(last.error()) : done;
        }
        bindInput(0, GL_TEXTURE_3D, inPlane->texture);
        gl::BindBufferBase(GL_SHADER_STORAGE_BUFFER, 1, maps.id());
        setUniform(**last, "blocks", blocks);
        setUniform(**last, "firstWord", int(first * map.bytes() / 4));
        runPerTexel(**last, texels);
    }
    return {};
}

} // namespace slabcast
