#include "core/reference/field_cubic.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "core/reference/cell_walk.h"
#include "core/reference/stretches.h"
#include "tests/support/formula_volume.h"
#include "tests/support/frame_scene.h"

namespace slabcast {
namespace {

using test::Dice;

Cubic randomCubic(Dice& dice) {
    Cubic cubic;
    for (double& point : cubic.points) {
        point = dice.chance(0.2) ? 0.0 : dice.uniform(-1.0, 1.0);
    }
    return cubic;
}

double inPowers(const Cubic& cubic, double s) {
    const double r = 1.0 - s;
    const auto& p = cubic.points;
    return p[0] * r * r * r + 3.0 * p[1] * r * r * s + 3.0 * p[2] * r * s * s + p[3] * s * s * s;
}

TEST(Cubic, PartsAndHalvesAreTheCubicItself) {
    Dice dice(1);
    for (int k = 0; k < 2000; ++k) {
        const Cubic cubic = randomCubic(dice);
        const double begin = dice.uniform(0.0, 1.0);
        const double end = dice.uniform(0.0, 1.0);
        const double s = dice.uniform(0.0, 1.0);
        EXPECT_NEAR(cubic.at(s), inPowers(cubic, s), 1e-15);
        EXPECT_NEAR(cubic.part(begin, end).at(s), inPowers(cubic, begin + s * (end - begin)),
                    1e-14);
        EXPECT_NEAR(cubic.halves()[0].at(s), inPowers(cubic, 0.5 * s), 1e-15);
        EXPECT_NEAR(cubic.halves()[1].at(s), inPowers(cubic, 0.5 + 0.5 * s), 1e-15);
    }
}

TEST(Cubic, TurnsExactlyWhereItIsNoLongerMonotone) {
    Dice dice(2);
    int turned = 0;
    for (int k = 0; k < 3000; ++k) {
        const Cubic cubic = randomCubic(dice);
        const Turns turns = turnsOf(cubic);
        turned += turns.count;
        double begin = 0.0;
        for (int i = 0; i <= turns.count; ++i) {
            const double end = i < turns.count ? turns.at[static_cast<std::size_t>(i)] : 1.0;
            ASSERT_GE(end, begin);
            const double sign = cubic.at(end) < cubic.at(begin) ? -1.0 : 1.0;
            for (int j = 0; j < 50; ++j) {
                const double a = cubic.at(begin + (end - begin) * j / 50.0);
                const double b = cubic.at(begin + (end - begin) * (j + 1) / 50.0);
                EXPECT_GE(sign * (b - a), -1e-15) << k;
            }
            begin = end;
        }
    }
    EXPECT_GT(turned, 1000);
}

TEST(Cubic, CrossesAValueWhereItSays) {
    Dice dice(3);
    int crossed = 0;
    for (int k = 0; k < 3000; ++k) {
        const Cubic cubic = randomCubic(dice);
        const Turns turns = turnsOf(cubic);
        const double end = turns.count > 0 ? turns.at[0] : 1.0;
        const double value = glm::mix(cubic.at(0.0), cubic.at(end), dice.uniform(0.0, 1.0));
        const double s = crossingOf(cubic, value, 0.0, end);
        ASSERT_GE(s, 0.0);
        ASSERT_LE(s, end);
        EXPECT_NEAR(cubic.at(s), value, 1.5e-15) << k; // three means of two roundings of up to 2
        crossed += s > 0.0 && s < end;
    }
    EXPECT_GT(crossed, 2500);
    const Cubic flat{{-0x1p-60, 0.0, 0.0, 0x1p-60}}; // s^3 - (1 - s)^3
    EXPECT_NEAR(crossingOf(flat, 0.0, 0.0, 1.0), 0.5, 1e-15);
    const Cubic triple{{-0.125, 0.125, -0.125, 0.125}}; // (s - 1/2)^3: every derivative vanishes
    EXPECT_NEAR(crossingOf(triple, 0.0, 0.0, 1.0), 0.5, 1e-5);
}

TEST(FieldCubic, IsTheTrilinearFieldAlongTheLine) {
    Dice dice(4);
    for (int k = 0; k < 2000; ++k) {
        std::array<double, 8> corners;
        const double base = dice.chance(0.5) ? 0.0 : 1e6;
        for (double& corner : corners) {
            corner = base + dice.below(100);
        }
        const glm::dvec3 from = dice.inCube(0.0, 1.0);
        const glm::dvec3 to = dice.inCube(0.0, 1.0);
        const FieldCubic field = fieldAlong(corners, from, to);
        const double s = dice.uniform(0.0, 1.0);
        const glm::dvec3 at = glm::mix(from, to, s);
        double expected = 0.0;
        for (int c = 0; c < 8; ++c) {
            const glm::dvec3 high((c & 1) != 0, (c & 2) != 0, (c & 4) != 0);
            const glm::dvec3 weight = glm::mix(1.0 - at, at, high);
            expected +=
                weight.x * weight.y * weight.z * (corners[static_cast<std::size_t>(c)] - base);
        }
        EXPECT_NEAR(field.base - base + field.above.at(s), expected, 1e-13);
    }
    const FieldCubic constant = fieldAlong({0.3, 0.3, 0.3, 0.3, 0.3, 0.3, 0.3, 0.3},
                                           glm::dvec3(0.1, 0.7, 0.3), glm::dvec3(0.9, 0.2, 0.6));
    EXPECT_EQ(constant.base, 0.3);
    EXPECT_EQ(constant.above.points, (std::array<double, 4>{}));
}

TEST(CellWalk, CellsFollowEachOtherFromEntryToExit) {
    Dice dice(5);
    std::int64_t visited = 0;
    for (int k = 0; k < 2000; ++k) {
        const test::FrameScene scene = test::randomScene(dice, 1 + dice.below(500));
        const LatticeRay ray = rayAt(scene.frame(), test::randomFragCoord(dice, scene));
        const glm::ivec3 dims = scene.geometry.dims;
        double offset = ray.entry;
        int cells = 0;
        walkCells(ray, dims, [&](glm::ivec3 cell, glm::dvec3 from, glm::dvec3 to, double layers) {
            EXPECT_TRUE(glm::all(glm::greaterThanEqual(cell, glm::ivec3(-1))));
            EXPECT_TRUE(glm::all(glm::lessThan(cell, dims)));
            const auto placeAt = [&](double o) {
                return (ray.centre + o * ray.step) * glm::dvec3(dims) - 0.5;
            };
            const double slack = 1e-9; // of a voxel: the ray's centre may lie far outside the box
            EXPECT_LE(glm::distance(placeAt(offset), glm::dvec3(cell) + from), slack);
            EXPECT_LE(glm::distance(placeAt(offset + layers), glm::dvec3(cell) + to), slack);
            offset += layers;
            ++cells;
            return true;
        });
        EXPECT_NEAR(offset, std::max(ray.entry, ray.exit), 1e-9 * (1.0 + std::abs(ray.exit)));
        EXPECT_LE(cells, dims.x + dims.y + dims.z + 3);
        EXPECT_EQ(cells > 0, ray.entry < ray.exit);
        visited += cells;
    }
    EXPECT_GT(visited, 20000);
}

TEST(CellWalk, AlongFacesAndEdgesEachLengthCountsOnce) {
    const double infinity = std::numeric_limits<double>::infinity();
    for (const glm::dvec3 step :
         {glm::dvec3(1.0, 0.0, 0.0), glm::dvec3(-1.0, 0.0, 0.0), glm::dvec3(0.0, 1.0, 0.0),
          glm::dvec3(0.0, -1.0, 1.0), glm::dvec3(1.0, 1.0, 1.0), glm::dvec3(-1.0, 1.0, -1.0),
          glm::dvec3(1.0, 1e-17, 0.0), glm::dvec3(1e-300, 0.0, 1.0)}) {
        for (const double centre : {0.5, 0.3, 0.125, 0.0, 1.0}) { // 0.3: a plane of voxel centres
            LatticeRay ray{glm::dvec3(centre), step, 1.0, -infinity, infinity};
            for (int axis = 0; axis < 3; ++axis) {
                if (step[axis] != 0.0) {
                    const double a = -centre / step[axis];
                    const double b = (1.0 - centre) / step[axis];
                    ray.entry = std::max(ray.entry, std::min(a, b));
                    ray.exit = std::min(ray.exit, std::max(a, b));
                }
            }
            double sum = 0.0;
            walkCells(ray, glm::ivec3(5, 10, 1), [&](auto, auto, auto, double layers) {
                EXPECT_GT(layers, 0.0);
                sum += layers;
                return true;
            });
            EXPECT_NEAR(sum, std::max(0.0, ray.exit - ray.entry), 1e-15);
        }
    }
}

TEST(Stretches, CutWhereTheTransferFunctionTurns) {
    // Empty up to 0, a ramp to 1, a step, a ramp from 1 to 2, empty beyond.
    const TransferFunction tf = test::tfOf({{.value = 0.0, .opacity = 0.0},
                                            {.value = 1.0, .opacity = 0.5},
                                            {.value = 1.0, .opacity = 0.2},
                                            {.value = 2.0, .opacity = 0.3},
                                            {.value = 2.0, .opacity = 0.0}});
    const TransferRamps ramps(tf, CompositingSpace::Display);
    Dice dice(6);
    for (int k = 0; k < 2000; ++k) {
        FieldCubic field;
        field.base = dice.chance(0.5) ? 0.0 : 1.0;
        for (double& point : field.above.points) {
            point = dice.chance(0.3) ? dice.below(4) - 1 : dice.uniform(-3.0, 4.0) - field.base;
        }
        double visible = 0.0;
        visitStretches(field, ramps,
                       [&](const TransferRamp& ramp, const Cubic& share, double part) {
                           EXPECT_FALSE(ramp.isEmpty());
                           for (const double end : {share.at(0.0), share.at(0.5), share.at(1.0)}) {
                               EXPECT_GE(end, -1e-14);
                               EXPECT_LE(end, 1.0 + 1e-14);
                           }
                           visible += part;
                       });
        constexpr int kSamples = 500;
        int inside = 0;
        for (int i = 0; i < kSamples; ++i) {
            const double value = field.base + field.above.at((i + 0.5) / kSamples);
            inside += value > 0.0 && value < 2.0;
        }
        // A cubic enters and leaves the band at most six times: half a sample each.
        EXPECT_NEAR(visible, static_cast<double>(inside) / kSamples, 3.5 / kSamples) << k;
    }
}

TEST(Stretches, AValueOnAStepIsAboveIt) {
    const TransferFunction tf =
        test::tfOf({{.value = 5.0, .opacity = 0.0}, {.value = 5.0, .opacity = 0.5}});
    const TransferRamps ramps(tf, CompositingSpace::Display);
    double visible = 0.0;
    const auto count = [&](const TransferRamp&, const Cubic&, double part) { visible += part; };
    visitStretches({5.0, {}}, ramps, count);
    EXPECT_EQ(visible, 1.0);
    visible = 0.0;
    visitStretches({std::nextafter(5.0, 0.0), {}}, ramps, count);
    EXPECT_EQ(visible, 0.0);
}

} // namespace
} // namespace slabcast
