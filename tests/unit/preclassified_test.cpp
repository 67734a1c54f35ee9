#include <cmath>

#include <gtest/gtest.h>

#include "core/transfer/preclassified.h"
#include "core/volume/phantoms.h"
#include "core/volume/voxel_dispatch.h"
#include "tests/support/property.h"

namespace slabcast {
namespace {

using test::anyInt;

constexpr auto kDisplay = CompositingSpace::Display;

/// Doubles from a formula over voxel indices.
template <class Formula>
Volume volumeOf(glm::ivec3 dims, const Formula& formula) {
    Volume volume;
    volume.type = VoxelType::F64;
    volume.geometry.dims = dims;
    volume.voxels.resize(static_cast<std::size_t>(volume.geometry.voxelCount()) * sizeof(double));
    visitVoxels(volume, [&]<class T>(std::span<T> voxels) {
        std::size_t i = 0;
        for (int z = 0; z < dims.z; ++z) {
            for (int y = 0; y < dims.y; ++y) {
                for (int x = 0; x < dims.x; ++x) {
                    voxels[i++] = static_cast<T>(formula(glm::dvec3(x, y, z)));
                }
            }
        }
    });
    return volume;
}

Texels encoded(const Volume& volume, TexelFormat format) {
    return encodeTexels(volume, computeStatistics(volume), format);
}

/// One colour and opacity for all values.
TransferTable flatTable(glm::dvec3 color, double opacity, double unitMm = 1.0) {
    TransferFunction tf;
    tf.opacityUnitMm = unitMm;
    tf.points = {{.value = 0.0, .color = color, .opacity = opacity}};
    return makeTable(tf, -1e6, 1e6, false, kDisplay);
}

int alphaOf(const VolumeGeometry& geometry, const Texels& texels, double opacity,
            const ClassifySettings& settings = {}) {
    return classify(texels, geometry, flatTable(glm::dvec3(1.0), opacity), settings).texels[0].w;
}

TEST(Classify, AlphaIsTheOpacityOfTheReferenceLength) {
    Volume volume = volumeOf({2, 2, 2}, [](glm::dvec3) { return 1.0; });
    volume.geometry.spacingMm = {3.0, 2.0, 5.0};
    const Texels texels = encoded(volume, TexelFormat::R8);
    // 1 - (1 - 0.5)^h for the smallest edge of 2 mm, and for lengths asked for.
    EXPECT_EQ(alphaOf(volume.geometry, texels, 0.5), 191); // 0.75 * 255 = 191.25
    EXPECT_EQ(alphaOf(volume.geometry, texels, 0.5, {.referenceLengthMm = 1.0}), 128); // 127.5
    EXPECT_EQ(alphaOf(volume.geometry, texels, 0.5, {.referenceLengthMm = 0.5}), 75);  // 74.69
    EXPECT_EQ(alphaOf(volume.geometry, texels, 1.0 - 1e-7), 255);
    EXPECT_EQ(alphaOf(volume.geometry, texels, 0.0), 0);
}

TEST(Classify, FaintTexelsRoundToNearestAlsoToZero) {
    const Volume volume = volumeOf({1, 1, 1}, [](glm::dvec3) { return 1.0; });
    const Texels texels = encoded(volume, TexelFormat::R8);
    EXPECT_EQ(alphaOf(volume.geometry, texels, 0.9 / 510.0), 0);
    EXPECT_EQ(alphaOf(volume.geometry, texels, 1.1 / 510.0), 1);
}

TEST(Classify, ColoursArePremultiplied) {
    const Volume volume = volumeOf({1, 1, 1}, [](glm::dvec3) { return 1.0; });
    const ClassifiedTexels result = classify(encoded(volume, TexelFormat::R16F), volume.geometry,
                                             flatTable({1.0, 0.5, 0.0}, 0.75));
    EXPECT_EQ(result.texels[0], glm::u8vec4(191, 96, 0, 191)); // 191.25, 95.6, 0
    EXPECT_EQ(result.referenceLengthMm, 1.0);
    EXPECT_EQ(result.dims, glm::ivec3(1));
}

TEST(Classify, FollowsTheTableForStoredValuesInEveryFormat) {
    TransferFunction tf;
    tf.points = {{.value = 10.0, .color = {0.2, 0.4, 1.0}, .opacity = 0.0},
                 {.value = 20.0, .color = {1.0, 0.3, 0.1}, .opacity = 0.9},
                 {.value = 40.0, .color = {0.0, 1.0, 0.5}, .opacity = 0.2}};
    const Volume volume = volumeOf({50, 3, 2}, [](glm::dvec3 p) { return p.x + 0.3 * p.y - 2.0; });
    for (const CompositingSpace space : {kDisplay, CompositingSpace::Linear}) {
        const TransferTable table = makeTable(tf, -2.0, 48.0, false, space);
        for (const TexelFormat format : {TexelFormat::R8, TexelFormat::R16, TexelFormat::R16F,
                                         TexelFormat::Rg8Exact, TexelFormat::R32fExact}) {
            const Texels texels = encoded(volume, format);
            const ClassifiedTexels result = classify(texels, volume.geometry, table);
            std::size_t i = 0;
            for (int z = 0; z < 2; ++z) {
                for (int y = 0; y < 3; ++y) {
                    for (int x = 0; x < 50; ++x, ++i) {
                        const glm::dvec4 sample = lookUp(table, decodedValue(texels, {x, y, z}));
                        const double alpha = 1.0 - std::exp(-sample.w);
                        const glm::dvec4 expected =
                            255.0 * glm::dvec4(glm::dvec3(sample) * alpha, alpha);
                        for (int c = 0; c < 4; ++c) {
                            ASSERT_LE(std::abs(expected[c] - result.texels[i][c]), 0.501)
                                << name(format) << " x " << x << " channel " << c;
                        }
                    }
                }
            }
        }
    }
}

/// A linear field over an oblique, anisotropic grid, whose gradient in patient space is known.
struct TiltedRamp {
    glm::dvec3 gradient;
    Volume volume;
};

TiltedRamp tiltedRamp(glm::dvec3 gradient) {
    VolumeGeometry geometry;
    geometry.dims = {5, 6, 7};
    geometry.spacingMm = {0.5, 1.0, 4.0};
    geometry.direction = glm::dmat3(glm::dvec3(0.6, 0.8, 0.0), glm::dvec3(-0.8, 0.6, 0.0),
                                    glm::dvec3(0.0, 0.0, -1.0));
    TiltedRamp ramp{gradient, volumeOf(geometry.dims, [&](glm::dvec3 voxel) {
                        return glm::dot(gradient,
                                        geometry.direction * (geometry.spacingMm * voxel));
                    })};
    ramp.volume.geometry.spacingMm = geometry.spacingMm;
    ramp.volume.geometry.direction = geometry.direction;
    return ramp;
}

/// Red channel of an inner voxel of a dense white volume under this light.
double litRed(const TiltedRamp& ramp, const BakedLight& light, TexelFormat format) {
    const ClassifiedTexels result = classify(encoded(ramp.volume, format), ramp.volume.geometry,
                                             flatTable(glm::dvec3(1.0), 1.0 - 1e-7),
                                             {.referenceLengthMm = 4.0, .light = light});
    const glm::ivec3 dims = ramp.volume.geometry.dims;
    return result.texels[static_cast<std::size_t>((3 * dims.y + 3) * dims.x + 2)].x / 255.0;
}

PROPERTY(ClassifyShaded, GradientsAreCarriedToPatientSpace) {
    const auto axis = [] { return anyInt(-100, 100) / 10.0; };
    const glm::dvec3 gradient(axis(), axis(), axis());
    const glm::dvec3 toLight(axis(), axis(), axis());
    PROPERTY_ASSUME(glm::length(gradient) > 1.0 && glm::length(toLight) > 1.0);
    const BakedLight light{toLight, {.ambient = 0.2, .diffuse = 0.7}};
    const double cosine =
        glm::dot(gradient, toLight) / glm::length(gradient) / glm::length(toLight);
    const double expected = 0.2 + 0.7 * std::abs(cosine); // two-sided
    const double red = litRed(tiltedRamp(gradient), light, TexelFormat::R32fExact);
    PROPERTY_ASSERT(std::abs(red - expected) < 0.5 / 255.0 + 1e-4);
}

TEST(ClassifyShaded, GradientsDoNotDependOnTheFormat) {
    const TiltedRamp ramp = tiltedRamp({3.0, -2.0, 1.0});
    const BakedLight light{{1.0, 2.0, 0.5}, {}};
    const double expected = litRed(ramp, light, TexelFormat::R32fExact);
    for (const TexelFormat format : {TexelFormat::R16, TexelFormat::R16F, TexelFormat::Rg8Exact}) {
        EXPECT_NEAR(litRed(ramp, light, format), expected, 0.01) << name(format);
    }
}

TEST(ClassifyShaded, AreCentralDifferencesClampedAtTheEdge) {
    // A bump along x: at voxel 1 the neighbours are equal, so nothing is lit but the ends.
    const Volume volume = volumeOf({3, 1, 1}, [](glm::dvec3 p) { return p.x == 1.0 ? 8.0 : 2.0; });
    const ClassifiedTexels result = classify(
        encoded(volume, TexelFormat::R8), volume.geometry, flatTable(glm::dvec3(1.0), 1.0 - 1e-7),
        {.light = BakedLight{{1.0, 0.0, 0.0}, {.ambient = 0.1, .diffuse = 0.5}}});
    EXPECT_EQ(result.texels[0].x, 153); // 0.6
    EXPECT_EQ(result.texels[1].x, 255); // no gradient: unlit colour
    EXPECT_EQ(result.texels[2].x, 153);
}

TEST(ClassifyShaded, FadesBelowTheGradientFloor) {
    // 6 units over 2 mm on either side of the edge voxel: (8 - 2) / 2 = 3 per mm at voxel 0.
    const Volume volume = volumeOf({3, 1, 1}, [](glm::dvec3 p) { return p.x == 1.0 ? 8.0 : 2.0; });
    const auto red = [&](double floorPerMm) {
        const ShadingParameters params{
            .ambient = 0.0, .diffuse = 0.0, .gradientFloorPerMm = floorPerMm};
        return int{classify(encoded(volume, TexelFormat::R8), volume.geometry,
                            flatTable(glm::dvec3(1.0), 1.0 - 1e-7),
                            {.light = BakedLight{{1.0, 0.0, 0.0}, params}})
                       .texels[0]
                       .x};
    };
    EXPECT_EQ(red(3.0), 255); // at the floor: unlit
    EXPECT_EQ(red(1.5), 0);   // at twice the floor: wholly lit, here black
    EXPECT_EQ(red(2.4), 215); // a quarter: 1 - smoothstep(2.4, 4.8, 3) = 0.84375
    EXPECT_EQ(red(100.0), 255);
}

TEST(Shading, WeightIsASmoothStep) {
    const ShadingParameters params{.gradientFloorPerMm = 4.0};
    EXPECT_EQ(shadingWeight(params, 4.0), 0.0);
    EXPECT_EQ(shadingWeight(params, 5.0), 3.0 / 16.0 - 2.0 / 64.0);
    EXPECT_EQ(shadingWeight(params, 8.0), 1.0);
    EXPECT_EQ(shadingWeight({}, 0.0), 0.0);
    EXPECT_EQ(shadingWeight({}, 1e-30), 1.0);
}

TEST(AlphaCodes, AreTheAlphaBytes) {
    const Volume volume = makePhantom("phantom:ramp:16x2x2").value();
    TransferFunction tf;
    tf.points = {{.value = 0.3, .opacity = 0.0}, {.value = 1.0, .opacity = 0.9}};
    const ClassifiedTexels classified = classify(encoded(volume, TexelFormat::R16), volume.geometry,
                                                 makeTable(tf, 0.0, 1.0, false, kDisplay));
    const TexelCodes codes = alphaCodes(classified);
    ASSERT_EQ(codes.dims, volume.geometry.dims);
    ASSERT_EQ(codes.bytes.size(), 64U);
    for (std::size_t i = 0; i < 64; ++i) {
        EXPECT_EQ(codes.bytes[i], classified.texels[i].w);
    }
    EXPECT_EQ(codes.bytes[0], 0);
    EXPECT_GT(codes.bytes[15], 200);
    ASSERT_EQ(codes.lowSampled.size(), 256U);
    EXPECT_EQ(codes.lowSampled[51], 0.2F);
    EXPECT_EQ(codes.highSampled[255], 1.0F);
}

} // namespace
} // namespace slabcast
