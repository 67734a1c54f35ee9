#include "core/skip/gpu/gpu_built_skip.h"

#include "core/base/stopwatch.h"
#include "core/skip/gpu/gpu_download.h"

namespace slabcast {

namespace {

/// A texture and what is read back from it.
struct Made {
    SkipTexture texture;
    SkipData data;
};

struct Building {
    GpuSkipBuilder& builder;
    const GpuVoxels& voxels;
    const SkipSource& source;
    const SkipOptions& options;

    Result<Made> grid() const {
        Result<SkipTexture> texture =
            builder.freeLengths(voxels, source.visibility, source.geometry, options);
        if (!texture) {
            return tl::unexpected(texture.error());
        }
        const bool euclidean = options.structure == SkipStructure::Proximity;
        Result<FreeLengths> read = downloadFreeLengths(
            *texture, blocksOf(voxels.dims, options.blockEdgeVoxels), options.blockEdgeVoxels,
            euclidean ? source.geometry.smallestVoxelEdgeMm() : 0.0);
        return std::move(read).map([&](FreeLengths lengths) {
            return Made{std::move(*texture), std::move(lengths)};
        });
    }

    Result<Made> octree(Result<SkipTexture> texture, NodeContent content, int bits) const {
        if (!texture) {
            return tl::unexpected(texture.error());
        }
        const glm::ivec3 leaves = blocksOf(voxels.dims, options.blockEdgeVoxels);
        Result<Octree> read = downloadOctree(*texture, content, bits, options.blockEdgeVoxels,
                                             leaves, keptLevels(leaves, options.initialLevel));
        return std::move(read).map([&](Octree tree) {
            return Made{std::move(*texture), std::move(tree)};
        });
    }

    Result<Made> bitfieldOctree() const {
        ValueBins bins = binsOf(source, options);
        Result<Made> made =
            octree(builder.bitfieldOctree(voxels, bins, options), NodeContent::Bits, options.bits);
        return std::move(made).map([&](Made m) {
            return Made{std::move(m.texture),
                        BitfieldOctree{std::get<Octree>(std::move(m.data)), std::move(bins)}};
        });
    }

    Result<Made> partitioned() const {
        ValueBins bins = binsOf(source, options);
        const BinSet set = visibleBins(bins, source.visibility);
        const Result<GpuPartitions> maps = builder.partitions(voxels, bins, options);
        if (!maps) {
            return tl::unexpected(maps.error());
        }
        SkipTexture texture;
        if (Result<void> merged = builder.merge(*maps, set, texture); !merged) {
            return tl::unexpected(merged.error());
        }
        Result<std::vector<std::uint8_t>> read = downloadDistances(*maps);
        return std::move(read).map([&](std::vector<std::uint8_t> distances) {
            return Made{std::move(texture),
                        PartitionedMaps{std::move(bins), maps->blocks, maps->blockEdgeVoxels,
                                        std::move(distances)}};
        });
    }

    Result<Made> make() const {
        switch (options.structure) {
        case SkipStructure::None:
            return Made{};
        case SkipStructure::Blocks:
        case SkipStructure::Proximity:
        case SkipStructure::Chebyshev:
            return grid();
        case SkipStructure::Partitioned:
            return partitioned();
        case SkipStructure::BooleanOctree:
            return octree(builder.booleanOctree(voxels, source.visibility, options),
                          NodeContent::Occupied, 8);
        case SkipStructure::MinMaxOctree:
            return octree(builder.minMaxOctree(voxels, options), NodeContent::Range, 32);
        case SkipStructure::BitfieldOctree:
            return bitfieldOctree();
        }
        contractBreach(__func__, "a skip structure", static_cast<double>(options.structure));
    }
};

} // namespace

Result<GpuBuiltSkip> buildSkipOnGpu(GpuSkipBuilder& builder, const GpuVoxels& voxels,
                                    const SkipSource& source, const SkipOptions& options) {
    if (Result<void> ok = check(options); !ok) {
        return tl::unexpected(ok.error());
    }
    const Stopwatch watch;
    Result<Made> made = Building{builder, voxels, source, options}.make();
    if (!made) {
        return tl::unexpected(made.error());
    }
    GpuBuiltSkip built{asBuilt(options, std::move(made->data), source.visibility),
                       std::move(made->texture)};
    built.skip.onGpu = true;
    built.skip.buildMs = watch.ms();
    return built;
}

} // namespace slabcast
