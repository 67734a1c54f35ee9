#include "core/plan/reasons.h"

#include <algorithm>
#include <iterator>
#include <string_view>

#include "core/plan/decisions/decision.h"
#include "core/plan/known_gpus.h"
#include "core/plan/settings_check.h"

namespace slabcast {

namespace {

/// Words of one reason. `{kind k}` stands for its numbers from the k-th on, as kKinds has it.
struct ReasonWords {
    ReasonId id;
    std::string_view what;
    std::string_view why;
};

constexpr std::string_view kWarning = "warning";

constexpr ReasonWords kWords[] = {
    {ReasonId::Layers, "layers {int 0}",
     "one every {num 1} mm ({num 2} voxels) over the bounding sphere's diameter of {num 3} mm"},
    {ReasonId::PlanarLattice, "planar lattice", "layers of equal view depth, as in the core paper"},
    {ReasonId::ShellsLattice, "shells lattice",
     "layers of equal distance from the eye: of one length at any field of view"},
    {ReasonId::PlanarLatticeHere, "planar lattice",
     "auto: layers of equal view depth; a software driver draws them faster than shells, and they "
     "swim when a head turns"},
    {ReasonId::ShellsLatticeHere, "shells lattice",
     "auto: layers of equal distance from the eye stay where they are when a head turns, and are "
     "of one length, whose opacity need not be made along every ray"},
    {ReasonId::Jitter, "jitter",
     "each ray's layers are moved by up to half a layer: grain, not bands"},
    {ReasonId::RatioAsked, "ratio {ratio 0}", "asked for"},
    {ReasonId::RatioOfFewerPlanes, "ratio {ratio 0}",
     "fewer planes than asked for hold all layers"},
    {ReasonId::RatioUnmeasured, "ratio {ratio 0}", "nothing was measured: {rule 3}"},
    {ReasonId::RatioFastest, "ratio {ratio 0}",
     "fastest of those measured on this device: {measured 0}"},
    {ReasonId::ClassificationOfIntervals, "classification {classification 0}",
     "opacity is exact, but for the table's, along whatever length the field is linear; colour is "
     "off by at most {num 1} (views of up to 120 degrees)"},
    {ReasonId::ClassificationUnlit, "classification {classification 0}",
     "no shading: no gradients are fetched"},
    {ReasonId::ClassificationLit, "classification {classification 0}",
     "shaded per sample, by the gradient of six samples around it"},
    {ReasonId::ClassificationLitByNormals, "classification {classification 0}",
     "shaded per sample, by normals that were baked: off the gradient of six samples by {num 2} "
     "degrees on average, 95 % of them by less than {num 3}"},
    {ReasonId::ClassificationBaked, "classification {classification 0}",
     "shading is baked into the texels"},
    {ReasonId::LengthsBaked, "opacity baked",
     "all layers are of one length: the table, or the texels, hold their opacity"},
    {ReasonId::LengthsPerRay, "opacity per ray",
     "a layer's opacity is made from its length along the ray"},
    {ReasonId::TableFiltered, "table filtered",
     "one fetch: the device's filter keeps zero between zeros"},
    {ReasonId::TableFetched, "table fetched",
     "two texels, interpolated in float32: exact, or the device's filter is not to be used"},
    {ReasonId::WideTableWarning, kWarning,
     "extinction spans more decades than a pre-integrated table keeps: the faintest is drawn too "
     "dense; post-classification keeps it"},
    {ReasonId::OneMaterial, "one material",
     "the transfer function is constant over the data, so is its table"},
    {ReasonId::ExactField, "exact field",
     "the volume's texels are fetched and interpolated in float32, not filtered"},
    {ReasonId::SkipNotBuilt, "skip none", "no skip structure was built for this look"},
    {ReasonId::SkipNoneAsked, "skip none", "asked for"},
    {ReasonId::SkipAsked, "skip {skip 0}", "asked for; {occupancy 0}"},
    {ReasonId::SkipNothingEmpty, "skip none",
     "auto: {occupancy 0}: above {num 3} % looks cost more than they save"},
    {ReasonId::SkipThinPlanes, "skip none", "auto: {looks 3}"},
    {ReasonId::SkipChosen, "skip {skip 0}", "auto: only {occupancy 0}, and {looks 3}"},
    {ReasonId::TargetOfLinearLight, "target rgba16f",
     "linear light in 8 bits would band in the shadows"},
    {ReasonId::TargetRgba8, "target rgba8", "blended in 8 bits, the cheapest on a mobile GPU"},
    {ReasonId::TargetRgba16f, "target rgba16f",
     "keeps what 8 bits would round away at every plane"},
    {ReasonId::Rgba8LosesAllWarning, kWarning,
     "even the densest material adds only {num 0} per plane: rgba8 rounds all of it away (below "
     "1/510); --target rgba16f or fewer planes keep it"},
    {ReasonId::Rgba8LosesFaintWarning, kWarning,
     "even the densest material adds only {num 0} per plane: rgba8 is off by up to {num 1} % of it "
     "and loses all that is below 1/510; --target rgba16f or fewer planes keep it"},
    {ReasonId::Rgba16fLosesFaintWarning, kWarning,
     "even the densest material adds only {num 0} per plane: rgba16f keeps 11 bits of what {int 1} "
     "planes gather and may lose {num 2} % of it; fewer planes keep it"},
    {ReasonId::OrderAsked, "{order 0}", "asked for"},
    {ReasonId::OrderWithoutTermination, "{order 0}",
     "without termination nothing is left out behind opaque material"},
    {ReasonId::OrderOfOnePlane, "{order 0}", "one plane"},
    {ReasonId::OrderTooThin, "{order 0}",
     "even the densest material takes {num 1} of {int 2} layers to make a ray opaque"},
    {ReasonId::OrderTargetRounds, "{order 0}",
     "{target 1} rounds away what would make a pixel opaque"},
    {ReasonId::OrderFrontToBack, "{order 0}",
     "a ray may be opaque after {num 1} of {int 2} planes: those behind are left out"},
    {ReasonId::FetchedTarget, "fetched target",
     "segments see what is before them and are left as they begin"},
    {ReasonId::NoMarks, "no marks", "a ray takes {num 0} of {int 1} planes to be opaque"},
    {ReasonId::Marks, "marks every {int 0} planes",
     "opaque pixels are marked in depth, planes behind fail there early; no ray is opaque before "
     "{num 1} planes, and {num 2} balance the marks' cost with that of planes drawn in vain"},
    {ReasonId::TerminationNotAsked, "no termination", "asked for"},
    {ReasonId::TerminationAcross, "termination at {fixed 0}",
     "rays are left early, on whichever plane"},
    {ReasonId::TerminationOfOneLayer, "no termination",
     "a segment of one layer has nothing to leave out"},
    {ReasonId::TerminationTooThin, "no termination",
     "no segment under this transfer function can become opaque enough"},
    {ReasonId::TerminationOfSegments, "termination at {fixed 0}", "dense segments are left early"},
    {ReasonId::TightPlanes, "tight planes",
     "each plane is the rectangle around what is visible in its slab"},
    {ReasonId::SphereOutlines, "10-gons", "each plane covers the bounding sphere's slice"},
    {ReasonId::NoCut, "no interval",
     "nothing visible is near the volume's faces: samples outside read what is invisible"},
    {ReasonId::CutWhileEdited, "interval box",
     "the transfer function is edited: it may come to show the volume's faces"},
    {ReasonId::CutInWideOutlines, "interval box",
     "planes are wider than what is visible: rays that miss the volume are left out"},
    {ReasonId::CutAtFaces, "interval box",
     "something visible may be at the volume's faces: layers there are weighed by their length "
     "inside"},
    {ReasonId::CutSparesFetches, "interval box", "layers outside would take eight fetches each"},
    {ReasonId::CutAtPlane, "interval box",
     "a segment's groups of layers may reach beyond its plane's"},
    {ReasonId::DrawsNothing, "draws nothing",
     "the transfer function makes no value of this volume visible: no program is compiled, no "
     "texture made, no plane drawn"},
};

constexpr bool everyReasonHasItsWords() {
    for (std::size_t k = 0; k < std::size(kWords); ++k) {
        if (kWords[k].id != static_cast<ReasonId>(k)) {
            return false;
        }
    }
    return std::size(kWords) == static_cast<std::size_t>(ReasonId::DrawsNothing) + 1;
}
static_assert(everyReasonHasItsWords());

/// How much of the structure's blocks the transfer function makes visible. An octree's fraction is
/// that of larger nodes where it has many leaves. Numbers: structure, percentage, block edge.
std::string occupancy(const double* numbers) {
    const bool octree = isOctree(static_cast<SkipStructure>(numbers[0]));
    return (octree ? "at most " : "") + shortNumber(numbers[1]) + " % of the " +
           std::to_string(static_cast<int>(numbers[2])) + "-voxel " +
           (octree ? "leaves" : "blocks") + " hold something visible under this transfer function";
}

/// What auto goes by, beside the occupancy. Numbers: layers per plane, LooksCost.
std::string costOfLooks(const double* numbers) {
    const auto cost = static_cast<LooksCost>(numbers[1]);
    return cost == LooksCost::SpareEightFetches
               ? "a look spares layers of 8 fetches"
               : "planes of " + std::to_string(static_cast<int>(numbers[0])) +
                     " layers (a look at the structure pays from " +
                     std::to_string(kFewestLayersToSkip) + " on, as measured on a software driver" +
                     (cost == LooksCost::AsMeasuredHere ? ", which this is)"
                                                        : ", not on this device)");
}

std::string ruleOfRatio(const double* numbers) {
    switch (static_cast<RatioRule>(numbers[0])) {
    case RatioRule::WholeRays:
        return "a software driver loops over whole rays, which says nothing of a GPU";
    case RatioRule::Modelled:
        return std::string("a model's best on ") +
               kKnownGpus[static_cast<std::size_t>(numbers[1])].title + ", for volumes like this";
    case RatioRule::Middle:
        break;
    }
    return "the middle of the range that is best on phones";
}

std::string measuredRatios(const FramePlan& plan) {
    std::string all;
    for (const RatioMeasurement& one : plan.measured) {
        all += (all.empty() ? "" : ", ") + name(one.ratio) + " " + shortNumber(one.frameMs) + " ms";
    }
    return all;
}

/// The ways to write numbers out.
constexpr struct {
    std::string_view name;
    std::string (*write)(const FramePlan& plan, const double* numbers);
} kKinds[] = {
    {"int", [](const FramePlan&, const double* n) { return std::to_string(static_cast<int>(*n)); }},
    {"num", [](const FramePlan&, const double* n) { return shortNumber(*n); }},
    {"fixed", [](const FramePlan&, const double* n) { return std::to_string(*n); }},
    {"ratio",
     [](const FramePlan&, const double* n) {
         return name(Ratio{static_cast<int>(n[0]), static_cast<int>(n[1]),
                           n[2] != 0.0 ? SegmentForm::Unrolled : SegmentForm::Loop});
     }},
    {"classification",
     [](const FramePlan&, const double* n) {
         return std::string(name(static_cast<Classification>(*n)));
     }},
    {"skip", [](const FramePlan&,
                const double* n) { return std::string(name(static_cast<SkipStructure>(*n))); }},
    {"target", [](const FramePlan&,
                  const double* n) { return std::string(name(static_cast<TargetFormat>(*n))); }},
    {"order", [](const FramePlan&,
                 const double* n) { return std::string(name(static_cast<BlendOrder>(*n))); }},
    {"occupancy", [](const FramePlan&, const double* n) { return occupancy(n); }},
    {"looks", [](const FramePlan&, const double* n) { return costOfLooks(n); }},
    {"rule", [](const FramePlan&, const double* n) { return ruleOfRatio(n); }},
    {"measured", [](const FramePlan& plan, const double*) { return measuredRatios(plan); }},
};

std::string written(std::string_view words, const FramePlan& plan, const Reason& reason) {
    std::string text;
    while (true) {
        const std::size_t open = words.find('{');
        text += words.substr(0, open);
        if (open == std::string_view::npos) {
            return text;
        }
        const std::size_t space = words.find(' ', open);
        const std::size_t close = words.find('}', space);
        const std::string_view kindName = words.substr(open + 1, space - open - 1);
        const auto kind = std::find_if(std::begin(kKinds), std::end(kKinds),
                                       [=](const auto& one) { return one.name == kindName; });
        SLABCAST_EXPECTS(kind != std::end(kKinds) && close == space + 2, open);
        const auto first = static_cast<std::size_t>(words[space + 1] - '0');
        text += kind->write(plan, reason.numbers.data() + first);
        words.remove_prefix(close + 1);
    }
}

} // namespace

std::vector<ReasonText> explained(const FramePlan& plan) {
    std::vector<ReasonText> texts;
    for (const Reason& reason : plan.reasons) {
        const ReasonWords& words = kWords[static_cast<std::size_t>(reason.id)];
        texts.push_back({written(words.what, plan, reason), written(words.why, plan, reason)});
    }
    return texts;
}

bool isWarning(ReasonId id) {
    return kWords[static_cast<std::size_t>(id)].what == kWarning;
}

bool warns(const FramePlan& plan) {
    return std::any_of(plan.reasons.begin(), plan.reasons.end(),
                       [](const Reason& reason) { return isWarning(reason.id); });
}

} // namespace slabcast
