#include "perf/model/divergence.h"

#include <vector>

#include <gtest/gtest.h>

namespace slabcast {
namespace {

std::vector<PixelWork> picture(std::initializer_list<float> layers) {
    std::vector<PixelWork> all;
    for (const float one : layers) {
        PixelWork work;
        work.layersEvaluated = one;
        all.push_back(work);
    }
    return all;
}

double of(const std::vector<PixelWork>& work, glm::ivec2 size, glm::ivec2 wave) {
    return divergence(work, size, wave,
                      [](const PixelWork& pixel) { return double(pixel.layersEvaluated); });
}

TEST(Divergence, AWaveDoesWhatItsBusiestPixelDoes) {
    const auto work = picture({1, 3, 2, 2, //
                               2, 2, 2, 2});
    EXPECT_DOUBLE_EQ(of(work, {4, 2}, {1, 1}), 1.0);
    EXPECT_DOUBLE_EQ(of(work, {4, 2}, {2, 2}), (4 * 3 + 4 * 2) / 16.0);
    EXPECT_DOUBLE_EQ(of(work, {4, 2}, {4, 2}), 8 * 3 / 16.0);
}

TEST(Divergence, WavesReachBeyondThePicture) {
    EXPECT_DOUBLE_EQ(of(picture({1, 1, 1}), {3, 1}, {2, 2}), 8.0 / 3.0);
}

TEST(Divergence, NothingIsNotDivided) {
    EXPECT_EQ(of(picture({0, 0}), {2, 1}, {2, 2}), 1.0);
}

} // namespace
} // namespace slabcast
