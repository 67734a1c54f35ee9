#include <algorithm>
#include <cmath>

#include "perf/stability/symmetry.h"

namespace slabcast::stability {

namespace {

constexpr OrbitCamera kCamera{37.0, 23.0, 2.4};
constexpr int kEvery = 5; // of the 48, in the reduced set

glm::ivec2 sizeOf(const Bench& bench) {
    return glm::ivec2(bench.reduced() ? 12 : 24);
}

VolumeGeometry obliqueGeometry() {
    return {.dims = {14, 10, 18},
            .spacingMm = {0.8, 1.3, 0.6},
            .originMm = {12.0, -8.0, 4.0},
            .direction = obliqueAxes()};
}

const char* const kStoredReason =
    "the same field at the same places: two pictures differ by what each differs from float64 over "
    "the same samples, whose bound adds, layer by layer, positions off by 2^-22 of the terms that "
    "they are summed from, an interpolation in another order of axes (2^-21 of the data's range) "
    "and the table's steps, and the target's rounding (float32: 2^-24, fp16: 2^-11)";
const char* const kFilteredReason =
    "as for the stored axes, and the filter's weights of eight bits (3/256 of a cell's range and "
    "one step of the format); the target rounds at every plane that the ray meets";
const char* const kDoubleReason =
    "as drawn, with float64's roundoff for float32's: 2^-29 of that bound";
const char* const kSameBitsReason =
    "no weight to round differently: the field varies along one axis at most, so that the other "
    "two interpolations add zero; spacings are powers of two; entry and exit are the greatest and "
    "least of three numbers, in whatever order. Axes change places, no number changes";

/// A scene of each way to store the field, what it is expected to show, and the first one's view.
struct Stored {
    std::string name;
    Scene scene;
    ExpectedPicture expected;
};

Exhibit exhibitOf(const Scene& scene, const View& view, glm::ivec2 size) {
    return {.family = kSymmetryFamily, .name = "", .scene = scene, .view = view, .size = size};
}

/// Of scenes in display space, unlit; by the plan of `settings`.
Result<std::vector<Stored>> storedScenes(Bench& bench, bool exact, int every) {
    std::vector<Stored> result;
    std::optional<View> view;
    const std::vector<Storage> storages = allStorages();
    for (std::size_t i = 0; i < storages.size(); i += std::size_t(every)) {
        Result<Scene> scene =
            bench.scene(storedAs(storages[i], obliqueGeometry(), lopsided),
                        {.tf = lopsidedTransfer()}, {.structure = SkipStructure::None}, exact);
        if (!scene) {
            return tl::unexpected(scene.error());
        }
        const Result<FramePlan> plan = bench.plan(*scene, settingsOf(methods().back()));
        if (!plan) {
            return tl::unexpected(plan.error());
        }
        const glm::ivec2 size = sizeOf(bench);
        view = view.value_or(orbitView(*scene, kCamera, 40.0, size));
        ExpectedPicture expected = expectedFromSamples(exhibitOf(*scene, *view, size), *plan);
        result.push_back({storages[i].name(), std::move(*scene), std::move(expected)});
    }
    return result;
}

/// Float64 over the samples, as a device's picture would be.
double worstOfFloat64(const ExpectedPicture& a, const ExpectedPicture& b) {
    double worst = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        if (!a[i].atEdge && !b[i].atEdge) {
            const glm::dvec4 off = glm::abs(a[i].color - b[i].color);
            const double most = std::max({off.x, off.y, off.z, off.w});
            worst = largerOf(worst, most == 0.0 ? 0.0 : most / (a[i].bound + b[i].bound));
        }
    }
    return worst;
}

/// Each way to store against the original, drawn into float32; and float64 over the samples.
void recordStored(Bench& bench, const std::vector<Stored>& stored) {
    const glm::ivec2 size = sizeOf(bench);
    const View view = orbitView(stored[0].scene, kCamera, 40.0, size);
    Case exact{.family = kSymmetryFamily,
               .name = named({"stored along other axes", "float64 samples"}),
               .quantity = "worst share of both pictures' own bounds, over all ways to store",
               .bound = 0x1p-29,
               .reason = kDoubleReason};
    std::optional<Picture> original;
    for (const Stored& one : stored) {
        Case c{.family = kSymmetryFamily,
               .name = named({"stored along " + one.name, bench.finest().name}),
               .quantity = "worst share of both pictures' own bounds",
               .bound = 1.0,
               .reason = kStoredReason};
        const Result<FramePlan> plan = bench.plan(one.scene, settingsOf(methods().back()));
        const Result<Picture> drawn =
            plan ? bench.drawFinely(one.scene, *plan, view, size) : tl::unexpected(plan.error());
        if (!drawn) {
            bench.recordFailure(std::move(c), drawn.error());
            continue;
        }
        original = original.value_or(*drawn);
        exact.measured = largerOf(exact.measured, worstOfFloat64(one.expected, stored[0].expected));
        c.measured = shareOfBothBounds(*drawn, one.expected, *original, stored[0].expected,
                                       2.0 * bench.finest().rounding);
        bench.record(std::move(c));
    }
    bench.record(std::move(exact));
}

/// The same by every method, by the texture unit's filter; worst of the ways to store.
void recordFiltered(Bench& bench, const std::vector<Stored>& stored) {
    const glm::ivec2 size = sizeOf(bench);
    const View view = orbitView(stored[0].scene, kCamera, 40.0, size);
    for (const Method& method : methods()) {
        Case c{.family = kSymmetryFamily,
               .name = named({"stored along other axes", "filtered", method.name}),
               .quantity = "worst share of both pictures' own bounds, over ways to store",
               .bound = 1.0,
               .reason = kFilteredReason};
        std::optional<Drawn> original;
        for (const Stored& one : stored) {
            const Result<Drawn> drawn = bench.draw(one.scene, settingsOf(method), view, size);
            if (!drawn) {
                c.failure = drawn.error().detail;
                c.measured = std::nan("");
                break;
            }
            original = original.value_or(*drawn);
            c.measured =
                largerOf(c.measured,
                         shareOfBothBounds(drawn->picture, one.expected, original->picture,
                                           stored[0].expected, 2.0 * blendingBound(drawn->plan)));
        }
        bench.record(std::move(c));
    }
}

/// A field of sheets across the original's first axis, or of one value, under the six orders of
/// axes.
struct Plain {
    const char* name;
    double (*value)(glm::ivec3 v);
};
constexpr Plain kPlain[] = {{"sheets", [](glm::ivec3 v) { return 30.0 + v.x * 37 % 200; }},
                            {"one material", [](glm::ivec3) { return 100.0; }}};

void recordSameBits(Bench& bench, const Plain& plain, const Method& method) {
    const VolumeGeometry original{.dims = {16, 12, 8}, .spacingMm = {0.5, 1.0, 2.0}};
    const glm::ivec2 size = sizeOf(bench);
    Case c{.family = kSymmetryFamily,
           .name = named({"axes in another order", plain.name, method.name}),
           .quantity = "pixels that differ in any bit, over the orders of axes",
           .reason = kSameBitsReason};
    std::optional<View> view;
    std::optional<Picture> first;
    for (const Storage& storage : allStorages()) {
        if (storage.flipped != glm::ivec3(1)) {
            continue;
        }
        const Result<Scene> scene =
            bench.scene(storedAs(storage, original, plain.value), {.tf = lopsidedTransfer()},
                        {.structure = SkipStructure::None}, true);
        if (!scene) {
            return bench.recordFailure(std::move(c), scene.error());
        }
        view = view.value_or(orbitView(*scene, kCamera, 40.0, size));
        const Result<Drawn> drawn = bench.draw(*scene, settingsOf(method), *view, size);
        if (!drawn) {
            return bench.recordFailure(std::move(c), drawn.error());
        }
        first = first.value_or(drawn->picture);
        c.measured += differingPixels(*first, drawn->picture);
    }
    bench.record(std::move(c));
}

} // namespace

void storedAxesCases(Bench& bench) {
    const int every = bench.reduced() ? kEvery : 1;
    const Result<std::vector<Stored>> exact = storedScenes(bench, true, every);
    const Result<std::vector<Stored>> filtered = storedScenes(bench, false, 4 * every);
    if (!exact || !filtered) {
        return bench.recordFailure({.family = kSymmetryFamily, .name = "stored along other axes"},
                                   exact ? filtered.error() : exact.error());
    }
    recordStored(bench, *exact);
    recordFiltered(bench, *filtered);
    for (const Plain& plain : kPlain) {
        for (const Method& method : methods()) {
            recordSameBits(bench, plain, method);
        }
    }
}

} // namespace slabcast::stability
