#include <cstring>

#include <gtest/gtest.h>

#include "core/volume/downsample.h"
#include "core/volume/resample.h"
#include "tests/support/property.h"

namespace slabcast {
namespace {

using test::anyBits;
using test::anyInt;

/// Float voxels that are affine in patient space: what a trilinear field holds exactly.
double affine(const VolumeGeometry& geometry, glm::ivec3 voxel) {
    const glm::dvec3 mm =
        geometry.originMm + geometry.direction * (geometry.spacingMm * glm::dvec3(voxel));
    return 3.0 + 0.5 * mm.x - 0.25 * mm.y + 2.0 * mm.z;
}

template <class ValueOf>
Volume floats(const VolumeGeometry& geometry, ValueOf valueOf) {
    Volume volume;
    volume.name = "made up";
    volume.unit = "HU";
    volume.modality = Modality::Ct;
    volume.type = VoxelType::F32;
    volume.geometry = geometry;
    std::vector<float> voxels;
    for (int z = 0; z < geometry.dims.z; ++z) {
        for (int y = 0; y < geometry.dims.y; ++y) {
            for (int x = 0; x < geometry.dims.x; ++x) {
                voxels.push_back(static_cast<float>(valueOf(glm::ivec3(x, y, z))));
            }
        }
    }
    volume.voxels.resize(voxels.size() * sizeof(float));
    std::memcpy(volume.voxels.data(), voxels.data(), volume.voxels.size());
    return volume;
}

VolumeGeometry oblique(glm::ivec3 dims) {
    VolumeGeometry geometry;
    geometry.dims = dims;
    geometry.spacingMm = {0.5, 1.25, 3.0};
    geometry.originMm = {-10.0, 20.0, 7.5};
    geometry.direction = glm::dmat3(glm::dvec3(0.6, 0.8, 0.0), glm::dvec3(-0.8, 0.6, 0.0),
                                    glm::dvec3(0.0, 0.0, -1.0));
    return geometry;
}

TEST(Resample, AnAffineFieldStaysItself) {
    const VolumeGeometry geometry = oblique({6, 9, 5});
    const Volume volume =
        floats(geometry, [&](glm::ivec3 voxel) { return affine(geometry, voxel); });
    for (const glm::ivec3 dims :
         {glm::ivec3(11, 17, 8), glm::ivec3(5, 7, 4), glm::ivec3(6, 9, 5)}) {
        const Volume result = resample(volume, dims).value();
        ASSERT_EQ(result.geometry.dims, dims);
        for (int z = 0; z < dims.z; ++z) {
            for (int y = 0; y < dims.y; ++y) {
                for (int x = 0; x < dims.x; ++x) {
                    // Beyond the outermost old centres the field is clamped.
                    const glm::dvec3 old =
                        (glm::dvec3(x, y, z) + 0.5) * glm::dvec3(geometry.dims) / glm::dvec3(dims) -
                        0.5;
                    const bool within =
                        glm::all(glm::greaterThanEqual(old, glm::dvec3(0.0))) &&
                        glm::all(glm::lessThanEqual(old, glm::dvec3(geometry.dims - 1)));
                    if (within) {
                        // float32 voxels of magnitude up to 64: half an ulp is 2^-19, thrice
                        // rounded
                        EXPECT_NEAR(result.valueAt({x, y, z}), affine(result.geometry, {x, y, z}),
                                    3.0 * 0x1p-19);
                    }
                }
            }
        }
    }
}

TEST(Resample, CoversTheSameBoxAndKeepsWhatIsSaidOfTheVolume) {
    const Volume volume = floats(oblique({6, 9, 5}), [](glm::ivec3) { return 1.0; });
    const Volume result = resample(volume, {13, 4, 5}).value();
    const auto corner = [](const Volume& v, glm::dvec3 uvw) {
        return glm::dvec3(v.geometry.modelFromUvw() * glm::dvec4(uvw, 1.0));
    };
    for (const glm::dvec3 uvw : {glm::dvec3(0.0), glm::dvec3(1.0), glm::dvec3(1.0, 0.0, 0.5)}) {
        EXPECT_LT(glm::distance(corner(volume, uvw), corner(result, uvw)), 1e-12);
    }
    EXPECT_EQ(result.name, volume.name);
    EXPECT_EQ(result.unit, volume.unit);
    EXPECT_EQ(result.modality, volume.modality);
    EXPECT_TRUE(validated(result).has_value());
}

TEST(Resample, StaysBetweenTheVoxelsAndRoundsToNearest) {
    Volume volume;
    volume.type = VoxelType::U8;
    volume.geometry.dims = {2, 1, 1};
    volume.voxels = {std::byte{10}, std::byte{13}};
    const Volume result = resample(volume, {4, 1, 1}).value();
    // Old centres at 0 and 1; new ones at -0.25 (clamped), 0.25, 0.75, 1.25 (clamped).
    EXPECT_EQ(result.valueAt({0, 0, 0}), 10.0);
    EXPECT_EQ(result.valueAt({1, 0, 0}), 11.0); // 10.75
    EXPECT_EQ(result.valueAt({2, 0, 0}), 12.0); // 12.25
    EXPECT_EQ(result.valueAt({3, 0, 0}), 13.0);
}

PROPERTY(Resample, WholeMultiplesAreAveragesOfAllVoxels) {
    const int factor = anyInt(2, 5);
    const glm::ivec3 dims = glm::ivec3(anyInt(1, 4), anyInt(1, 4), anyInt(1, 4));
    const unsigned seed = anyBits();
    const Volume volume = floats(oblique(dims * factor), [&](glm::ivec3 v) {
        return (seed + unsigned(v.x * 7 + v.y * 31 + v.z * 127)) * 2654435761U % 1000U;
    });
    const Volume expected = downsample(volume, glm::ivec3(factor)).value();
    PROPERTY_ASSERT(resample(volume, dims).value().voxels == expected.voxels);
}

TEST(Resample, RefusesEmptyAndOversized) {
    const Volume volume = floats(oblique({2, 2, 2}), [](glm::ivec3) { return 0.0; });
    EXPECT_EQ(resample(volume, {2, 0, 2}).error().code, ErrorCode::InvalidArgument);
    EXPECT_EQ(resample(volume, glm::ivec3(1 << 30)).error().code, ErrorCode::SizeOverflow);
}

} // namespace
} // namespace slabcast
