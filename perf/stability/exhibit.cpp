#include "perf/stability/exhibit.h"

#include <algorithm>

namespace slabcast::stability {

namespace {

const char* const kUniformReason =
    "alpha = 1 - exp(-extinction x chord), the chord from the box's six faces; a pixel's own bound "
    "is what alpha changes by where the box grows or shrinks by float32's part in the ray (2^-22 "
    "of "
    "the terms of a position, 2^-21 of the layers' number), 2^-21 per layer, and the target's "
    "rounding at every plane that the ray meets, as seen through what lies in front (fp16: 2^-11; "
    "8 "
    "bits: 1/510 for colour, opacity and their product each)";

const char* const kIntegralReason =
    "the integral of the continuous model; a pixel's own bound adds to that of the samples what "
    "sampling may cost: each layer stands for its length by the material in its middle, and along "
    "it the field's values bound what the TF makes of them";

const char* const kSamplesReason =
    "float64 over the same samples; a pixel's own bound adds, layer by layer and weighted by the "
    "transmittance before it, the spread of the classification over what the field's format and "
    "filter, float32 positions (2^-22 of the terms they are summed from) and the table's weights "
    "may do, and the target's rounding at every plane that the ray meets (fp16: 2^-11; 8 bits: "
    "1/510 for colour, opacity and their product each)";

bool showsSomething(const Picture& picture) {
    return std::any_of(picture.pixels.begin(), picture.pixels.end(),
                       [](glm::vec4 pixel) { return pixel.a > 0.0F; });
}

Case caseOf(const Exhibit& exhibit, const std::string& what) {
    return {.family = exhibit.family, .name = exhibit.name + ", " + what};
}

/// Puts the exhibit through all methods and judges each picture by its pixels' own bounds; where no
/// pixel could fail the case does. `expectedOf` depends on the plan's lattice alone, which methods
/// share. `watch` sees every picture.
struct Trial {
    std::string what;
    std::string reason;
    double extinctionPerMm; // at least, of whatever lies in front of a plane
    std::function<ExpectedPicture(const FramePlan&)> expectedOf;
    std::function<void(const Picture&)> watch{};
    /// Not slicing into 8 bits: so many planes may err by more than there is to be seen.
    bool manyPlanes = false;
};

void run(Bench& bench, const Exhibit& exhibit, const Trial& trial) {
    ExpectedPicture expected;
    for (const Method& method : methods()) {
        const bool slicing8Bits =
            method.layersPerPlane == 1 && method.target == TargetFormat::Rgba8;
        if (trial.manyPlanes && slicing8Bits) {
            continue;
        }
        Case result = caseOf(exhibit, trial.what + method.name);
        result.quantity = "worst share of a pixel's own bound";
        result.bound = 1.0;
        result.reason = trial.reason;
        const auto judgeIt = [&](Case& c, const Drawn& drawn) {
            if (expected.empty()) {
                expected = trial.expectedOf(drawn.plan);
            }
            const Verdict verdict =
                judge(exhibit, drawn.picture, expected,
                      blendingBounds(exhibit, drawn.plan, trial.extinctionPerMm));
            c.measured = verdict.share;
            c.failure = verdict.lit > 0 ? "" : "no pixel shows anything that could fail";
            if (drawn.plan.planes == 1 && drawn.plan.target == TargetFormat::Rgba8) {
                c.pictures.push_back({c.name, drawn.picture});
            }
            if (trial.watch) {
                trial.watch(drawn.picture);
            }
        };
        bench.examine(std::move(result), exhibit.scene, settingsFor(exhibit, method), exhibit.view,
                      exhibit.size, judgeIt);
    }
}

} // namespace

Settings settingsFor(const Exhibit& exhibit, const Method& method) {
    Settings settings = settingsOf(method);
    settings.lattice = exhibit.lattice;
    settings.layerSpacingVoxels = exhibit.layerSpacingVoxels;
    settings.shaded = exhibit.scene.provided()->shaded;
    return settings;
}

void recordAgainstSamples(Bench& bench, const Exhibit& exhibit) {
    Case finite = caseOf(exhibit, "all methods");
    finite.quantity = "components that are NaN or infinite";
    finite.reason = "nothing divides by zero or overflows";
    run(bench, exhibit,
        {.what = "",
         .reason = kSamplesReason,
         .extinctionPerMm = 0.0,
         .expectedOf = [&](const FramePlan& plan) { return expectedFromSamples(exhibit, plan); },
         .watch = [&](const Picture& p) { finite.measured += nonFiniteComponents(p); }});
    bench.record(std::move(finite));
}

void recordUniform(Bench& bench, const Exhibit& exhibit, double extinctionPerMm, glm::dvec3 color,
                   const std::function<void(ExpectedPicture&)>& adjust) {
    const auto expectedOf = [&](const FramePlan& plan) {
        ExpectedPicture expected = expectedOfUniform(exhibit, plan, extinctionPerMm, color);
        if (adjust) {
            adjust(expected);
        }
        return expected;
    };
    run(bench, exhibit, {"one material, ", kUniformReason, extinctionPerMm, expectedOf});
}

void recordAgainst(Bench& bench, const Exhibit& exhibit, const std::string& reason,
                   ExpectedPicture expected) {
    run(bench, exhibit, {"", reason, 0.0, [&](const FramePlan&) { return std::move(expected); }});
}

void recordAgainstIntegral(Bench& bench, const Exhibit& exhibit) {
    run(bench, exhibit,
        {.what = "against the integral, ",
         .reason = kIntegralReason,
         .extinctionPerMm = 0.0,
         .expectedOf = [&](const FramePlan& plan) { return expectedFromIntegral(exhibit, plan); },
         .manyPlanes = true});
}

void recordSkippingChangesNothing(Bench& bench, const Exhibit& exhibit) {
    Case result = caseOf(exhibit, "skipped against not");
    result.quantity = "pixels that differ in any bit, over all methods";
    result.reason = "what is skipped or lies outside tight planes is invisible, and the samples "
                    "stay where they are: the same operations on the same numbers";
    for (const Method& method : methods()) {
        if (bench.reduced() && method.target == TargetFormat::Rgba8) {
            continue;
        }
        Settings settings = settingsFor(exhibit, method);
        const Result<Drawn> plain = bench.draw(exhibit.scene, settings, exhibit.view, exhibit.size);
        if (!plain) {
            return bench.recordFailure(std::move(result), plain.error());
        }
        for (const SkipStructure skip : {SkipStructure::None, SkipStructure::Proximity}) {
            settings.skip = skip;
            settings.tighten = true;
            const Result<Drawn> other =
                bench.draw(exhibit.scene, settings, exhibit.view, exhibit.size);
            if (!other) {
                return bench.recordFailure(std::move(result), other.error());
            }
            result.measured += differingPixels(plain->picture, other->picture);
        }
    }
    bench.record(std::move(result));
}

void recordSamePicture(Bench& bench, const Exhibit& exhibit, const Scene& other,
                       const View& otherView, const std::string& reason) {
    for (const Method& method : methods()) {
        Case result = caseOf(exhibit, method.name);
        result.quantity = "pixels that differ in any bit";
        result.reason = reason;
        const Settings settings = settingsFor(exhibit, method);
        const Result<Drawn> a = bench.draw(exhibit.scene, settings, exhibit.view, exhibit.size);
        const Result<Drawn> b = bench.draw(other, settings, otherView, exhibit.size);
        if (!a || !b) {
            bench.recordFailure(std::move(result), a ? b.error() : a.error());
            continue;
        }
        result.measured = differingPixels(a->picture, b->picture);
        if (!showsSomething(a->picture)) {
            result.failure = "nothing is to be seen that could differ";
        }
        bench.record(std::move(result));
    }
}

} // namespace slabcast::stability
