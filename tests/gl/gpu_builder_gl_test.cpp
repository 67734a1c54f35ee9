#include "core/gl/state_guard.h"
#include "core/scene/volume_texture.h"
#include "core/skip/gpu/gpu_builder.h"

#include <cmath>
#include <cstring>
#include <memory>
#include <random>
#include <string>

#include "core/skip/bitfield_octree.h"
#include "core/skip/blocks.h"
#include "core/skip/boolean_octree.h"
#include "core/skip/chebyshev.h"
#include "core/skip/gpu/gpu_download.h"
#include "core/skip/minmax_octree.h"
#include "core/skip/partitioned_maps.h"
#include "core/skip/proximity_cloud.h"
#include "core/volume/phantoms.h"
#include "tests/support/formula_volume.h"
#include "tests/support/gl_fixture.h"

namespace slabcast {
namespace {

using Random = std::mt19937;

int between(Random& random, int least, int most) {
    return std::uniform_int_distribution<int>(least, most)(random);
}

/// A volume on the host and on the GPU, and what a TF shows of it.
struct BuildScene {
    VolumeGeometry geometry;
    Texels texels;
    TexelCodes codes;
    CellVisibility visibility;
    gl::Texture texture;
    GpuVoxels voxels;
};

/// Runs of the table that are visible, anywhere in the data's range, and gaps between them.
TransferTable randomTable(Random& random, const VolumeStatistics& statistics) {
    const int size = between(random, 2, 600);
    TransferTable table{statistics.min, std::max(statistics.max, statistics.min + 1e-3),
                        std::vector<glm::vec4>(size, glm::vec4(0.0F))};
    for (int run = between(random, 0, 2); run > 0; --run) {
        const int first = between(random, 0, size - 1);
        const int last = std::min(size - 1, first + between(random, 0, 1 + size / 8));
        std::fill(table.texels.begin() + first, table.texels.begin() + last + 1, glm::vec4(0.5F));
    }
    return table;
}

/// A few voxels, rods and plates in a slowly changing ground: free lengths of all kinds.
Volume randomVolume(Random& random, glm::ivec3 dims) {
    VolumeGeometry geometry{.dims = dims};
    const double ground = between(random, -1000, 1000);
    const double slope = between(random, 0, 3) * 0.37;
    Volume volume = test::volumeOf<float>(geometry, VoxelType::F32, [&](glm::ivec3 v) {
        return ground + slope * (v.x + 2 * v.y - v.z);
    });
    auto* values = reinterpret_cast<float*>(volume.voxels.data());
    for (int i = between(random, 0, 4); i > 0; --i) {
        const glm::ivec3 first(between(random, 0, dims.x - 1), between(random, 0, dims.y - 1),
                               between(random, 0, dims.z - 1));
        const glm::ivec3 size(between(random, 1, 3), between(random, 1, 3), between(random, 1, 12));
        const auto value = float(between(random, -2000, 2000) + 0.123);
        for (int z = first.z; z < std::min(dims.z, first.z + size.z); ++z) {
            for (int y = first.y; y < std::min(dims.y, first.y + size.y); ++y) {
                for (int x = first.x; x < std::min(dims.x, first.x + size.x); ++x) {
                    values[(std::int64_t(z) * dims.y + y) * dims.x + x] = value;
                }
            }
        }
    }
    return volume;
}

glm::ivec3 randomDims(Random& random) {
    glm::ivec3 dims(between(random, 1, 37), between(random, 1, 37), between(random, 1, 37));
    if (between(random, 0, 3) == 0) {
        dims[between(random, 0, 2)] = 1;
    }
    return dims;
}

class GpuBuilderGl : public GlTest {
protected:
    void SetUp() override {
        GlTest::SetUp();
        if (builder_ == nullptr) {
            Result<GpuSkipBuilder> created = GpuSkipBuilder::create(caps());
            ASSERT_TRUE(created.has_value()) << created.error().detail;
            builder_ = new GpuSkipBuilder(std::move(*created));
        }
    }

    static GpuSkipBuilder& builder() { return *builder_; }

    std::unique_ptr<BuildScene> sceneOf(Texels texels) const {
        auto scene = std::make_unique<BuildScene>();
        scene->geometry.dims = texels.dims;
        scene->texels = std::move(texels);
        scene->codes = encodeCodes(scene->texels);
        const gl::StateGuard guard; // what uploads bind is their caller's to restore
        scene->texture = uploadTexels(scene->texels, caps()).value();
        scene->voxels = gpuVoxels(scene->texture.id(), scene->texels.format, scene->codes).value();
        return scene;
    }

    std::unique_ptr<BuildScene> sceneOf(const Volume& volume, TexelFormat format,
                                        Random& random) const {
        const VolumeStatistics statistics = computeStatistics(volume);
        auto scene = sceneOf(encodeTexels(volume, statistics, format));
        scene->geometry = volume.geometry;
        scene->visibility =
            cellVisibility(scene->codes, scene->texels, randomTable(random, statistics), 0.0);
        return scene;
    }

    std::unique_ptr<BuildScene> randomScene(unsigned seed, TexelFormat format) const {
        Random random(seed);
        return sceneOf(randomVolume(random, randomDims(random)), format, random);
    }

    std::vector<TexelFormat> formats() const {
        std::vector<TexelFormat> all = {TexelFormat::R8, TexelFormat::R16F, TexelFormat::Rg8Exact,
                                        TexelFormat::R32fExact};
        if (caps().norm16) {
            all.push_back(TexelFormat::R16);
        }
        return all;
    }

    /// Formats in turn. Every format with every edge would be a program each, which take longer to
    /// compile than to run.
    TexelFormat formatOf(unsigned test) const {
        const std::vector<TexelFormat> all = formats();
        return all[(test + test / 4) % all.size()];
    }

    /// All texels of all levels, with what fills up their rows.
    void expectSameTexels(const SkipTexture& built, const SkipTexture& uploaded,
                          const SkipLayout& layout) {
        const SkipLevel& last = layout.levels.back();
        const std::int64_t used =
            last.first + std::int64_t(last.texels.x) * last.texels.y * last.texels.z;
        const auto words = [&](const SkipTexture& texture) {
            std::vector<std::uint32_t> all = downloadTexels(texture, layout).value();
            EXPECT_GE(std::int64_t(all.size()), used * layout.wordsPerTexel());
            all.resize(used * layout.wordsPerTexel());
            return all;
        };
        EXPECT_EQ(words(built), words(uploaded));
    }

    /// What the GPU has built is what an upload of the CPU's makes.
    void expectSame(const Result<SkipTexture>& built, const FreeLengths& expected) {
        ASSERT_TRUE(built.has_value()) << built.error().detail;
        const SkipTexture uploaded = [&] {
            const gl::StateGuard guard;
            return uploadFreeLengths(expected, caps()).value();
        }();
        EXPECT_EQ(built->bytes, uploaded.bytes);
        EXPECT_EQ(gpuBytes(expected), uploaded.bytes);
        for (const SkipTexture* texture : {&uploaded, &*built}) {
            EXPECT_EQ(downloadFreeLengths(*texture, expected.blocks, expected.blockEdgeVoxels,
                                          expected.quantumMm)
                          .value(),
                      expected);
        }
        expectSameTexels(*built, uploaded, freeLengthLayout(expected.blocks));
    }

    void expectSame(const Result<SkipTexture>& built, const Octree& expected) {
        ASSERT_TRUE(built.has_value()) << built.error().detail;
        const SkipTexture uploaded = [&] {
            const gl::StateGuard guard;
            return uploadOctree(expected, caps()).value();
        }();
        EXPECT_EQ(built->bytes, uploaded.bytes);
        EXPECT_EQ(gpuBytes(expected), uploaded.bytes);
        const int levels = int(expected.levels.size());
        const glm::ivec3 leaves = expected.levels.front().nodes;
        for (const SkipTexture* texture : {&uploaded, &*built}) {
            EXPECT_EQ(downloadOctree(*texture, expected.content, expected.bitsPerNode,
                                     expected.leafEdgeVoxels, leaves, levels)
                          .value(),
                      expected);
        }
        expectSameTexels(*built, uploaded, octreeLayout(leaves, levels, expected.bitsPerNode));
    }

    void checkFreeLengths(const BuildScene& s, SkipStructure structure, int edge) {
        SCOPED_TRACE(std::string(name(structure)) + " of edge " + std::to_string(edge));
        const Result<FreeLengths> expected =
            structure == SkipStructure::Blocks ? buildBlocks(s.visibility, edge)
            : structure == SkipStructure::Chebyshev
                ? buildChebyshev(s.visibility, edge)
                : buildProximityCloud(s.visibility, s.geometry, edge);
        expectSame(builder().freeLengths(s.voxels, s.visibility, s.geometry,
                                         {.structure = structure, .blockEdgeVoxels = edge}),
                   expected.value());
    }

    void checkOctree(const BuildScene& s, SkipStructure structure, int edge, int bits,
                     int initialLevel) {
        SCOPED_TRACE(std::string(name(structure)) + " of edge " + std::to_string(edge) + ", " +
                     std::to_string(bits) + " bits");
        const SkipOptions options{.structure = structure,
                                  .blockEdgeVoxels = edge,
                                  .bits = bits,
                                  .initialLevel = initialLevel};
        if (structure == SkipStructure::BooleanOctree) {
            expectSame(builder().booleanOctree(s.voxels, s.visibility, options),
                       buildBooleanOctree(s.visibility, options).value());
        } else if (structure == SkipStructure::MinMaxOctree) {
            expectSame(builder().minMaxOctree(s.voxels, options),
                       buildMinMaxOctree(s.codes, options).value());
        } else {
            const ValueBins bins = valueBins(s.codes, codeRange(s.codes), bits, edge == 4);
            expectSame(builder().bitfieldOctree(s.voxels, bins, options),
                       buildBitfieldOctree(s.codes, bins, options).value().octree);
        }
    }

    void checkPartitions(const BuildScene& s, int edge, int count, bool separateMinimum) {
        SCOPED_TRACE(std::to_string(count) + " partitions of edge " + std::to_string(edge));
        const SkipOptions options{
            .structure = SkipStructure::Partitioned, .blockEdgeVoxels = edge, .partitions = count};
        const ValueBins bins = valueBins(s.codes, codeRange(s.codes), count, separateMinimum);
        const PartitionedMaps expected = buildPartitionedMaps(s.codes, bins, options).value();
        const Result<GpuPartitions> built = builder().partitions(s.voxels, bins, options);
        ASSERT_TRUE(built.has_value()) << built.error().detail;
        EXPECT_EQ(built->bytes, partitionBytes(s.texels.dims, options));
        EXPECT_EQ(downloadDistances(*built).value(), expected.distances);
        SkipTexture into;
        const auto setOf = [](int first, int end) {
            BinSet set{};
            for (int p = first; p < end; ++p) {
                set[p / 32] |= 1U << (p % 32);
            }
            return set;
        };
        for (const BinSet& set : {visibleBins(bins, s.visibility), BinSet{}, setOf(0, count),
                                  setOf(0, 1), setOf(count / 2, count), setOf(count - 1, count)}) {
            const Result<void> done = builder().merge(*built, set, into);
            ASSERT_TRUE(done.has_value()) << done.error().detail;
            EXPECT_EQ(downloadFreeLengths(into, expected.blocks, edge).value(),
                      merged(expected, set));
        }
    }

private:
    // One for all tests, for its programs, and to the end of the process, as the context.
    inline static GpuSkipBuilder* builder_ = nullptr;
};

TEST_F(GpuBuilderGl, FreeLengthsAreTheCpus) {
    for (unsigned seed = 0; seed < 8; ++seed) {
        const int edge = 1 << (seed % 4);
        const auto scene = randomScene(seed, formatOf(seed));
        SCOPED_TRACE(std::string(name(scene->texels.format)) + ", seed " + std::to_string(seed));
        for (const SkipStructure structure :
             {SkipStructure::Blocks, SkipStructure::Chebyshev, SkipStructure::Proximity}) {
            checkFreeLengths(*scene, structure, edge);
        }
        if (edge == 8) { // of which longer ones are made
            checkFreeLengths(*scene, SkipStructure::Blocks, 16);
            checkFreeLengths(*scene, SkipStructure::Blocks, 32);
        }
    }
}

TEST_F(GpuBuilderGl, OctreesAreTheCpus) {
    unsigned seed = 100;
    for (const SkipStructure structure : {SkipStructure::BooleanOctree, SkipStructure::MinMaxOctree,
                                          SkipStructure::BitfieldOctree}) {
        for (const int edge : infoOf(structure).edges) {
            ++seed;
            const auto scene = randomScene(seed, formatOf(seed));
            SCOPED_TRACE(std::string(name(scene->texels.format)) + ", seed " +
                         std::to_string(seed));
            const int bits = structure == SkipStructure::BooleanOctree ? 8 : 32;
            checkOctree(*scene, structure, edge, bits, edge == 4);
        }
    }
}

// Odd at every level, flat, and thin along each axis: where levels end is where they are joined.
TEST_F(GpuBuilderGl, OctreesOfOddAndFlatVolumesAreTheCpus) {
    Random random(17);
    for (const glm::ivec3 dims :
         {glm::ivec3(66, 65, 67), {131, 130, 5}, {1, 129, 33}, {260, 3, 2}}) {
        SCOPED_TRACE(dims.x);
        const auto scene = sceneOf(randomVolume(random, dims), TexelFormat::R8, random);
        for (const int bits : {8, 32, 128}) {
            checkOctree(*scene, SkipStructure::BitfieldOctree, 2, bits, 0);
        }
        checkOctree(*scene, SkipStructure::BooleanOctree, 16, 8, 0);
        checkOctree(*scene, SkipStructure::MinMaxOctree, 4, 32, 0);
    }
}

TEST_F(GpuBuilderGl, BitfieldsOfEveryWidthAreTheCpus) {
    struct Case {
        int bits;
        int edge; // such that a texel's nodes are of one tile or of several
    };
    unsigned seed = 200;
    for (const auto& [bits, edge] :
         {Case{8, 2}, {8, 8}, {16, 4}, {16, 8}, {32, 4}, {64, 2}, {64, 16}, {128, 4}, {128, 64}}) {
        const auto scene = randomScene(++seed, TexelFormat::R16F);
        SCOPED_TRACE("seed " + std::to_string(seed));
        checkOctree(*scene, SkipStructure::BitfieldOctree, edge, bits, 0);
    }
}

TEST_F(GpuBuilderGl, PartitionsAndTheirMergersAreTheCpus) {
    unsigned seed = 300;
    for (const int count : {16, 32, 64, 128, 256}) {
        ++seed;
        const int edge = 1 << (seed % 4);
        const auto scene = randomScene(seed, seed % 2 == 0 ? TexelFormat::R8 : TexelFormat::R16F);
        SCOPED_TRACE("seed " + std::to_string(seed));
        checkPartitions(*scene, edge, count, seed % 3 == 0);
    }
}

TEST_F(GpuBuilderGl, LongLinesReachAllCounts) {
    Random random(7);
    for (const glm::ivec3 dims : {glm::ivec3(700, 2, 3), {3, 700, 1}, {2, 1, 700}}) {
        SCOPED_TRACE(dims.x);
        Volume volume = randomVolume(random, dims);
        auto* values = reinterpret_cast<float*>(volume.voxels.data());
        std::fill(values, values + volume.geometry.voxelCount(), 0.0F);
        values[300 * dims.x * dims.y * dims.z / 700] = 1000.0F;
        auto scene = sceneOf(volume, TexelFormat::R8, random);
        TransferTable table{0.0, 1000.0, std::vector<glm::vec4>(256, glm::vec4(0.0F))};
        table.texels.back().a = 1.0F;
        scene->visibility = cellVisibility(scene->codes, scene->texels, table, 0.0);
        for (const SkipStructure structure : {SkipStructure::Chebyshev, SkipStructure::Proximity}) {
            checkFreeLengths(*scene, structure, 1);
            checkFreeLengths(*scene, structure, 2);
        }
        checkPartitions(*scene, 1, 16, true);
    }
}

TEST_F(GpuBuilderGl, ProximityFollowsSpacingAndShear) {
    Random random(11);
    for (int i = 0; i < 12; ++i) {
        SCOPED_TRACE(i);
        const auto scene = randomScene(400 + i, TexelFormat::R8);
        const auto spacing = [&] { return between(random, 1, 500) / 97.0; };
        scene->geometry.spacingMm = {spacing(), spacing(), spacing()};
        const auto tilt = [&] { return between(random, -70, 70) / 100.0; };
        scene->geometry.direction[1] = glm::normalize(glm::dvec3(tilt(), 1.0, 0.0));
        scene->geometry.direction[2] = glm::normalize(glm::dvec3(tilt(), tilt(), 1.0));
        checkFreeLengths(*scene, SkipStructure::Proximity, 1 << (i % 4));
    }
}

TEST_F(GpuBuilderGl, CodesOfPreclassifiedTexelsAreTheirAlpha) {
    Random random(13);
    const glm::ivec3 dims(21, 18, 9);
    std::vector<glm::u8vec4> texels(std::size_t(dims.x) * dims.y * dims.z,
                                    glm::u8vec4(255, 9, 7, 0));
    texels[777].a = 1;
    texels[2222].a = 255;
    TexelCodes codes{.dims = dims};
    for (const glm::u8vec4& texel : texels) {
        codes.codes.push_back(texel.a);
    }
    const gl::Texture texture = uploadClassified(texels.data(), dims, caps()).value();
    const CellVisibility visibility = cellVisibilityOfAlpha(codes);
    const Result<SkipTexture> built =
        builder().freeLengths(gpuVoxelsOfAlpha(texture.id(), dims), visibility, {.dims = dims},
                              {.structure = SkipStructure::Chebyshev, .blockEdgeVoxels = 2});
    expectSame(built, buildChebyshev(visibility, 2).value());
}

/// Texels in the order of their values, row by row: each is the least of some leaf of one voxel.
Texels ascending(TexelFormat format, const std::function<double(double)>& floatAt) {
    constexpr int kEdge = 256;
    constexpr int kLeastHalf = 0x0400; // codes of the finite halfs
    constexpr int kMostHalf = 0xfbff;
    Texels texels{.format = format, .dims = {kEdge, kEdge, 1}};
    texels.data.resize(bytesPerTexel(format) * kEdge * kEdge);
    for (int i = 0; i < kEdge * kEdge; ++i) {
        const int code = std::clamp(i, kLeastHalf, kMostHalf);
        const auto half = std::uint16_t((code & 0x8000) != 0 ? code & 0x7fff : ~code);
        const auto high = std::uint8_t(i >> 8);
        const std::uint8_t highLow[] = {high, std::uint8_t(i & 255)};
        const auto whole = std::uint16_t(i);
        const auto number = float(floatAt(i / 65535.0));
        const void* const texelOf[] = {&high, &whole, &half, highLow, &number};
        std::memcpy(texels.data.data() + i * bytesPerTexel(format), texelOf[int(format)],
                    bytesPerTexel(format));
    }
    return texels;
}

TEST_F(GpuBuilderGl, EveryCodeIsRead) {
    for (const TexelFormat format : formats()) {
        SCOPED_TRACE(name(format));
        const auto scene = sceneOf(ascending(format, [](double u) { return 7.0 * u - 2.0; }));
        checkOctree(*scene, SkipStructure::MinMaxOctree, 1, 32, 8); // leaves alone
    }
}

TEST_F(GpuBuilderGl, FloatCodesAreThoseOfAwkwardRanges) {
    const std::array<double, 2> ranges[] = {{1e6, 1e6 + 2.0},  {-3e-15, 2e-15}, {-1e37, 3e37},
                                            {5.0, 5.0},        {0.0, 1e-3},     {-1.0, 1.0 / 3.0},
                                            {-16777216.0, 0.3}};
    for (const auto& range : ranges) {
        SCOPED_TRACE(range[0]);
        const auto scene = sceneOf(ascending(
            TexelFormat::R32fExact, [&](double u) { return std::lerp(range[0], range[1], u); }));
        checkOctree(*scene, SkipStructure::MinMaxOctree, 1, 32, 8); // leaves alone
    }
}

TEST_F(GpuBuilderGl, PhantomIsTheCpus) {
    Random random(23);
    const Volume volume = makePhantom("phantom:vessels:64").value();
    const auto scene = sceneOf(volume, TexelFormat::R8, random);
    for (const SkipStructure structure : {SkipStructure::Chebyshev, SkipStructure::Proximity}) {
        checkFreeLengths(*scene, structure, 2);
    }
    checkOctree(*scene, SkipStructure::BitfieldOctree, 4, 32, 2);
    checkPartitions(*scene, 4, 16, true);
}

TEST_F(GpuBuilderGl, LeavesTheStateAsItWas) {
    const auto scene = randomScene(600, TexelFormat::R8);
    const gl::Texture host = gl::Texture::make("host", GL_TEXTURE_3D);
    const gl::Buffer buffer = gl::Buffer::make("host");
    gl::ActiveTexture(GL_TEXTURE1);
    gl::BindTexture(GL_TEXTURE_3D, host.id());
    gl::BindBuffer(GL_SHADER_STORAGE_BUFFER, buffer.id());
    gl::UseProgram(0);
    checkFreeLengths(*scene, SkipStructure::Proximity, 4);
    checkPartitions(*scene, 4, 16, false);
    const auto integer = [](GLenum name) {
        GLint value = -1;
        gl::GetIntegerv(name, &value);
        return value;
    };
    EXPECT_EQ(integer(GL_ACTIVE_TEXTURE), GL_TEXTURE1);
    EXPECT_EQ(integer(GL_TEXTURE_BINDING_3D), GLint(host.id()));
    EXPECT_EQ(integer(GL_SHADER_STORAGE_BUFFER_BINDING), GLint(buffer.id()));
    EXPECT_EQ(integer(GL_CURRENT_PROGRAM), 0);
    EXPECT_EQ(integer(GL_READ_FRAMEBUFFER_BINDING), 0);
    GLint image = -1;
    gl::GetIntegeri_v(GL_IMAGE_BINDING_NAME, 0, &image);
    EXPECT_EQ(image, 0);
    gl::BindTexture(GL_TEXTURE_3D, 0);
    gl::BindBuffer(GL_SHADER_STORAGE_BUFFER, 0);
    gl::ActiveTexture(GL_TEXTURE0);
}

// In place of what the texture held before, slice by slice.
TEST_F(GpuBuilderGl, FreeLengthsAreUploadedInSeveralGoes) {
    Random random(29);
    const auto randomLengths = [&] {
        FreeLengths lengths{.blocks = {9, 5, 7}};
        for (int i = 0; i < 9 * 5 * 7; ++i) {
            lengths.counts.push_back(std::uint8_t(between(random, 0, 255)));
        }
        lengths.occupiedBlocks = std::count(lengths.counts.begin(), lengths.counts.end(), 0);
        return lengths;
    };
    const SkipTexture texture = uploadFreeLengths(randomLengths(), caps()).value();
    const FreeLengths other = randomLengths();
    EXPECT_EQ(slicesWithin(3 * 5 * 4 * 3 - 1, other.blocks), 2); // of 3 x 5 texels
    for (const auto& [begin, end] : {std::pair(0, 3), {3, 4}, {4, 7}}) {
        ASSERT_TRUE(uploadSlices(texture, other, begin, end).has_value());
    }
    EXPECT_EQ(downloadFreeLengths(texture, other.blocks, other.blockEdgeVoxels).value(), other);
}

TEST_F(GpuBuilderGl, RefusesWhatDoesNotFit) {
    const auto scene = randomScene(500, TexelFormat::R8);
    const ValueBins bins = valueBins(scene->codes, codeRange(scene->codes), 16, false);
    const Result<GpuPartitions> over =
        builder().partitions(scene->voxels, bins,
                             {.structure = SkipStructure::Partitioned,
                              .blockEdgeVoxels = 1,
                              .partitions = 16,
                              .memoryBudgetBytes = 15});
    ASSERT_FALSE(over.has_value());
    EXPECT_EQ(over.error().code, ErrorCode::VolumeTooLarge);
    EXPECT_NE(over.error().detail.find(std::to_string(
                  partitionBytes(scene->texels.dims, {.blockEdgeVoxels = 1, .partitions = 16}))),
              std::string::npos)
        << over.error().detail;
    EXPECT_NE(over.error().detail.find("larger budget"), std::string::npos);
    gl::Caps narrow = caps();
    narrow.maxStorageBlockBytes = 15;
    const Result<GpuPartitions> beyond = GpuSkipBuilder::create(narrow)->partitions(
        scene->voxels, bins,
        {.structure = SkipStructure::Partitioned, .blockEdgeVoxels = 1, .partitions = 16});
    ASSERT_FALSE(beyond.has_value());
    EXPECT_NE(beyond.error().detail.find("storage block"), std::string::npos);
    EXPECT_EQ(beyond.error().detail.find("budget"), std::string::npos);
    narrow.maxTexture3DSize = 1;
    EXPECT_EQ(
        uploadFreeLengths({.blocks = {9, 1, 1}, .counts = std::vector<std::uint8_t>(9)}, narrow)
            .error()
            .code,
        ErrorCode::VolumeTooLarge);
    narrow.maxComputeSharedBytes = leavesSharedBytes();
    EXPECT_TRUE(GpuSkipBuilder::create(narrow).has_value());
    --narrow.maxComputeSharedBytes;
    EXPECT_EQ(GpuSkipBuilder::create(narrow).error().code, ErrorCode::DeviceUnsupported);
}

} // namespace
} // namespace slabcast
