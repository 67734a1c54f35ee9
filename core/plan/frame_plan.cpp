#include "core/plan/frame_plan.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "core/plan/settings_check.h"
#include "core/transfer/preintegrated.h"

namespace slabcast {

namespace {

/// Layers per plane where nothing was measured: the middle of the core paper's best range (Fig. 4).
constexpr int kUnmeasuredLayersPerPlane = 16;
/// Above this share of occupied blocks a skip fetch per layer costs more than the few layers that
/// it saves.
constexpr double kWorthSkipping = 0.95;
/// Below as many layers per plane a look at the structure costs what it saves: every plane needs
/// its own. On the skull 2 take a quarter more time with skipping than without, 4 as much, 8 a
/// tenth to a quarter less (llvmpipe).
constexpr int kFewestLayersToSkip = 4;
constexpr double kHalfStep8Bit = 0.5 / 255.0;
/// A plane that adds less is off by more than a quarter of it.
constexpr double kFaint8Bit = 4.0 * kHalfStep8Bit;
constexpr double kStepOfHalf = 0x1p-10; // of fp16, relative: a device may take either neighbour
constexpr double kMuchOfAll = 0.5;
constexpr double kHalfStepOfHalf = 0x1p-12; // of fp16 below 1
/// Front to back pays where the densest material makes a ray opaque within this share of the
/// lattice: what is usual in a volume takes many times that length. Measured on a CT skull under
/// bone presets of several opacities: 0.006 saves 4 to 5 layers in 10, 0.024 two, and times follow;
/// 0.04 saves less than one, 0.07 nearly none, and frames take as long or longer.
constexpr double kGoodPart = 0.025;
/// What a pass that marks costs per pixel, and what a plane's fragment costs beside its layers,
/// both in layers: measured on a software driver. A tiler also stores and loads the layer at a
/// mark.
constexpr double kLayersPerMark = 1.0;
constexpr double kLayersPerFragment = 4.0;
/// Up to this length of segments a software driver is faster with marks than where the shader sees
/// the target: they spare launching fragments, which a tiler does for less than a mark.
constexpr int kLaunchCounts = 4;

double halfStepBelowOne(TargetFormat format) {
    return format == TargetFormat::Rgba8 ? kHalfStep8Bit : kHalfStepOfHalf;
}

int planesFor(int total, int layersPerPlane) {
    return (total + layersPerPlane - 1) / layersPerPlane;
}

/// The decisions of one plan in the making: each writes what it chose and why.
struct Planner {
    const SceneFacts& facts;
    const Settings& settings;
    const gl::Caps& caps;
    FramePlan plan;

    void because(std::string what, std::string why) {
        plan.reasons.push_back({std::move(what), std::move(why)});
    }

    void chooseLattice() {
        const int total = totalLayers(settings, facts);
        const double spacing = settings.totalLayers
                                   ? 2.0 * facts.sphere.radiusMm / *settings.totalLayers
                                   : settings.layerSpacingVoxels * facts.smallestVoxelEdgeMm;
        plan.lattice = {settings.lattice, total, spacing, settings.jitter};
        because("layers " + std::to_string(total),
                "one every " + shortNumber(spacing) + " mm (" +
                    shortNumber(spacing / facts.smallestVoxelEdgeMm) +
                    " voxels) over the bounding sphere's diameter of " +
                    shortNumber(2.0 * facts.sphere.radiusMm) + " mm");
        because(std::string(name(settings.lattice)) + " lattice",
                settings.lattice == LatticeKind::Planar
                    ? "layers of equal view depth, as in the core paper"
                    : "layers of equal distance from the eye: of one length at any field of view");
        if (settings.jitter) {
            because("jitter",
                    "each ray's layers are moved by up to half a layer: grain, not bands");
        }
    }

    SegmentForm formFor(int layersPerPlane) const {
        if (settings.form != SegmentForm::Auto) {
            return settings.form;
        }
        return unrollLengthFor(layersPerPlane) == 0 || caps.isSoftware ? SegmentForm::Loop
                                                                       : SegmentForm::Unrolled;
    }

    Ratio dealtOut(int layersPerPlane, SegmentForm form) const {
        const int length = std::min(layersPerPlane, plan.lattice.total);
        return {planesFor(plan.lattice.total, length), length, form};
    }

    Ratio chooseRatio(std::span<const RatioMeasurement> measurements) {
        if (settings.planes || settings.layersPerPlane) {
            const int length = settings.layersPerPlane
                                   ? *settings.layersPerPlane
                                   : planesFor(plan.lattice.total, *settings.planes);
            const Ratio ratio = dealtOut(length, formFor(length));
            because("ratio " + name(ratio), settings.planes && ratio.planes < *settings.planes
                                                ? "fewer planes than asked for hold all layers"
                                                : "asked for");
            return ratio;
        }
        const auto best =
            std::min_element(measurements.begin(), measurements.end(),
                             [](const auto& a, const auto& b) { return a.frameMs < b.frameMs; });
        if (best == measurements.end()) {
            const Ratio ratio =
                dealtOut(kUnmeasuredLayersPerPlane, formFor(kUnmeasuredLayersPerPlane));
            because("ratio " + name(ratio), "nothing was measured on this device: a middle ratio");
            return ratio;
        }
        std::string all;
        for (const RatioMeasurement& m : measurements) {
            all += (all.empty() ? "" : ", ") + name(m.ratio) + " " + shortNumber(m.frameMs) + " ms";
        }
        // Dealt out anew: what was measured may have been of another number of layers.
        const Ratio ratio = dealtOut(best->ratio.layersPerPlane, best->ratio.form);
        because("ratio " + name(ratio), "fastest of those measured on this device: " + all);
        return ratio;
    }

    /// How much of the structure's blocks the TF makes visible. An octree's fraction is that of
    /// larger nodes where it has many leaves.
    std::string occupancy() const {
        const bool octree = isOctree(facts.skip.structure);
        return (octree ? "at most " : "") + shortNumber(100.0 * facts.occupiedFraction) +
               " % of the " + std::to_string(facts.skip.blockEdgeVoxels) + "-voxel " +
               (octree ? "leaves" : "blocks") +
               " hold something visible under this transfer function";
    }

    /// What auto goes by, beside the occupancy.
    std::string costOfLooks() const {
        return facts.exactField
                   ? "a look spares layers of 8 fetches"
                   : "planes of " + std::to_string(plan.layersPerPlane) +
                         " layers (a look at the structure pays from " +
                         std::to_string(kFewestLayersToSkip) +
                         " on, as measured on a software driver" +
                         (caps.isSoftware ? ", which this is)" : ", not on this device)");
    }

    /// The structure that was built, or none: asked for, or where it would not pay.
    void chooseSkip() {
        const SkipStructure built = facts.skip.structure;
        if (built == SkipStructure::None) {
            because("skip none", "no skip structure was built for this look");
        } else if (settings.skip == SkipStructure::None) {
            because("skip none", "asked for");
        } else if (settings.skip) {
            takeSkip("asked for; " + occupancy());
        } else if (facts.occupiedFraction > kWorthSkipping) {
            because("skip none", "auto: " + occupancy() + ": above " +
                                     shortNumber(100.0 * kWorthSkipping) +
                                     " % looks cost more than they save");
        } else if (plan.layersPerPlane < kFewestLayersToSkip && !facts.exactField) {
            because("skip none", "auto: " + costOfLooks());
        } else {
            takeSkip("auto: only " + occupancy() + ", and " + costOfLooks());
        }
    }

    void takeSkip(std::string why) {
        plan.skip = facts.skip.structure;
        plan.variant.skip = formOf(facts.skip);
        because(std::string("skip ") + name(plan.skip), std::move(why));
    }

    std::string reasonOfClassification() const {
        if (settings.classification == Classification::Preintegrated) {
            return "opacity is exact, but for the table's, along whatever length the field is "
                   "linear; colour is off by at most " +
                   shortNumber(facts.visibleColorRange * preintegratedColorError(mostDepthOf(1))) +
                   " (views of up to 120 degrees)";
        }
        if (!settings.shaded) {
            return "no shading: no gradients are fetched";
        }
        return settings.classification == Classification::Post ? "shaded per sample"
                                                               : "shading is baked into the texels";
    }

    /// Of the densest run of layers that this TF can make; obliqueness lengthens it by less than 2
    /// up to 120 degrees.
    double mostDepthOf(int layers) const {
        return facts.maxExtinctionPerMm * plan.lattice.spacingMm * layers * 2.0;
    }

    void chooseTermination() {
        if (!settings.termination) {
            because("no termination", "asked for");
            return;
        }
        if (plan.variant.fetchesTarget) {
            because("termination at " + std::to_string(*settings.termination),
                    "rays are left early, on whichever plane");
            return;
        }
        const double depth = mostDepthOf(plan.layersPerPlane);
        if (plan.layersPerPlane == 1 || 1.0 - std::exp(-depth) < *settings.termination) {
            because("no termination",
                    plan.layersPerPlane == 1
                        ? "a segment of one layer has nothing to leave out"
                        : "no segment under this transfer function can become opaque enough");
            return;
        }
        plan.variant.terminates = true;
        plan.terminationAlpha = *settings.termination;
        because("termination at " + std::to_string(*settings.termination),
                "dense segments are left early");
    }

    void chooseTarget() {
        plan.target = settings.target;
        plan.space = settings.space;
        if (settings.space == CompositingSpace::Linear && settings.target == TargetFormat::Rgba8) {
            plan.target = TargetFormat::Rgba16f;
            because("target rgba16f", "linear light in 8 bits would band in the shadows");
        } else {
            because(std::string("target ") + name(plan.target),
                    plan.target == TargetFormat::Rgba8
                        ? "blended in 8 bits, the cheapest on a mobile GPU"
                        : "keeps what 8 bits would round away at every plane");
        }
        warnOfRounding();
    }

    /// Of the densest material, straight ahead, until a ray is as good as opaque.
    double layersToSaturate() const {
        return -std::log1p(-*settings.termination) /
               (facts.maxExtinctionPerMm * plan.lattice.spacingMm);
    }
    double planesToSaturate() const { return std::ceil(layersToSaturate() / plan.layersPerPlane); }

    /// Alpha gathers until what a plane adds to it is rounded away.
    bool targetSaturates() const {
        FramePlan terminating = plan;
        terminating.terminationAlpha = *settings.termination;
        const double lacking = 1.0 - saturatedAlpha(terminating);
        const double most =
            -std::expm1(-facts.maxExtinctionPerMm * plan.lattice.spacingMm * plan.layersPerPlane);
        return lacking * most >= halfStepBelowOne(plan.target);
    }

    /// Why planes behind opaque material are not left out, or nothing where they can be.
    std::string obstacle() const {
        if (!settings.termination) {
            return "without termination nothing is left out behind opaque material";
        }
        if (plan.planes == 1) {
            return "one plane";
        }
        const double least = layersToSaturate();
        if (least > kGoodPart * plan.lattice.total) {
            return "even the densest material takes " + shortNumber(least) + " of " +
                   std::to_string(plan.lattice.total) + " layers to make a ray opaque";
        }
        return targetSaturates()
                   ? ""
                   : std::string(name(plan.target)) + " rounds away what would make a pixel opaque";
    }

    void chooseOrder() {
        const std::string against = obstacle();
        plan.order = settings.order.value_or(against.empty() ? BlendOrder::FrontToBack
                                                             : BlendOrder::BackToFront);
        const bool frontToBack = plan.order == BlendOrder::FrontToBack;
        because(name(plan.order),
                settings.order ? "asked for"
                : !against.empty()
                    ? against
                    : "a ray may be opaque after " + shortNumber(planesToSaturate()) + " of " +
                          std::to_string(plan.planes) + " planes: those behind are left out");
        if (!frontToBack || !settings.termination || plan.planes == 1) {
            return;
        }
        if (caps.framebufferFetch && !(caps.isSoftware && plan.layersPerPlane <= kLaunchCounts)) {
            plan.variant.terminates = true;
            plan.variant.fetchesTarget = true;
            because("fetched target",
                    "segments see what is before them and are left as they begin");
        } else {
            chooseMarks();
        }
        if (plan.variant.fetchesTarget || plan.planesPerMark > 0) {
            plan.terminationAlpha = *settings.termination;
        }
    }

    /// With N planes, a mark of the cost m after every k of them and planes of the cost f, marks
    /// cost N/k m, and a pixel that saturates is drawn on over k/2 planes on average: k = sqrt(2 N
    /// m/f) makes the sum least. Before a pixel can be opaque there is nothing to mark, so k is at
    /// least the number of planes which that takes.
    void chooseMarks() {
        const double planeCost = kLayersPerFragment + plan.layersPerPlane;
        const double balanced = std::sqrt(2.0 * plan.planes * kLayersPerMark / planeCost);
        const double apart = std::ceil(std::max(balanced, planesToSaturate()));
        if (!(apart < plan.planes)) {
            because("no marks", "a ray takes " + shortNumber(apart) + " of " +
                                    std::to_string(plan.planes) + " planes to be opaque");
            return;
        }
        plan.planesPerMark = static_cast<int>(apart);
        because("marks every " + std::to_string(plan.planesPerMark) + " planes",
                "opaque pixels are marked in depth, planes behind fail there early; no ray is "
                "opaque before " +
                    shortNumber(planesToSaturate()) + " planes, and " + shortNumber(balanced) +
                    " balance the marks' cost with that of planes drawn in vain");
    }

    /// Some material of a ramp from zero is always lost; it matters where even the densest is
    /// faint.
    void warnOfRounding() {
        const double most = 1.0 - std::exp(-facts.maxExtinctionPerMm * plan.lattice.spacingMm *
                                           plan.layersPerPlane);
        const bool eightBits = plan.target == TargetFormat::Rgba8;
        // What a plane's rounding takes shows through the planes before it.
        const double halfLost = kStepOfHalf * std::min<double>(plan.planes, 1.0 / most);
        if (!facts.anythingVisible || (eightBits ? most >= kFaint8Bit : halfLost < kMuchOfAll)) {
            return;
        }
        std::string lost = "rounds all of it away (below 1/510)";
        if (!eightBits) {
            lost = "keeps 11 bits of what " + std::to_string(plan.planes) +
                   " planes gather and may lose " + shortNumber(100.0 * std::min(1.0, halfLost)) +
                   " % of it";
        } else if (most >= kHalfStep8Bit) {
            lost = "is off by up to " + shortNumber(100.0 * kHalfStep8Bit / most) +
                   " % of it and loses all that is below 1/510";
        }
        because("warning", "even the densest material adds only " + shortNumber(most) +
                               " per plane: " + name(plan.target) + " " + lost +
                               (eightBits ? "; --target rgba16f or fewer planes keep it"
                                          : "; fewer planes keep it"));
    }
};

/// Everything but what it was made from and why. A new member does not compile until it is named
/// here.
auto decided(const FramePlan& plan) {
    const auto& [needs, look, lattice, planes, layers, variant, skip, tight, format, space, alpha,
                 order, marks, nothing, reasons] = plan;
    return std::tie(lattice, planes, layers, variant, skip, tight, format, space, alpha, order,
                    marks, nothing);
}

} // namespace

bool FramePlan::operator==(const FramePlan& other) const {
    return decided(*this) == decided(other);
}

const char* name(TargetFormat format) {
    return format == TargetFormat::Rgba8 ? "rgba8" : "rgba16f";
}

const char* name(BlendOrder order) {
    return order == BlendOrder::BackToFront ? "back-to-front" : "front-to-back";
}

double saturatedAlpha(const FramePlan& plan) {
    return plan.terminationAlpha - halfStepBelowOne(plan.target);
}

std::string name(const Ratio& ratio) {
    return std::to_string(ratio.planes) + "x" + std::to_string(ratio.layersPerPlane) +
           (ratio.form == SegmentForm::Unrolled ? " unrolled" : " loop");
}

int totalLayers(const Settings& settings, const SceneFacts& facts) {
    const int covering = settings.totalLayers.value_or(layersToCover(
        facts.sphere.radiusMm, settings.layerSpacingVoxels * facts.smallestVoxelEdgeMm));
    return covering + (settings.jitter ? 1 : 0); // moved by half a layer, they still cover
}

std::vector<Ratio> ratioCandidates(const Settings& settings, const SceneFacts& facts) {
    const int total = totalLayers(settings, facts);
    std::vector<Ratio> candidates;
    for (const int layers : {total, 64, 32, 16, 8, 1}) {
        for (const SegmentForm form : {SegmentForm::Loop, SegmentForm::Unrolled}) {
            const bool allowed = settings.form == SegmentForm::Auto || settings.form == form;
            const bool exists = form == SegmentForm::Loop || unrollLengthFor(layers) != 0;
            const Ratio ratio{planesFor(total, std::min(layers, total)), std::min(layers, total),
                              form};
            if (allowed && exists &&
                std::find(candidates.begin(), candidates.end(), ratio) == candidates.end()) {
                candidates.push_back(ratio);
            }
        }
    }
    return candidates;
}

Result<FramePlan> plan(const SceneFacts& facts, const Settings& settings, const gl::Caps& caps,
                       std::span<const RatioMeasurement> measurements) {
    if (Result<void> ok = check(settings, facts); !ok) {
        return tl::unexpected(ok.error());
    }
    Planner planner{facts, settings, caps, {}};
    planner.chooseLattice();
    if (planner.plan.lattice.total > kMaxTotalLayers) {
        return fail(ErrorCode::InvalidArgument,
                    "the layer spacing asks for " + std::to_string(planner.plan.lattice.total) +
                        " layers: at most 1048576; widen --layer-spacing");
    }
    const Ratio ratio = planner.chooseRatio(measurements);
    if (ratio.form == SegmentForm::Unrolled && unrollLengthFor(ratio.layersPerPlane) == 0) {
        return fail(ErrorCode::InvalidArgument,
                    "segments of " + std::to_string(ratio.layersPerPlane) +
                        " layers are too long to unroll: at most " +
                        std::to_string(kUnrollLengths.back()) + ", or the loop form");
    }
    FramePlan& result = planner.plan;
    result.needs = needsOf(settings);
    result.look = facts.look;
    result.planes = ratio.planes;
    result.layersPerPlane = ratio.layersPerPlane;
    result.variant.unroll =
        ratio.form == SegmentForm::Unrolled ? unrollLengthFor(ratio.layersPerPlane) : 0;
    result.variant.classification = settings.classification;
    result.variant.exactField = facts.exactField && settings.classification != Classification::Pre;
    result.variant.shaded = settings.shaded && settings.classification == Classification::Post;
    planner.because(std::string("classification ") + name(settings.classification),
                    planner.reasonOfClassification());
    if (facts.wideTable && settings.classification == Classification::Preintegrated) {
        planner.because("warning",
                        "extinction spans more decades than a pre-integrated table keeps: "
                        "the faintest is drawn too dense; post-classification keeps it");
    }
    if (facts.oneMaterial) {
        planner.because("one material",
                        "the transfer function is constant over the data, so is its table");
    }
    if (result.variant.exactField) {
        planner.because(
            "exact field",
            "the volume's texels are fetched and interpolated in float32, not filtered");
    }
    planner.chooseSkip();
    planner.chooseTarget();
    planner.chooseOrder();
    planner.chooseTermination();
    result.tighten = settings.tighten && facts.skip.structure != SkipStructure::None;
    planner.because(result.tighten ? "tight planes" : "10-gons",
                    result.tighten
                        ? "each plane is the rectangle around what is visible in its slab"
                        : "each plane covers the bounding sphere's slice");
    result.drawsNothing = !facts.anythingVisible;
    if (result.drawsNothing) {
        planner.because("draws nothing",
                        "the transfer function makes no value of this volume visible: "
                        "no program is compiled, no texture made, no plane drawn");
    }
    return std::move(planner.plan);
}

} // namespace slabcast
