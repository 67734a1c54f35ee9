#include "core/plan/frame_plan.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <set>

#include <gtest/gtest.h>

#include "core/plan/shader_axes.h"
#include "tests/support/frame_scene.h"

namespace slabcast {
namespace {

using test::Dice;

/// A head CT under a bone preset, say: half of it empty.
SceneFacts boneFacts() {
    return {.sphere = {glm::dvec3(0.0), 222.0},
            .smallestVoxelEdgeMm = 1.0,
            .occupiedFraction = 0.5,
            .maxExtinctionPerMm = 2.0};
}

const gl::Caps kHeadset{};
const gl::Caps kSoftware = [] {
    gl::Caps caps;
    caps.isSoftware = true;
    return caps;
}();

FramePlan planned(const Settings& settings, const SceneFacts& facts = boneFacts(),
                  const gl::Caps& caps = kHeadset) {
    const Result<FramePlan> result = plan(facts, settings, caps, {});
    EXPECT_TRUE(result.has_value()) << result.error().detail;
    return *result;
}

/// The reason whose `what` starts like that, in words.
std::optional<ReasonText> reasonFor(const FramePlan& plan, const std::string& start) {
    const std::vector<ReasonText> reasons = explained(plan);
    const auto found = std::find_if(reasons.begin(), reasons.end(), [&](const ReasonText& r) {
        return r.what.rfind(start, 0) == 0;
    });
    return found == reasons.end() ? std::nullopt : std::optional(*found);
}

/// Any settings within their ranges.
Settings randomSettings(Dice& dice) {
    Settings s;
    s.classification = static_cast<Classification>(dice.below(3));
    if (dice.chance(0.5)) {
        s.skip = dice.chance(0.5) ? SkipStructure::None : SkipStructure::Proximity;
    }
    s.lattice = dice.chance(0.5) ? LatticeKind::Planar : LatticeKind::Shells;
    s.layerSpacingVoxels = dice.logUniform(0.1, 100.0);
    if (dice.chance(0.5)) {
        s.totalLayers = 1 + dice.below(1000);
    }
    const int dealt = dice.below(3);
    if (dealt == 1) {
        s.planes = 1 + dice.below(600);
    } else if (dealt == 2) {
        s.layersPerPlane = 1 + dice.below(600);
    }
    s.form = dice.chance(0.5) ? SegmentForm::Auto : SegmentForm::Loop;
    s.tighten = dice.chance(0.5);
    s.target = dice.chance(0.5) ? TargetFormat::Rgba8 : TargetFormat::Rgba16f;
    s.space = dice.chance(0.5) ? CompositingSpace::Display : CompositingSpace::Linear;
    s.shaded = s.classification != Classification::Preintegrated && dice.chance(0.5);
    s.normals = dice.chance(0.5) ? Normals::Computed : Normals::Baked;
    if (dice.chance(0.3)) {
        s.termination.reset();
    }
    if (dice.chance(0.5)) {
        s.order = dice.chance(0.5) ? BlendOrder::BackToFront : BlendOrder::FrontToBack;
    }
    return s;
}

SceneFacts randomFacts(Dice& dice) {
    SceneFacts facts = boneFacts();
    facts.sphere.radiusMm = dice.logUniform(1.0, 400.0);
    facts.smallestVoxelEdgeMm = dice.logUniform(0.1, 5.0);
    facts.exactField = dice.chance(0.5);
    facts.anythingVisible = dice.chance(0.8);
    facts.occupiedFraction = dice.uniform(0.0, 1.0);
    facts.maxExtinctionPerMm = dice.logUniform(1e-6, 100.0);
    facts.filtersTable = dice.chance(0.5);
    facts.facesAreClear = dice.chance(0.5);
    facts.isEdited = dice.chance(0.2);
    return facts;
}

/// What must hold of every plan, whatever it was asked.
void expectSound(const FramePlan& p, const Settings& s, const SceneFacts& facts) {
    EXPECT_GE(std::int64_t{p.planes} * p.layersPerPlane, p.lattice.total);
    EXPECT_GE(p.lattice.total * p.lattice.spacingMm, 2.0 * facts.sphere.radiusMm * (1.0 - 1e-11));
    EXPECT_EQ(p.lattice.total, totalLayers(s, facts));
    EXPECT_EQ(p.lattice.kind, s.lattice.value_or(p.lattice.kind));
    EXPECT_TRUE(p.variant.valid()) << name(p.variant);
    EXPECT_FALSE(p.variant.counts);
    EXPECT_TRUE(p.variant.unroll == 0 || p.variant.unroll >= p.layersPerPlane);
    EXPECT_EQ(p.variant.terminates || p.planesPerMark > 0, p.terminationAlpha < 1.0);
    EXPECT_LT(p.planesPerMark, p.planes);
    EXPECT_FALSE(p.variant.fetchesTarget && p.planesPerMark > 0);
    if (p.order == BlendOrder::BackToFront) {
        EXPECT_FALSE(p.variant.fetchesTarget || p.planesPerMark > 0);
    }
    EXPECT_EQ(p.drawsNothing, !facts.anythingVisible);
    const bool narrowLinear =
        p.space == CompositingSpace::Linear && p.target == TargetFormat::Rgba8;
    EXPECT_FALSE(narrowLinear);
}

/// One reason for each choice, named as it was made, each on one line.
void expectExplained(const FramePlan& p, const Settings& s, const SceneFacts& facts) {
    const Ratio ratio{p.planes, p.layersPerPlane,
                      p.variant.unroll > 0 ? SegmentForm::Unrolled : SegmentForm::Loop};
    std::vector<std::string> choices = {
        "layers " + std::to_string(p.lattice.total),
        std::string(name(p.lattice.kind)) + " lattice",
        "ratio " + name(ratio),
        std::string("classification ") + name(p.variant.classification),
        std::string("skip ") + name(p.skip),
        p.variant.terminates ? "termination" : "no termination",
        p.tighten ? "tight planes" : "10-gons",
        std::string("target ") + name(p.target),
        name(p.order),
        p.variant.lengths == Lengths::Baked ? "opacity baked" : "opacity per ray",
        p.variant.interval == Interval::Box ? "interval box" : "no interval",
    };
    if (p.variant.classification == Classification::Post) {
        choices.push_back(p.variant.table == TableRead::Filtered ? "table filtered"
                                                                 : "table fetched");
    }
    if (p.variant.fetchesTarget) {
        choices.push_back("fetched target");
    } else if (p.planesPerMark > 0) {
        choices.push_back("marks every " + std::to_string(p.planesPerMark) + " planes");
    } else if (p.order == BlendOrder::FrontToBack && s.termination && p.planes > 1) {
        choices.push_back("no marks");
    }
    if (p.drawsNothing) {
        choices.push_back("draws nothing");
    }
    if (facts.exactField && p.variant.classification != Classification::Pre) {
        choices.push_back("exact field");
    }
    for (const std::string& choice : choices) {
        EXPECT_NE(reasonFor(p, choice), std::nullopt) << choice;
    }
    std::set<std::string> whats;
    for (const ReasonText& reason : explained(p)) {
        EXPECT_FALSE(reason.why.empty()) << reason.what;
        EXPECT_EQ((reason.what + reason.why).find('\n'), std::string::npos);
        whats.insert(reason.what);
    }
    EXPECT_EQ(whats.size(), p.reasons.size());
    EXPECT_LE(p.reasons.size(), choices.size() + 1); // and at most a warning
}

TEST(FramePlan, IsSoundAndExplainedForAnySettings) {
    Dice dice(1);
    for (int k = 0; k < 3000; ++k) {
        const Settings settings = randomSettings(dice);
        const SceneFacts facts = randomFacts(dice);
        gl::Caps caps = dice.chance(0.5) ? kHeadset : kSoftware;
        caps.framebufferFetch = dice.chance(0.5);
        const Result<FramePlan> first = plan(facts, settings, caps, {});
        ASSERT_TRUE(first.has_value()) << first.error().detail;
        expectSound(*first, settings, facts);
        expectExplained(*first, settings, facts);
        EXPECT_EQ(*first, *plan(facts, settings, caps, {})); // pure
    }
}

TEST(FramePlan, DiffersWhereAPictureWould) {
    const FramePlan base = planned({});
    const Settings changed[] = {
        {.classification = Classification::Pre},
        {.classification = Classification::Preintegrated},
        {.skip = SkipStructure::None},
        {.lattice = LatticeKind::Planar},
        {.layerSpacingVoxels = 0.5},
        {.totalLayers = 100},
        {.planes = 3},
        {.layersPerPlane = 8},
        {.form = SegmentForm::Loop},
        {.tighten = false},
        {.target = TargetFormat::Rgba16f},
        {.space = CompositingSpace::Linear},
        {.shaded = true},
        {.termination = std::nullopt},
    };
    for (const Settings& settings : changed) {
        EXPECT_NE(planned(settings), base);
    }
    EXPECT_EQ(planned({}), base);
}

TEST(FramePlan, IsEqualWhateverWasMeasuredOnTheWay) {
    const Ratio ratio{28, 16, SegmentForm::Unrolled};
    const RatioMeasurement fast[] = {{ratio, 3.0}};
    const RatioMeasurement slow[] = {{ratio, 4.0}};
    const FramePlan base = *plan(boneFacts(), {}, kHeadset, fast);
    const FramePlan again = *plan(boneFacts(), {}, kHeadset, slow);
    EXPECT_NE(explained(base), explained(again));
    EXPECT_EQ(base, again);
}

TEST(FramePlan, IsUnequalInAnyOtherMember) {
    const std::pair<const char*, void (*)(FramePlan&)> changes[] = {
        {"lattice", [](FramePlan& p) { p.lattice.kind = LatticeKind::Planar; }},
        {"lattice", [](FramePlan& p) { ++p.lattice.total; }},
        {"lattice", [](FramePlan& p) { p.lattice.spacingMm *= 2.0; }},
        {"lattice", [](FramePlan& p) { p.lattice.jittered = true; }},
        {"planes", [](FramePlan& p) { ++p.planes; }},
        {"layersPerPlane", [](FramePlan& p) { ++p.layersPerPlane; }},
        {"skip", [](FramePlan& p) { p.skip = SkipStructure::Blocks; }},
        {"tighten", [](FramePlan& p) { p.tighten = !p.tighten; }},
        {"target", [](FramePlan& p) { p.target = TargetFormat::Rgba16f; }},
        {"space", [](FramePlan& p) { p.space = CompositingSpace::Linear; }},
        {"terminationAlpha", [](FramePlan& p) { p.terminationAlpha = 0.5; }},
        {"order", [](FramePlan& p) { p.order = BlendOrder::BackToFront; }},
        {"planesPerMark", [](FramePlan& p) { ++p.planesPerMark; }},
        {"drawsNothing", [](FramePlan& p) { p.drawsNothing = true; }},
    };
    const FramePlan base = planned({});
    std::set<std::string> tried = {"variant"}; // below
    for (const char* origin : {"needs", "look", "reasons", "measured"}) {
        tried.insert(origin); // what a plan is made from does not count
    }
    for (const auto& [member, change] : changes) {
        FramePlan other = base;
        change(other);
        EXPECT_NE(other, base) << member;
        tried.insert(member);
    }
    for (const AxisInfo& axis : kAxes) {
        for (std::size_t value = 0; value < axis.count; ++value) {
            FramePlan other = base;
            axis.choose(other.variant, value);
            EXPECT_EQ(other == base, value == axis.valueOf(base.variant)) << axis.name;
        }
    }
    // A new member does not compile until it is counted here, and fails until it is tried.
    [[maybe_unused]] const auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p] = base;
    EXPECT_EQ(tried.size(), 16U);
}

TEST(FramePlan, TheRatioNeverMovesTheLattice) {
    for (const Settings& settings :
         {Settings{.totalLayers = 444}, Settings{.layerSpacingVoxels = 0.7}}) {
        const Lattice lattice = planned(settings).lattice;
        for (const int planes : {1, 2, 7, 444, 100000}) {
            Settings dealt = settings;
            dealt.planes = planes;
            const FramePlan p = planned(dealt);
            EXPECT_EQ(p.lattice, lattice) << planes;
            EXPECT_LE(p.planes, std::min(planes, lattice.total));
            // Every layer lies on exactly one plane, the one of its quotient, and no plane is
            // without.
            EXPECT_GE(std::int64_t{p.planes} * p.layersPerPlane, lattice.total) << planes;
            EXPECT_LT(std::int64_t{p.planes - 1} * p.layersPerPlane, lattice.total) << planes;
        }
    }
}

/// Slices of a planar lattice would be cheaper on a phone, but swim; and ratios are compared.
TEST(FramePlan, AutoGoesByDeviceForTheLatticeAndNotByRatio) {
    for (const int layersPerPlane : {1, 2, 16, 444}) {
        const Settings settings{.layersPerPlane = layersPerPlane};
        const FramePlan headset = planned(settings);
        EXPECT_EQ(headset.lattice.kind, LatticeKind::Shells) << layersPerPlane;
        EXPECT_NE(reasonFor(headset, "shells lattice")->why.find("a head turns"),
                  std::string::npos);
        const FramePlan software = planned(settings, boneFacts(), kSoftware);
        EXPECT_EQ(software.lattice.kind, LatticeKind::Planar) << layersPerPlane;
        EXPECT_NE(reasonFor(software, "planar lattice")->why.find("a software driver"),
                  std::string::npos);
    }
}

TEST(FramePlan, SpacingAndTotalGiveTheSameLattice) {
    const FramePlan bySpacing = planned({.layerSpacingVoxels = 1.0});
    EXPECT_EQ(bySpacing.lattice, (Lattice{LatticeKind::Shells, 444, 1.0}));
    EXPECT_EQ(planned({.totalLayers = 444}).lattice, bySpacing.lattice);
    EXPECT_EQ(planned({.totalLayers = 1}).lattice, (Lattice{LatticeKind::Shells, 1, 444.0}));
}

TEST(FramePlan, TakesTheFastestMeasuredRatio) {
    const RatioMeasurement measured[] = {{{444, 1, SegmentForm::Unrolled}, 9.0},
                                         {{28, 16, SegmentForm::Unrolled}, 3.0},
                                         {{1, 444, SegmentForm::Loop}, 5.0}};
    const FramePlan p = *plan(boneFacts(), {}, kHeadset, measured);
    EXPECT_EQ(p.planes, 28);
    EXPECT_EQ(p.layersPerPlane, 16);
    EXPECT_EQ(p.variant.unroll, 16);
    const std::optional<ReasonText> reason = reasonFor(p, "ratio 28x16 unrolled");
    ASSERT_NE(reason, std::nullopt);
    for (const char* listed : {"444x1 unrolled 9 ms", "28x16 unrolled 3 ms", "1x444 loop 5 ms"}) {
        EXPECT_NE(reason->why.find(listed), std::string::npos) << listed;
    }
    const Settings asked{.planes = 7}; // goes before what was measured
    EXPECT_EQ(plan(boneFacts(), asked, kHeadset, measured)->planes, 7);
}

TEST(FramePlan, AMeasurementOfOtherLayersStillCoversAll) {
    const RatioMeasurement measured[] = {{{28, 16, SegmentForm::Unrolled}, 3.0}};
    for (const int total : {1, 5, 444, 888, 5000}) {
        const Settings settings{.totalLayers = total};
        const FramePlan p = *plan(boneFacts(), settings, kHeadset, measured);
        expectSound(p, settings, boneFacts());
        EXPECT_EQ(p.layersPerPlane, std::min(16, total));
    }
}

TEST(FramePlan, WithoutMeasurementsTheRatioGoesByDevice) {
    EXPECT_EQ(planned({}).variant.unroll, 16);
    const FramePlan software = planned({}, boneFacts(), kSoftware);
    EXPECT_EQ(software.planes, 1);
    EXPECT_EQ(software.variant.unroll, 0);
    EXPECT_NE(reasonFor(software, "ratio 1x444 loop")->why.find("nothing was measured"),
              std::string::npos);
    EXPECT_NE(reasonFor(planned({}), "ratio 28x16 unrolled")->why.find("nothing was measured"),
              std::string::npos);
    EXPECT_EQ(planned({.form = SegmentForm::Unrolled}, boneFacts(), kSoftware).variant.unroll, 16);
    EXPECT_EQ(planned({.planes = 1}).variant.unroll, 0); // beyond the list
    EXPECT_EQ(planned({.layersPerPlane = 5}).variant.unroll, 8);
}

TEST(FramePlan, CandidatesReachFromSlicingToRayCasting) {
    for (const int total : {1, 7, 16, 64, 444}) {
        const Settings settings{.totalLayers = total};
        const std::vector<Ratio> candidates = ratioCandidates(settings, boneFacts());
        std::set<std::string> names;
        bool slicing = false;
        bool casting = false;
        for (const Ratio& r : candidates) {
            EXPECT_GE(r.planes * r.layersPerPlane, total);
            EXPECT_LT((r.planes - 1) * r.layersPerPlane, total); // no plane without layers
            EXPECT_TRUE(r.form == SegmentForm::Loop ? r.layersPerPlane >= kLoopGroup
                                                    : unrollLengthFor(r.layersPerPlane) > 0)
                << name(r);
            names.insert(name(r));
            slicing |= r.layersPerPlane == 1;
            casting |= r.planes == 1;
        }
        EXPECT_EQ(names.size(), candidates.size());
        EXPECT_TRUE(slicing && casting) << total;
    }
    for (const SegmentForm form : {SegmentForm::Loop, SegmentForm::Unrolled}) {
        for (const Ratio& r : ratioCandidates({.form = form}, boneFacts())) {
            EXPECT_EQ(r.form, r.layersPerPlane < kLoopGroup ? SegmentForm::Unrolled : form);
        }
    }
}

TEST(FramePlan, TerminationIsLeftOutWhereItCannotHappen) {
    EXPECT_TRUE(planned({}).variant.terminates);
    EXPECT_EQ(planned({.termination = 0.9}).terminationAlpha, 0.9);
    EXPECT_FALSE(planned({.termination = std::nullopt}).variant.terminates);
    EXPECT_FALSE(planned({.layersPerPlane = 1}).variant.terminates);
    // A segment of 16 mm reaches 0.9 from an extinction of ln(10)/16 per mm on; half of it is
    // promised to suffice, for oblique rays.
    SceneFacts facts = boneFacts();
    const Settings settings{.termination = 0.9};
    facts.maxExtinctionPerMm = 0.51 * std::log(10.0) / 16.0;
    EXPECT_TRUE(planned(settings, facts).variant.terminates);
    facts.maxExtinctionPerMm = 0.49 * std::log(10.0) / 16.0;
    EXPECT_FALSE(planned(settings, facts).variant.terminates);
    EXPECT_EQ(planned(settings, facts).terminationAlpha, 1.0);
}

// 444 layers of 1 mm, of which a fortieth is 11.1: the opacity 1 - e^-5 takes 5 / 11.1 per mm.
TEST(FramePlan, FrontToBackWhereARayIsSoonOpaque) {
    SceneFacts facts = boneFacts();
    Settings settings{.layersPerPlane = 4, .termination = -std::expm1(-5.0)};
    const auto orderOf = [&](const Settings& s) { return planned(s, facts).order; };
    facts.maxExtinctionPerMm = 1.01 * 5.0 / 11.1;
    EXPECT_EQ(orderOf(settings), BlendOrder::FrontToBack);
    facts.maxExtinctionPerMm = 0.99 * 5.0 / 11.1;
    EXPECT_EQ(orderOf(settings), BlendOrder::BackToFront);
    settings.order = BlendOrder::FrontToBack;
    EXPECT_EQ(orderOf(settings), BlendOrder::FrontToBack);

    facts.maxExtinctionPerMm = 2.0;
    settings.order.reset();
    EXPECT_EQ(orderOf(settings), BlendOrder::FrontToBack);
    settings.layersPerPlane = 444; // one plane
    EXPECT_EQ(orderOf(settings), BlendOrder::BackToFront);
    settings.layersPerPlane = 4;
    settings.termination.reset();
    EXPECT_EQ(orderOf(settings), BlendOrder::BackToFront);
    // Slicing 4000 layers with an opacity of 0.09 each: 55 of them, but where 2 steps of 1/255 are
    // left, a plane adds 0.18 of a step, which 8 bits round away.
    settings.layersPerPlane = 1;
    settings.termination = 1.0 - 1.5 / 255.0;
    facts.maxExtinctionPerMm = -std::log1p(-0.09);
    facts.sphere.radiusMm = 2000.0;
    EXPECT_EQ(orderOf(settings), BlendOrder::BackToFront);
    settings.target = TargetFormat::Rgba16f;
    EXPECT_EQ(orderOf(settings), BlendOrder::FrontToBack);
}

TEST(FramePlan, MarksAreAsFarApartAsTheyCostAndNoRayIsOpaqueBefore) {
    SceneFacts facts = boneFacts();
    Settings settings{.layersPerPlane = 1, .order = BlendOrder::FrontToBack};
    facts.maxExtinctionPerMm = 10.0;
    // sqrt(2 N mark / plane), a mark being one layer, a plane 4 and its own: sqrt(888 / 5) = 13.3.
    EXPECT_EQ(planned(settings, facts).planesPerMark, 14);
    settings.layersPerPlane = 16; // sqrt(2 x 28 / 20) = 1.67
    EXPECT_EQ(planned(settings, facts).planesPerMark, 2);
    EXPECT_EQ(planned(settings, facts).terminationAlpha, *settings.termination);
    facts.maxExtinctionPerMm = std::log(256.0) / 100.0; // 100 layers, 6.25 planes
    EXPECT_EQ(planned(settings, facts).planesPerMark, 7);
    facts.maxExtinctionPerMm = std::log(256.0) / 440.0; // all of the 28 planes
    const FramePlan none = planned(settings, facts);
    EXPECT_EQ(none.planesPerMark, 0);
    EXPECT_NE(reasonFor(none, "no marks"), std::nullopt);
    EXPECT_EQ(none.terminationAlpha < 1.0, none.variant.terminates);
}

TEST(FramePlan, FetchesTheTargetWhereTheDeviceCan) {
    gl::Caps caps;
    caps.framebufferFetch = true;
    const Settings longer{.layersPerPlane = 16};
    const Settings slicing{.layersPerPlane = 1};
    for (const Settings& settings : {longer, slicing}) {
        const FramePlan fetching = planned(settings, boneFacts(), caps);
        EXPECT_TRUE(fetching.variant.fetchesTarget && fetching.variant.terminates);
        EXPECT_EQ(fetching.planesPerMark, 0);
    }
    caps.isSoftware = true; // marks spare launching short segments' fragments
    EXPECT_TRUE(planned(longer, boneFacts(), caps).variant.fetchesTarget);
    EXPECT_FALSE(planned(slicing, boneFacts(), caps).variant.fetchesTarget);
    EXPECT_GT(planned(slicing, boneFacts(), caps).planesPerMark, 0);
}

TEST(FramePlan, SkippingIsLeftOutWhereNothingIsEmpty) {
    SceneFacts facts = boneFacts();
    EXPECT_EQ(planned({}, facts).skip, SkipStructure::Proximity);
    facts.occupiedFraction = 1.0;
    EXPECT_EQ(planned({}, facts).skip, SkipStructure::None);
    EXPECT_EQ(planned({.skip = SkipStructure::Proximity}, facts).skip, SkipStructure::Proximity);
    facts.occupiedFraction = 0.0;
    EXPECT_EQ(planned({.skip = SkipStructure::None}, facts).skip, SkipStructure::None);
}

// A look at the structure must be spread over a few layers, unless one layer takes eight fetches.
TEST(FramePlan, SkippingIsLeftOutOfThinPlanes) {
    SceneFacts facts = boneFacts();
    EXPECT_EQ(planned({.layersPerPlane = 3}, facts).skip, SkipStructure::None);
    EXPECT_EQ(planned({.layersPerPlane = 4}, facts).skip, SkipStructure::Proximity);
    EXPECT_EQ(planned({.skip = SkipStructure::Proximity, .layersPerPlane = 1}, facts).skip,
              SkipStructure::Proximity);
    facts.exactField = true;
    EXPECT_EQ(planned({.layersPerPlane = 1}, facts).skip, SkipStructure::Proximity);
}

TEST(FramePlan, BakedTexelsNeedNeitherGradientsNorFetches) {
    SceneFacts facts = boneFacts();
    facts.exactField = true;
    const FramePlan post = planned({.shaded = true}, facts);
    EXPECT_TRUE(post.variant.shaded);
    EXPECT_TRUE(post.variant.exactField);
    const FramePlan pre = planned({.classification = Classification::Pre, .shaded = true}, facts);
    EXPECT_FALSE(pre.variant.shaded);
    EXPECT_FALSE(pre.variant.exactField);
    EXPECT_FALSE(planned({}, facts).variant.shaded);
}

TEST(FramePlan, BakedNormalsGoWithWhatIsLitSampleBySampleAndTellTheirError) {
    SceneFacts facts = boneFacts();
    facts.normals = {.meanDegrees = 4.25, .percentile95Degrees = 11.5, .places = 7};
    Settings settings{.shaded = true, .normals = Normals::Baked};
    const FramePlan lit = planned(settings, facts);
    EXPECT_EQ(lit.variant.normals, Normals::Baked);
    EXPECT_TRUE(lit.needs.normals);
    const std::string why = reasonFor(lit, "classification").value().why;
    EXPECT_NE(why.find("4.25 degrees on average, 95 % of them by less than 11.5"),
              std::string::npos)
        << why;
    settings.shaded = false;
    EXPECT_EQ(planned(settings, facts).variant.normals, Normals::Computed);
    settings.shaded = true;
    settings.classification = Classification::Pre;
    EXPECT_EQ(planned(settings, facts).variant.normals, Normals::Computed);
}

TEST(FramePlan, PreIntegrationTellsWhatItsColoursAreOffBy) {
    const Settings settings{.classification = Classification::Preintegrated};
    SceneFacts facts = boneFacts();
    facts.exactField = true;
    EXPECT_TRUE(planned(settings, facts).variant.exactField);
    // Layers of 1 mm, seen obliquely of 2: an eighth of their depth, of half the range.
    facts.maxExtinctionPerMm = 1e-3;
    facts.visibleColorRange = 0.5;
    const FramePlan faint = planned(settings, facts);
    const std::optional<ReasonText> reason = reasonFor(faint, "classification preintegrated");
    ASSERT_NE(reason, std::nullopt);
    EXPECT_NE(reason->why.find("at most 0.000125"), std::string::npos) << reason->why;
    Settings shaded = settings;
    shaded.shaded = true;
    const Result<FramePlan> refused = plan(facts, shaded, kHeadset, {});
    ASSERT_FALSE(refused.has_value());
    EXPECT_EQ(refused.error().code, ErrorCode::InvalidArgument);
}

TEST(FramePlan, WarnsWhereEightBitsLeaveLittleOfAnything) {
    // A plane of 16 mm adds 1 - exp(-16 s) of the densest: 4/510 from s = -ln(1 - 4/510)/16 on.
    const double limit = -std::log(1.0 - 4.0 / 510.0) / 16.0;
    SceneFacts facts = boneFacts();
    EXPECT_EQ(reasonFor(planned({}, facts), "warning"), std::nullopt);
    facts.maxExtinctionPerMm = 1.01 * limit;
    EXPECT_EQ(reasonFor(planned({}, facts), "warning"), std::nullopt);
    facts.maxExtinctionPerMm = 0.99 * limit;
    EXPECT_NE(reasonFor(planned({}, facts), "warning"), std::nullopt);
    facts.maxExtinctionPerMm = 0.5 * limit; // half a step of 1/255 in 2.004 half steps
    const FramePlan faint = planned({}, facts);
    const std::optional<ReasonText> warning = reasonFor(faint, "warning");
    ASSERT_NE(warning, std::nullopt);
    EXPECT_NE(warning->why.find("up to 49.9 %"), std::string::npos) << warning->why;
    EXPECT_EQ(reasonFor(planned({.target = TargetFormat::Rgba16f}, facts), "warning"),
              std::nullopt);
    EXPECT_EQ(reasonFor(planned({.layersPerPlane = 64}, facts), "warning"),
              std::nullopt); // fewer planes keep it
    facts.maxExtinctionPerMm = 0.24 * limit;
    const FramePlan lost = planned({}, facts);
    ASSERT_NE(reasonFor(lost, "warning"), std::nullopt);
    EXPECT_NE(reasonFor(lost, "warning")->why.find("all of it"), std::string::npos);
    facts.anythingVisible = false;
    EXPECT_EQ(reasonFor(planned({}, facts), "warning"), std::nullopt);
}

TEST(FramePlan, WarnsWhereHalfsLoseMuchOfWhatManyPlanesGather) {
    // 2^-10 of the pixel per plane, as many planes as it takes to become opaque: half from 512 on.
    SceneFacts facts = boneFacts();
    facts.maxExtinctionPerMm = 1e-6;
    const auto slicing = [&](int planes, TargetFormat target) {
        return planned({.totalLayers = planes, .layersPerPlane = 1, .target = target}, facts);
    };
    EXPECT_EQ(reasonFor(slicing(511, TargetFormat::Rgba16f), "warning"), std::nullopt);
    const FramePlan lossy = slicing(768, TargetFormat::Rgba16f);
    ASSERT_NE(reasonFor(lossy, "warning"), std::nullopt);
    EXPECT_NE(reasonFor(lossy, "warning")->why.find("lose 75 %"), std::string::npos)
        << reasonFor(lossy, "warning")->why;
    // Denser planes hide what lies behind them, its rounding with it.
    facts.maxExtinctionPerMm = 1.0;
    EXPECT_EQ(reasonFor(slicing(768, TargetFormat::Rgba16f), "warning"), std::nullopt);
    facts.anythingVisible = false;
    EXPECT_EQ(reasonFor(slicing(768, TargetFormat::Rgba16f), "warning"), std::nullopt);
}

TEST(FramePlan, WarnsWhereAPreintegratedTableLosesTheFaintest) {
    SceneFacts facts = boneFacts();
    const auto warned = [&](Classification classification) {
        return reasonFor(planned({.classification = classification}, facts), "warning") !=
               std::nullopt;
    };
    EXPECT_FALSE(warned(Classification::Preintegrated));
    facts.wideTable = true;
    EXPECT_TRUE(warned(Classification::Preintegrated));
    EXPECT_FALSE(warned(Classification::Post));
}

TEST(FramePlan, LinearLightIsNotBlendedInEightBits) {
    const FramePlan p = planned({.target = TargetFormat::Rgba8, .space = CompositingSpace::Linear});
    EXPECT_EQ(p.target, TargetFormat::Rgba16f);
    EXPECT_EQ(p.space, CompositingSpace::Linear);
    EXPECT_EQ(planned({}).target, TargetFormat::Rgba8);
}

TEST(FramePlan, DrawsNothingWhereNothingIsVisible) {
    SceneFacts facts = boneFacts();
    facts.anythingVisible = false;
    EXPECT_TRUE(planned({}, facts).drawsNothing);
    EXPECT_FALSE(planned({}).drawsNothing);
}

TEST(FramePlan, RefusesWhatIsOutOfRange) {
    constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
    const std::pair<Settings, const char*> cases[] = {
        {{.layerSpacingVoxels = 0.0}, "layer-spacing"},
        {{.layerSpacingVoxels = -1.0}, "layer-spacing"},
        {{.layerSpacingVoxels = kNan}, "layer-spacing"},
        {{.layerSpacingVoxels = 2e6}, "layer-spacing"},
        {{.totalLayers = 0}, "layers"},
        {{.totalLayers = (1 << 20) + 1}, "layers"},
        {{.planes = 0}, "planes"},
        {{.planes = -3}, "planes"},
        {{.layersPerPlane = 0}, "layers-per-plane"},
        {{.planes = 2, .layersPerPlane = 2}, "both"},
        {{.termination = 1.5}, "termination"},
        {{.termination = -0.1}, "termination"},
        {{.termination = kNan}, "termination"},
        {{.layersPerPlane = 65, .form = SegmentForm::Unrolled}, "65"},
        {{.planes = 1, .form = SegmentForm::Unrolled}, "444"},
    };
    for (const auto& [settings, named] : cases) {
        const Result<FramePlan> refused = plan(boneFacts(), settings, kHeadset, {});
        ASSERT_FALSE(refused.has_value()) << named;
        EXPECT_EQ(refused.error().code, ErrorCode::InvalidArgument);
        EXPECT_NE(refused.error().detail.find(named), std::string::npos) << refused.error().detail;
        EXPECT_NE(refused.error().detail.find(": "), std::string::npos) << "cause and remedy";
    }
    SceneFacts huge = boneFacts();
    huge.sphere.radiusMm = 1e6;
    const Result<FramePlan> tooMany = plan(huge, {.layerSpacingVoxels = 0.1}, kHeadset, {});
    ASSERT_FALSE(tooMany.has_value());
    EXPECT_EQ(tooMany.error().code, ErrorCode::InvalidArgument);
}

} // namespace
} // namespace slabcast
