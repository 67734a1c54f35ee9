#include "perf/model/paper_model.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/volume/phantoms.h"

namespace slabcast {
namespace {

constexpr int kEdge = 64;
constexpr PaperView kView{.azimuthDegrees = 30.0, .discPixels = 400, .everyQuad = 4};

PaperVolume filled(std::uint8_t distance) {
    return {kEdge, std::vector<std::uint8_t>(kEdge * kEdge * kEdge, distance)};
}

PaperSettings settings(int layersPerPlane, bool skips) {
    return {layersPerPlane, static_cast<int>(std::ceil(std::sqrt(3.0) * kEdge)), skips};
}

PaperWork workOf(const PaperVolume& volume, int layersPerPlane, bool skips) {
    return paperWork(volume, kView, settings(layersPerPlane, skips));
}

TEST(PaperModel, PlanesCoverTheSphereAndSegmentsTheCube) {
    // Far away, planes' discs are the sphere's slices: two thirds of its diameter a pixel; and what
    // lies in the cube is its share of the sphere.
    PaperView far = kView;
    far.eyeDistanceRadii = 100.0;
    const PaperSettings slicing = settings(1, false);
    const PaperWork work = paperWork(filled(0), far, slicing);
    const double diameter = std::sqrt(3.0) * kEdge;
    EXPECT_NEAR(work.fragments, diameter * 2.0 / 3.0, 0.03 * diameter);
    const double share = 1.0 / (4.0 / 3.0 * M_PI * std::pow(0.5 * std::sqrt(3.0), 3.0));
    EXPECT_NEAR(work.segments / work.fragments, share, 0.02);
    EXPECT_EQ(work.segments, work.layers);
    EXPECT_EQ(work.boxTests, work.layers);
}

TEST(PaperModel, EveryRatioFetchesTheSameSamples) {
    const double slicing = workOf(filled(0), 1, false).fetchesAlone;
    for (const int layers : {2, 8, 16}) {
        const PaperWork work = workOf(filled(0), layers, false);
        EXPECT_NEAR(work.fetchesAlone, slicing, 0.02 * slicing) << layers;
        EXPECT_GE(work.fetches, work.fetchesAlone);
        EXPECT_EQ(work.leaps, 0.0);
    }
}

TEST(PaperModel, WhatIsEmptyIsLeaptOverByTheLengthThatIsStored) {
    const PaperWork plain = workOf(filled(0), 16, false);
    const PaperWork opaque = workOf(filled(0), 16, true);
    EXPECT_EQ(opaque.fetches, plain.fetches);
    EXPECT_EQ(opaque.leaps, 0.0);
    // One sample and the leap over all that follow it in the segment.
    const PaperWork empty = workOf(filled(255), 16, true);
    EXPECT_LE(empty.fetchesAlone, 1.2 * empty.segments);
    EXPECT_GT(empty.leaps, 0.5 * empty.layers);
    // Every fourth: one sample, three leaps.
    const PaperWork fourth = workOf(filled(3), 16, true);
    EXPECT_NEAR(fourth.fetchesAlone / plain.fetchesAlone, 0.25, 0.06);
}

TEST(PaperModel, DistancesAreToTheClosestVisibleVoxel) {
    const TransferFunction solid{.name = "solid",
                                 .points = {{100.0, {1, 1, 1}, 0.0}, {101.0, {1, 1, 1}, 1.0}}};
    const Volume ball = makePhantom("phantom:sphere:24").value();
    const PaperVolume found = paperVolume(ball, solid);
    std::vector<glm::ivec3> visible;
    for (int k = 0; k < 24 * 24 * 24; ++k) {
        const glm::ivec3 at(k % 24, k / 24 % 24, k / 576);
        if (found.at(at) == 0) {
            visible.push_back(at);
        }
    }
    ASSERT_GT(visible.size(), 100U);
    ASSERT_LT(visible.size(), 24U * 24U * 24U);
    for (const glm::ivec3 at : {glm::ivec3(0), glm::ivec3(23, 0, 12), glm::ivec3(5, 20, 3)}) {
        double nearest = 1e9;
        for (const glm::ivec3 other : visible) {
            nearest = std::min(nearest, glm::length(glm::dvec3(at - other)));
        }
        EXPECT_EQ(found.at(at), static_cast<int>(nearest)) << at.x << " " << at.y << " " << at.z;
    }
}

/// How many times as much one is as the other.
double factor(double a, double b) {
    return std::max(a / b, b / a);
}

TEST(PaperModel, ComesWithinAFactorOfThePapersOwnFigures) {
    const std::vector<PaperFigure> figures = paperFigures(paperRowsOfSkull());
    ASSERT_EQ(figures.size(), 4U);
    for (const PaperFigure& one : figures) {
        EXPECT_LT(factor(one.modelFps, one.publishedFps), 1.5) << one.method;
    }
    // No share of the screen is in these.
    const double overSlicing = figures[3].modelFps / figures[2].modelFps;
    const double overRayCasting = figures[3].modelFps / figures[1].modelFps;
    EXPECT_LT(factor(overSlicing, 2.59), 1.5);
    EXPECT_LT(factor(overRayCasting, 4.24), 1.5);
}

TEST(PaperModel, TheShareIsTheOneThatIsOffLeast) {
    const auto worst = [](double share) {
        double most = 1.0;
        for (const PaperFigure& one : paperFigures(paperRowsOfSkull(), share)) {
            most = std::max(most, factor(one.modelFps, one.publishedFps));
        }
        return most;
    };
    EXPECT_LE(worst(kPaperShare), worst(kPaperShare - 0.01) + 1e-9);
    EXPECT_LE(worst(kPaperShare), worst(kPaperShare + 0.01) + 1e-9);
}

} // namespace
} // namespace slabcast
