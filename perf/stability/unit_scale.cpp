#include <cmath>

#include "perf/stability/symmetry.h"

namespace slabcast::stability {

namespace {

constexpr OrbitCamera kCamera{37.0, 23.0, 2.4};
constexpr glm::dvec3 kOriginMm(120.0, -80.0, 40.0);
constexpr int kPowersOfTwo[] = {-20, -13, -7, -3, -1, 1, 3, 7, 13, 20};

const char* const kScaleReason =
    "every length is scaled, so that nothing that a picture is made of changes but for rounding: "
    "each is within its own bound of float64 over its samples; and the table's extinctions are "
    "scaled by a power of two and then rounded, each twice by half of its step, which moves the "
    "picture by as much of alpha: ";
const char* const kPowerReason =
    "a power of two scales every length alike and rounds nothing otherwise, and no length is "
    "compared with a fixed one: the same bits";

/// How the table holds extinctions: in fp16, or, where a point is 12 decades fainter, in float32.
struct Table {
    const char* name;
    double faintest;
    double rounding; // of two extinctions, relative
    const char* reason;
};
constexpr Table kTables[] = {{"table in fp16", 0.02, 0x1p-10, "2^-10"},
                             {"table in float32", 1e-14, 0x1p-23, "2^-23"}};

/// Spacing, origin and the opacity's unit of length are `scale` times those of the original; a
/// camera in radii follows.
Result<Scene> scaledScene(Bench& bench, double scale, double faintest, bool lit) {
    const Volume volume = placedAt(
        formulaVolume({14, 10, 18}, VoxelType::U8, lopsided, glm::dvec3(0.8, 1.3, 0.6) * scale),
        kOriginMm * scale, obliqueAxes());
    TransferFunction tf = lopsidedTransfer(scale);
    tf.points.insert(tf.points.begin(), {0.0, {0.1, 0.4, 0.9}, faintest});
    Appearance look{.tf = tf};
    if (lit) {
        look.shading = ShadingParameters{};
    }
    return bench.scene(volume, look, {.structure = SkipStructure::None}, !lit);
}

struct Scaled {
    Scene scene;
    View view;
    Picture picture;
    ExpectedPicture expected;
};

Result<Scaled> drawnScaled(Bench& bench, double scale, const Table& table, glm::ivec2 size) {
    Result<Scene> scene = scaledScene(bench, scale, table.faintest, false);
    if (!scene) {
        return tl::unexpected(scene.error());
    }
    const View view = orbitView(*scene, kCamera, 40.0, size);
    const Result<FramePlan> plan = bench.plan(*scene, settingsOf(methods().back()));
    Result<Picture> picture =
        plan ? bench.drawFinely(*scene, *plan, view, size) : tl::unexpected(plan.error());
    if (!picture) {
        return tl::unexpected(picture.error());
    }
    ExpectedPicture expected = expectedFromSamples(
        {.family = "", .name = "", .scene = *scene, .view = view, .size = size}, *plan);
    return Scaled{std::move(*scene), view, std::move(*picture), std::move(expected)};
}

double mostAlpha(const Picture& picture) {
    double most = 0.0;
    for (const glm::vec4& pixel : picture.pixels) {
        most = largerOf(most, pixel.a);
    }
    return most;
}

void tenfoldCases(Bench& bench, const Table& table) {
    const glm::ivec2 size(bench.reduced() ? 12 : 24);
    const Result<Scaled> original = drawnScaled(bench, 1.0, table, size);
    for (int exponent = -6; exponent <= 6; ++exponent) {
        if (exponent == 0 || (bench.reduced() && exponent % 3 != 0)) {
            continue;
        }
        const double scale = std::pow(10.0, exponent);
        Case c{.family = kSymmetryFamily,
               .name = named({"lengths times 1e" + std::to_string(exponent), table.name}),
               .quantity = "worst share of both pictures' own bounds",
               .bound = 1.0,
               .reason = std::string(kScaleReason) + table.reason};
        const Result<Scaled> scaled = drawnScaled(bench, scale, table, size);
        if (!original || !scaled) {
            bench.recordFailure(std::move(c), original ? scaled.error() : original.error());
            continue;
        }
        const double more =
            table.rounding * mostAlpha(original->picture) + 2.0 * bench.finest().rounding;
        c.measured = shareOfBothBounds(scaled->picture, scaled->expected, original->picture,
                                       original->expected, more);
        const std::vector<glm::dvec4> meant(original->picture.pixels.begin(),
                                            original->picture.pixels.end());
        c.series = Series{.group = table.name,
                          .panel = "",
                          .x = scale,
                          .y = largestDifference(scaled->picture, meant),
                          .xLabel = "lengths times",
                          .yLabel = "largest difference from lengths times 1"};
        bench.record(std::move(c));
    }
}

/// By all methods on both lattices, lit.
void powerOfTwoCase(Bench& bench, const Result<Scene>& original, int exponent) {
    const glm::ivec2 size(bench.reduced() ? 12 : 24);
    Case c{.family = kSymmetryFamily,
           .name = named({"lengths times 2^" + std::to_string(exponent), "lit"}),
           .quantity = "pixels that differ in any bit, over all methods and both lattices",
           .reason = kPowerReason};
    const Result<Scene> scaled =
        scaledScene(bench, std::ldexp(1.0, exponent), kTables[0].faintest, true);
    if (!original || !scaled) {
        return bench.recordFailure(std::move(c), original ? scaled.error() : original.error());
    }
    for (const Method& method : methods()) {
        for (const LatticeKind lattice : {LatticeKind::Planar, LatticeKind::Shells}) {
            Settings settings = settingsOf(method);
            settings.lattice = lattice;
            settings.shaded = true;
            const Result<Drawn> a =
                bench.draw(*original, settings, orbitView(*original, kCamera, 40.0, size), size);
            const Result<Drawn> b =
                bench.draw(*scaled, settings, orbitView(*scaled, kCamera, 40.0, size), size);
            if (!a || !b) {
                return bench.recordFailure(std::move(c), a ? b.error() : a.error());
            }
            c.measured += differingPixels(a->picture, b->picture);
        }
    }
    bench.record(std::move(c));
}

} // namespace

void unitScaleCases(Bench& bench) {
    for (const Table& table : kTables) {
        tenfoldCases(bench, table);
    }
    const Result<Scene> original = scaledScene(bench, 1.0, kTables[0].faintest, true);
    for (const int exponent : kPowersOfTwo) {
        if (!bench.reduced() || std::abs(exponent) != 1) {
            powerOfTwoCase(bench, original, exponent);
        }
    }
}

} // namespace slabcast::stability
