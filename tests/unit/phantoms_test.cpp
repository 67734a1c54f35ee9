#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include <gtest/gtest.h>

#include "core/volume/phantom_vessels.h"
#include "core/volume/phantoms.h"
#include "core/volume/statistics.h"
#include "core/volume/voxel_dispatch.h"

namespace slabcast {
namespace {

constexpr double kPi = std::numbers::pi;

Volume phantom(std::string_view spec) {
    Result<Volume> result = makePhantom(spec);
    EXPECT_TRUE(result.has_value()) << spec;
    return result.value_or(Volume{});
}

ErrorCode refusalOf(std::string_view spec) {
    const Result<Volume> result = makePhantom(spec);
    EXPECT_FALSE(result.has_value()) << spec;
    return result ? ErrorCode::Internal : result.error().code;
}

TEST(Phantoms, AllAreValidVolumesOfTheAskedSize) {
    EXPECT_EQ(phantomList().size(), 8U);
    for (const PhantomInfo& info : phantomList()) {
        EXPECT_FALSE(info.description.empty());
        const Volume volume = phantom("phantom:" + info.name + ":20x7x9");
        EXPECT_EQ(volume.geometry.dims, glm::ivec3(20, 7, 9));
        EXPECT_EQ(volume.name, info.name);
        const Result<Volume> checked = validated(volume);
        ASSERT_TRUE(checked.has_value());
        EXPECT_EQ(checked->nonFiniteVoxels, 0);
        EXPECT_TRUE(validated(phantom("phantom:" + info.name + ":1")).has_value());
    }
}

TEST(Phantoms, HaveMillimetreVoxelsAroundTheOrigin) {
    const Volume volume = phantom("phantom:constant");
    EXPECT_EQ(volume.geometry.dims, glm::ivec3(128));
    EXPECT_EQ(volume.geometry.spacingMm, glm::dvec3(1.0));
    EXPECT_LT(glm::length(volume.geometry.boundingSphere().centreMm), 1e-12);
}

TEST(Phantoms, RefuseMalformedSpecs) {
    for (const char* spec :
         {"", "sphere", "phantom:", "phantom:cube", "phantom:sphere:", "phantom:sphere:12x",
          "phantom:sphere:12x12", "phantom:sphere:-4", "phantom:sphere:4.5", "phantom:sphere:x4x4",
          "phantom:sphere:1x2x3x4", "phantom:sphere:8:8", "phantom:sphere: 8"}) {
        EXPECT_EQ(refusalOf(spec), ErrorCode::InvalidArgument) << spec;
    }
    EXPECT_EQ(refusalOf("phantom:sphere:0"), ErrorCode::EmptyVolume);
    EXPECT_EQ(refusalOf("phantom:sphere:4x0x4"), ErrorCode::EmptyVolume);
    EXPECT_EQ(refusalOf("phantom:sphere:1025"), ErrorCode::SizeOverflow);
    EXPECT_EQ(refusalOf("phantom:sphere:4294967296"), ErrorCode::SizeOverflow);
    EXPECT_EQ(refusalOf("phantom:sphere:99999999999999999999"), ErrorCode::SizeOverflow);
}

TEST(Phantoms, AnUnknownNameIsAnsweredWithAllNames) {
    const std::string detail = makePhantom("phantom:cube").error().detail;
    for (const PhantomInfo& info : phantomList()) {
        EXPECT_NE(detail.find(info.name), std::string::npos) << detail;
    }
}

TEST(Phantoms, RampIsLinearInXOnly) {
    const Volume volume = phantom("phantom:ramp:16x3x2");
    for (int x = 0; x < 16; ++x) {
        EXPECT_EQ(volume.valueAt({x, 2, 1}), (x + 0.5) / 16.0);
    }
}

TEST(Phantoms, ConstantAndCheckerboard) {
    const VolumeStatistics s = computeStatistics(phantom("phantom:constant:5"));
    EXPECT_EQ(s.min, 100.0);
    EXPECT_EQ(s.max, 100.0);
    const Volume board = phantom("phantom:checkerboard:20");
    EXPECT_EQ(board.valueAt({7, 7, 7}), 0.0);
    EXPECT_EQ(board.valueAt({8, 7, 7}), 255.0);
    EXPECT_EQ(board.valueAt({8, 8, 7}), 0.0);
    EXPECT_EQ(board.valueAt({16, 8, 0}), 255.0);
}

double ballVolume(double radius) {
    return 4.0 / 3.0 * kPi * radius * radius * radius;
}

TEST(Phantoms, SphereHasTheVolumeOfABall) {
    const Volume volume = phantom("phantom:sphere:80x64x64");
    const double radius = 0.8 * 32.0;
    const double mass = computeStatistics(volume).mean / 255.0 * 80 * 64 * 64;
    EXPECT_NEAR(mass, ballVolume(radius), 0.003 * ballVolume(radius));
    EXPECT_EQ(volume.valueAt({40, 32, 32}), 255.0);
    EXPECT_EQ(volume.valueAt({0, 32, 32}), 0.0);
}

TEST(Phantoms, ShellsNest) {
    const Volume volume = phantom("phantom:shells:128");
    const auto at = [&](double radius) { // along +x from the centre
        return volume.valueAt({static_cast<int>(64.0 + 64.0 * radius), 64, 64});
    };
    EXPECT_EQ(at(0.1), 255.0);
    EXPECT_EQ(at(0.35), 0.0);
    EXPECT_EQ(at(0.5), 170.0);
    EXPECT_EQ(at(0.65), 0.0);
    EXPECT_EQ(at(0.8), 85.0);
    EXPECT_EQ(at(0.95), 0.0);
}

TEST(Phantoms, MarschnerLobbIsThePublishedSignal) {
    const Volume volume = phantom("phantom:marschner-lobb:40");
    for (const glm::ivec3 voxel :
         {glm::ivec3(0, 0, 0), glm::ivec3(13, 27, 5), glm::ivec3(20, 19, 39)}) {
        const glm::dvec3 p = (glm::dvec3(voxel) + 0.5) / 20.0 - 1.0;
        const double r = std::sqrt(p.x * p.x + p.y * p.y);
        const double rho = std::cos(2.0 * kPi * 6.0 * std::cos(kPi * r / 2.0));
        const double expected =
            (1.0 - std::sin(kPi * p.z / 2.0) + 0.25 * (1.0 + rho)) / (2.0 * (1.0 + 0.25));
        EXPECT_NEAR(volume.valueAt(voxel), expected, 1e-7);
    }
    const VolumeStatistics s = computeStatistics(volume);
    EXPECT_GE(s.min, 0.0);
    EXPECT_LE(s.max, 1.0);
    EXPECT_GT(s.max, 0.98);
}

TEST(Phantoms, VesselsFillAFewPerCentAndStayInside) {
    const Volume volume = phantom("phantom:vessels:96");
    const glm::ivec3 dims = volume.geometry.dims;
    std::int64_t filled = 0;
    visitVoxels(volume, [&](auto voxels) {
        for (std::int64_t i = 0; i < volume.geometry.voxelCount(); ++i) {
            const glm::ivec3 at(i % dims.x, i / dims.x % dims.y, i / (dims.x * dims.y));
            const bool border =
                glm::any(glm::equal(at, glm::ivec3(0))) || glm::any(glm::equal(at, dims - 1));
            const auto value = static_cast<double>(voxels[static_cast<std::size_t>(i)]);
            EXPECT_FALSE(border && value > 0.0) << at.x << " " << at.y << " " << at.z;
            filled += value > 0.0;
        }
    });
    const double share =
        static_cast<double>(filled) / static_cast<double>(volume.geometry.voxelCount());
    EXPECT_GT(share, 0.01);
    EXPECT_LT(share, 0.10);
    EXPECT_EQ(computeStatistics(volume).max, 3000.0);
}

/// Least and greatest of a cell's corners.
std::pair<double, double> endsOf(const Volume& volume, glm::ivec3 cell) {
    std::pair<double, double> ends{1e9, -1e9};
    for (int corner = 0; corner < 8; ++corner) {
        const double value =
            volume.valueAt(cell + glm::ivec3(corner & 1, corner >> 1 & 1, corner >> 2));
        ends = {std::min(ends.first, value), std::max(ends.second, value)};
    }
    return ends;
}

TEST(Phantoms, GapHasItsBulkBetweenTwoMaterialsThatDoNotMeet) {
    const Volume volume = phantom("phantom:gap:96");
    std::map<double, std::int64_t> voxels; // of each pure material
    for (int z = 0; z < 95; ++z) {
        for (int y = 0; y < 95; ++y) {
            for (int x = 0; x < 95; ++x) {
                ++voxels[volume.valueAt({x, y, z})];
                const auto [least, greatest] = endsOf(volume, {x, y, z});
                // No cell mixes what lies outside the bulk with what lies inside it.
                ASSERT_TRUE(greatest <= 900.0 || least >= 900.0) << x << " " << y << " " << z;
            }
        }
    }
    // Eight pores of radius 0.2; of the tree at least the trunk, of radius 0.09 and length 0.42, at
    // 0.6 of its size; each less half a voxel of border.
    const double voxel = 2.0 / 96.0;
    const auto filled = [&](double value) {
        return static_cast<double>(voxels[value]) * voxel * voxel * voxel;
    };
    const double pores = 8.0 * ballVolume(0.2 - voxel / 2);
    EXPECT_NEAR(filled(300.0), pores, 0.05 * pores);
    EXPECT_GT(filled(1500.0), kPi * std::pow(0.6 * 0.09 - voxel / 2, 2.0) * 0.6 * 0.42);
    EXPECT_GT(filled(900.0), 0.9 * 8.0);
    EXPECT_EQ(computeStatistics(volume).min, 300.0);
    EXPECT_EQ(computeStatistics(volume).max, 1500.0);
}

TEST(VesselDistance, IsADistance) {
    // The trunk's wall, by hand: axis on z from -0.85, radius 0.09.
    EXPECT_NEAR(vesselDistance({0.2, 0.0, -0.8}, 1.0), 0.11, 1e-12);
    EXPECT_NEAR(vesselDistance({0.0, 0.03, -0.7}, 1.0), -0.06, 1e-12);
    EXPECT_NEAR(vesselDistance({0.0, 0.0, -1.2}, 1.0), 0.26, 1e-12);
    EXPECT_EQ(vesselDistance({0.2, 0.0, -0.8}, 0.05), 0.05); // not further than the reach
    // Pruned or not, the same; and nowhere steeper than 1.
    for (int i = 0; i < 4000; ++i) {
        const glm::dvec3 p(std::sin(i * 1.1), std::sin(i * 2.3), std::sin(i * 3.7));
        const double far = vesselDistance(p, 10.0);
        ASSERT_EQ(vesselDistance(p, 0.1), std::min(far, 0.1));
        const glm::dvec3 q = p + glm::dvec3(0.01, -0.02, 0.005);
        ASSERT_LE(std::abs(vesselDistance(q, 10.0) - far), glm::distance(p, q) + 1e-12);
    }
}

} // namespace
} // namespace slabcast
