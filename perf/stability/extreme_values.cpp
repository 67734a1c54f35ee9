#include "perf/stability/extreme_values.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "perf/stability/exhibit.h"
#include "perf/stability/volumes.h"

namespace slabcast::stability {

namespace {

constexpr const char* kFamily = "extreme-data";
constexpr double kSigma = 0.0625;                 // exact in the table's fp16
constexpr double kOpacity = 0.060586937186524214; // 1 - exp(-kSigma)
constexpr glm::dvec3 kColor(1.0, 0.5, 0.25);
constexpr glm::ivec3 kDims(20, 16, 24);
constexpr OrbitCamera kCamera{30.0, 20.0, 2.2};

using Formula = std::function<double(glm::ivec3)>;

/// 0 to 200, whole numbers.
double ball(glm::ivec3 v) {
    const double r = glm::length(glm::dvec3(v) - glm::dvec3(10.5, 7.0, 12.0));
    return r < 7.0 ? std::round(100.0 + 100.0 * std::cos(1.3 * r)) : 0.0;
}

/// Air, then two bands with a step between; over values `scale` times as large, moved by `offset`.
TransferFunction bands(double scale, double offset = 0.0) {
    TransferFunction tf{.name = "bands",
                        .points = {{10.0, {0.1, 0.4, 0.9}, 0.0},
                                   {90.0, {0.2, 0.8, 0.4}, 0.1},
                                   {90.0, {0.9, 0.5, 0.1}, 0.3},
                                   {200.0, {1.0, 0.9, 0.7}, 0.5}}};
    for (TransferPoint& point : tf.points) {
        point.value = point.value * scale + offset;
    }
    return tf;
}

/// Scenes of this file, or the reason why there is none as a failed case.
struct Values {
    Bench& bench;
    glm::ivec2 size;

    Exhibit exhibit(const Scene& scene, const std::string& name) const {
        return {.family = kFamily,
                .name = name,
                .scene = scene,
                .view = orbitView(scene, kCamera, 50.0, size),
                .size = size};
    }
    template <class Body>
    void with(const std::string& name, const Volume& volume, const TransferFunction& tf, bool exact,
              const Body& body) const {
        const Result<Scene> scene = bench.scene(volume, {.tf = tf}, {.blockEdgeVoxels = 2}, exact);
        if (!scene) {
            return bench.recordFailure({.family = kFamily, .name = name}, scene.error());
        }
        body(*scene);
    }
    void against(const std::string& name, const Volume& volume, const TransferFunction& tf,
                 bool exact) const {
        with(name, volume, tf, exact, [&](const Scene& scene) {
            recordAgainstSamples(bench, exhibit(scene, name));
            recordSkippingChangesNothing(bench, exhibit(scene, name));
        });
    }
    void same(const std::string& name, const Volume& a, const TransferFunction& tfA,
              const Volume& b, const TransferFunction& tfB, bool exact,
              const std::string& reason) const {
        with(name, a, tfA, exact, [&](const Scene& first) {
            with(name, b, tfB, exact, [&](const Scene& second) {
                const Exhibit shown = exhibit(first, name);
                recordSamePicture(bench, shown, second, shown.view, reason);
            });
        });
    }
    void uniform(const std::string& name, const Volume& volume, const TransferFunction& tf,
                 bool exact) const {
        with(name, volume, tf, exact, [&](const Scene& scene) {
            recordUniform(bench, exhibit(scene, name), kSigma, kColor);
        });
    }
};

constexpr bool kFiltered = false;
constexpr bool kExact = true;
constexpr bool kBoth[] = {kFiltered, kExact};

std::string named(const char* what, bool exact) {
    return std::string(what) + (exact ? ", exact texels" : ", filtered texels");
}

Volume rescaled(Volume volume, double slope, double intercept) {
    volume.rescaleSlope = slope;
    volume.rescaleIntercept = intercept;
    return volume;
}

// int16 -----------------------------------------------------------------------------------------

/// Every one of the 65,536 values once: what texels make of them.
void everyShort(const Values& values, bool exact) {
    const glm::ivec3 dims(64, 32, 32);
    const Volume volume = formulaVolume(dims, VoxelType::I16, [=](glm::ivec3 v) {
        return double((v.z * dims.y + v.y) * dims.x + v.x) - 32768.0;
    });
    const std::string name = named("int16, every value once", exact);
    values.with(name, volume, bands(1.0), exact, [&](const Scene& scene) {
        Case result{.family = kFamily,
                    .name = name,
                    .quantity = "largest error of a stored voxel, data units"};
        const bool halves = scene.texels().format == TexelFormat::R16F;
        result.bound = halves ? (0.5 + 2048.0 * 0x1p-24) * 65535.0 / 4096.0 : 0.0;
        result.reason = halves ? "fp16 holds 4,096 even steps: half of one, and float32 on the way"
                               : "sixteen bits hold sixteen bits";
        for (int z = 0; z < dims.z; ++z) {
            for (int y = 0; y < dims.y; ++y) {
                for (int x = 0; x < dims.x; ++x) {
                    const double kept = decodedValue(scene.texels(), {x, y, z});
                    const double off = std::abs(kept - volume.valueAt({x, y, z}));
                    result.measured = std::max(result.measured, off);
                }
            }
        }
        values.bench.record(std::move(result));
    });
}

void shortCases(const Values& values) {
    const double scale = 65535.0 / 200.0;
    const Volume volume = formulaVolume(kDims, VoxelType::I16,
                                        [=](glm::ivec3 v) { return ball(v) * scale - 32768.0; });
    for (const bool exact : kBoth) {
        values.against(named("int16 over its full range", exact), volume, bands(scale, -32768.0),
                       exact);
        everyShort(values, exact);
    }
}

// The last bit of float32 -----------------------------------------------------------------------

/// The left half of the volume holds `a`, the right half the next float32, which alone is visible.
/// Seen along y from so far that rays are parallel: columns within the outermost voxels' centres of
/// a half are of one material; between them interpolation itself has but two values to give.
void lastBit(const Values& values, float a, bool exact) {
    const float b = std::nextafterf(a, std::numeric_limits<float>::max());
    const glm::ivec3 dims(16, 8, 8);
    const Volume volume =
        formulaVolume(dims, VoxelType::F32, [=](glm::ivec3 v) { return v.x < dims.x / 2 ? a : b; });
    const TransferFunction tf{.name = "step", .points = {{b, kColor, 0.0}, {b, kColor, kOpacity}}};
    char what[64];
    std::snprintf(what, sizeof what, "last bit of %.9g", double(a));
    const std::string name = named(what, exact);
    values.with(name, volume, tf, exact, [&](const Scene& scene) {
        Exhibit exhibit = values.exhibit(scene, name);
        constexpr double kFar = 1e4;
        exhibit.view = orbitView(scene, {0.0, 0.0, kFar}, glm::degrees(1.6 / kFar), exhibit.size);
        const double depth = kFar * scene.geometry().boundingSphere().radiusMm;
        const auto dropOthers = [&](ExpectedPicture& expected) {
            for (std::size_t i = 0; i < expected.size(); ++i) {
                const double tangent =
                    glm::mix(exhibit.view.frustum.left, exhibit.view.frustum.right,
                             (double(i % exhibit.size.x) + 0.5) / exhibit.size.x);
                const double fromMiddle = tangent * depth; // voxels
                expected[i].atEdge = std::abs(fromMiddle) < 0.51;
                if (fromMiddle < 0.0) {
                    expected[i] = {.atEdge = expected[i].atEdge};
                }
            }
        };
        recordUniform(values.bench, exhibit, kSigma, kColor, dropOthers);
        recordSkippingChangesNothing(values.bench, exhibit);
    });
}

// Magnitudes ------------------------------------------------------------------------------------

void magnitudeCases(const Values& values) {
    const struct {
        const char* name;
        double scale;
    } magnitudes[] = {{"float32 denormals (up to 2.8e-43)", 0x1p-149},
                      {"values around 1e-30", 0x1p-107},
                      {"values around 1e30", 0x1p92},
                      {"values over float32's whole range", 0x1p121}};
    const auto centred = [](glm::ivec3 v) { return ball(v) - 100.0; };
    const Volume plain = formulaVolume(kDims, VoxelType::F32, centred);
    for (const auto& magnitude : magnitudes) {
        const double scale = magnitude.scale;
        const Volume scaled =
            formulaVolume(kDims, VoxelType::F32, [=](glm::ivec3 v) { return centred(v) * scale; });
        for (const bool exact : kBoth) {
            values.same(named(magnitude.name, exact), plain, bands(1.0, -100.0), scaled,
                        bands(scale, -100.0 * scale), exact,
                        "the same numbers times a power of two, under a TF scaled alike: float32 "
                        "keeps them all, and what is computed from them is the same");
        }
    }
}

// What is no number -----------------------------------------------------------------------------

/// Voxels of `type` that hold what cannot be shown, against the same with the lowest value in
/// their place.
void unpresentable(const Values& values, const char* what, VoxelType type,
                   std::span<const double> bad) {
    const auto isBad = [](glm::ivec3 v) { return (v.x * 7 + v.y * 5 + v.z * 3) % 11 == 0; };
    const auto shown = [=](glm::ivec3 v) { return ball(v) - 50.0; };
    const Volume mended =
        formulaVolume(kDims, type, [=](glm::ivec3 v) { return isBad(v) ? -50.0 : shown(v); });
    std::int64_t count = 0;
    const Volume raw = formulaVolume(kDims, type, [&](glm::ivec3 v) {
        return isBad(v) ? bad[static_cast<std::size_t>(count++) % bad.size()] : shown(v);
    });
    values.bench.record({.family = kFamily,
                         .name = std::string(what) + ", counted",
                         .quantity = "voxels miscounted",
                         .bound = 0.0,
                         .reason = "every voxel that cannot be shown is counted",
                         .measured = double(std::abs(raw.nonFiniteVoxels - count))});
    for (const bool exact : kBoth) {
        values.same(named(what, exact) + ", mended", mended, bands(1.0, -50.0), raw,
                    bands(1.0, -50.0), exact,
                    "what cannot be shown is taken for the lowest value that can");
        values.against(named(what, exact), raw, bands(1.0, -50.0), exact);
    }
}

void unpresentableCases(const Values& values) {
    const double nan = std::nan("");
    const double infinity = std::numeric_limits<double>::infinity();
    const double notNumbers[] = {nan, infinity, -infinity};
    const double tooLarge[] = {1e300, -1e300, 3.5e38, nan};
    unpresentable(values, "NaN and infinities in float32", VoxelType::F32, notNumbers);
    unpresentable(values, "float64 beyond float32", VoxelType::F64, tooLarge);
}

// One value, or none to be seen -----------------------------------------------------------------

void constantCases(const Values& values) {
    const struct {
        const char* name;
        VoxelType type;
        double value;
        double step = 0.0;
    } constants[] = {{"all zero, uint8", VoxelType::U8, 0.0},
                     {"all zero, float32", VoxelType::F32, 0.0},
                     {"one value, uint8", VoxelType::U8, 42.0},
                     {"one value, int16", VoxelType::I16, -32768.0},
                     {"one value, float32", VoxelType::F32, 3.0e38},
                     {"one value, a denormal", VoxelType::F32, 0x1p-149},
                     {"float64 denormals", VoxelType::F64, 0.0, 1e-312}};
    for (const auto& c : constants) {
        const Volume volume =
            formulaVolume(kDims, c.type, [=](glm::ivec3 v) { return c.value + v.x * c.step; });
        const double aside = std::max(1.0, std::abs(c.value) * 0.1);
        const TransferFunction tf{.name = "peak",
                                  .points = {{c.value - aside, kColor, 0.0},
                                             {c.value, kColor, kOpacity},
                                             {c.value + aside, kColor, 1.0}}};
        for (const bool exact : kBoth) {
            values.uniform(named(c.name, exact), volume, tf, exact);
        }
    }
}

void nothingVisible(const Values& values) {
    const Volume zero = formulaVolume(kDims, VoxelType::I16, [](glm::ivec3) { return 0.0; });
    const std::string name = "all zero, where the TF is zero";
    values.with(name, zero, bands(1.0), kFiltered, [&](const Scene& scene) {
        const Exhibit exhibit = values.exhibit(scene, name);
        for (const Method& method : methods()) {
            Case result{.family = kFamily,
                        .name = name + ", " + method.name,
                        .quantity = "pixels that are not clear",
                        .bound = 0.0,
                        .reason = "nothing is drawn"};
            const Result<Drawn> drawn =
                values.bench.draw(scene, settingsFor(exhibit, method), exhibit.view, exhibit.size);
            if (!drawn) {
                values.bench.recordFailure(std::move(result), drawn.error());
                continue;
            }
            const Picture clear{exhibit.size, std::vector<glm::vec4>(drawn->picture.pixels.size())};
            result.measured = differingPixels(drawn->picture, clear);
            values.bench.record(std::move(result));
        }
    });
}

void negativeSlopeCases(const Values& values) {
    const std::string reason =
        "the data values are the same ones, and texels count upwards in them";
    for (const VoxelType type : {VoxelType::U8, VoxelType::I16, VoxelType::F32}) {
        const Volume upwards = rescaled(formulaVolume(kDims, type, ball), 2.0, 0.0);
        const double lift = type == VoxelType::U8 ? 200.0 : 0.0; // floats are stored as they are
        const Volume downwards =
            rescaled(formulaVolume(kDims, type, [=](glm::ivec3 v) { return lift - ball(v); }), -2.0,
                     2.0 * lift);
        for (const bool exact : kBoth) {
            const std::string what = std::string("negative rescale slope, ") + name(type);
            values.same(named(what.c_str(), exact), upwards, bands(2.0), downwards, bands(2.0),
                        exact, reason);
        }
    }
}

} // namespace

void extremeValueCases(Bench& bench, glm::ivec2 size) {
    const Values values{bench, size};
    shortCases(values);
    for (const float a : {1.0F, -1000.0F, 1e30F}) {
        for (const bool exact : kBoth) {
            lastBit(values, a, exact);
        }
    }
    magnitudeCases(values);
    unpresentableCases(values);
    constantCases(values);
    nothingVisible(values);
    negativeSlopeCases(values);
}

} // namespace slabcast::stability
