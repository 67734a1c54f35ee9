#include "perf/stability/symmetry.h"

#include <cmath>
#include <set>

#include <gtest/gtest.h>

namespace slabcast::stability {
namespace {

VolumeGeometry original() {
    return {.dims = {4, 3, 5},
            .spacingMm = {0.8, 1.3, 0.6},
            .originMm = {12.0, -8.0, 4.0},
            .direction = obliqueAxes()};
}

double numbered(glm::ivec3 v) {
    return v.x + 4.0 * v.y + 12.0 * v.z;
}

/// Where the middle of a voxel lies in patient space.
glm::dvec3 placeOf(const VolumeGeometry& geometry, glm::ivec3 voxel) {
    return geometry.originMm + geometry.direction * (geometry.spacingMm * glm::dvec3(voxel));
}

TEST(Storage, ThereAreFortyEightSignedPermutations) {
    std::set<std::string> names;
    for (const Storage& storage : allStorages()) {
        names.insert(storage.name());
    }
    EXPECT_EQ(names.size(), 48U);
    EXPECT_EQ(allStorages().front().name(), "+x +y +z");
}

TEST(Storage, LeavesEveryValueWhereItIsInPatientSpace) {
    for (const Storage& storage : allStorages()) {
        const Volume stored = storedAs(storage, original(), numbered);
        for (int i = 0; i < 60; ++i) {
            glm::ivec3 v;
            int left = i;
            for (int k = 0; k < 3; ++k) {
                v[k] = left % stored.geometry.dims[k];
                left /= stored.geometry.dims[k];
            }
            const int value = int(stored.valueAt(v));
            const glm::ivec3 from(value % 4, value / 4 % 3, value / 12);
            const double apart =
                glm::length(placeOf(stored.geometry, v) - placeOf(original(), from));
            ASSERT_LE(apart, 1e-13) << storage.name() << ", voxel " << i;
        }
    }
}

TEST(Storage, OnlyPicturesWithinBothBoundsPass) {
    const Picture a{{1, 1}, {glm::vec4(0.5F)}};
    const Picture b{{1, 1}, {glm::vec4(0.5F, 0.5F, 0.5F, 0.53125F)}};
    const Picture none{{1, 1}, {glm::vec4(std::nanf(""))}};
    const ExpectedPicture bound{{glm::dvec4(0.5), 0.01, false}};
    EXPECT_DOUBLE_EQ(shareOfBothBounds(a, bound, b, bound, 0.005), 0.03125 / 0.025);
    EXPECT_EQ(shareOfBothBounds(a, bound, a, bound, 0.0), 0.0);
    EXPECT_TRUE(std::isnan(shareOfBothBounds(a, bound, none, bound, 0.0)));
}

} // namespace
} // namespace slabcast::stability
