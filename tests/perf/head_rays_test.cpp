#include "perf/stability/head_rays.h"

#include <gtest/gtest.h>

#include "core/volume/phantoms.h"
#include "perf/stability/turning.h"

namespace slabcast::stability {
namespace {

constexpr int kSide = 10;
constexpr double kFovDegrees = 100.0;

/// Waves under a smooth transfer function, as the family `lattices` looks at them.
const Scene& waves() {
    static const Scene scene = [] {
        Scene made =
            Scene::create(makePhantom("phantom:marschner-lobb:32").value(), TextureChoice{})
                .value();
        Look look;
        look.tf = turningScenes()[1].tf;
        EXPECT_TRUE(made.setLook(look).has_value());
        return made;
    }();
    return scene;
}

double swim(LatticeKind kind, double spacingMm, Region region, double degrees) {
    const HeadRays rays(waves(), kFovDegrees, kSide);
    const double radius = waves().geometry().boundingSphere().radiusMm;
    const Lattice lattice{kind, layersToCover(radius, spacingMm), spacingMm};
    const Gathered before = rays.gathered(lattice, 0.0);
    const Gathered after = rays.gathered(lattice, degrees);
    SquareSum changes;
    for (int i = 0; i < rays.count(); ++i) {
        if (rays.isIn(region, i)) {
            changes.add(largest(after.pixels[std::size_t(i)] - before.pixels[std::size_t(i)]));
        }
    }
    return changes.rms();
}

TEST(HeadRays, StayInTheWorldWhileTheHeadTurns) {
    const HeadRays rays(waves(), kFovDegrees, kSide);
    ASSERT_GT(rays.count(), kSide * kSide / 2);
    const Lattice one{LatticeKind::Planar, 1, 100.0};
    const Gathered before = rays.gathered(one, 0.0);
    const Gathered after = rays.gathered(one, 5.0);
    for (std::size_t i = 0; i < before.rays.size(); ++i) {
        const EyeRay& a = before.rays[i];
        const EyeRay& b = after.rays[i];
        EXPECT_LT(glm::length(a.eyeUvw - b.eyeUvw), 1e-12) << i;
        EXPECT_LT(glm::length(a.uvwPerMm - b.uvwPerMm), 1e-12) << i;
        EXPECT_GT(std::abs(a.cosine - b.cosine), 1e-6) << i; // and the view is another
    }
}

TEST(HeadRays, RegionsAreThePicturesMiddleAndRim) {
    const HeadRays rays(waves(), 20.0, kSide); // all of them meet the volume
    ASSERT_EQ(rays.count(), kSide * kSide);
    const auto count = [&](Region region) {
        int found = 0;
        for (int i = 0; i < rays.count(); ++i) {
            found += rays.isIn(region, i) ? 1 : 0;
        }
        return found;
    };
    EXPECT_EQ(count(Region::All), 100);
    EXPECT_EQ(count(Region::Centre), 16);       // 4x4
    EXPECT_EQ(count(Region::Border), 100 - 36); // a frame of two pixels
}

/// Not at all: a sample moves by 2^-44 of its distance, and a sum of 60 layers by a few roundings
/// of the steepest change, below 1e-10.
TEST(HeadRays, ShellsDoNotSwim) {
    for (const Region region : kRegions) {
        for (const double degrees : {1.0, 5.0}) {
            EXPECT_LT(swim(LatticeKind::Shells, 1.0, region, degrees), 1e-10)
                << name(region) << degrees;
        }
    }
}

/// By more than a quarter of a step of 8 bits in every part of the view, and less where layers are
/// nearer to each other.
TEST(HeadRays, PlanarLayersSwim) {
    for (const Region region : kRegions) {
        for (const double degrees : {1.0, 5.0}) {
            const double coarse = swim(LatticeKind::Planar, 1.0, region, degrees);
            EXPECT_GT(coarse, 1e-3) << name(region) << degrees;
            EXPECT_LT(swim(LatticeKind::Planar, 0.25, region, degrees), coarse / 3.0)
                << name(region) << degrees;
        }
    }
}

} // namespace
} // namespace slabcast::stability
