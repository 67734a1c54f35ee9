#include "core/plan/decisions/decision.h"

#include <set>

#include <gtest/gtest.h>

#include "tests/support/frame_scene.h"

namespace slabcast {
namespace {

using test::Dice;

/// What of a plan each part holds.
struct PartMembers {
    PlanPart part;
    void (*copy)(FramePlan& to, const FramePlan& from);
};

constexpr PartMembers kParts[] = {
    {PlanPart::Lattice,
     [](FramePlan& to, const FramePlan& from) {
         to.lattice = from.lattice;
         to.variant.lattice = from.variant.lattice;
         to.variant.jittered = from.variant.jittered;
     }},
    {PlanPart::Ratio,
     [](FramePlan& to, const FramePlan& from) {
         to.planes = from.planes;
         to.layersPerPlane = from.layersPerPlane;
         to.variant.unroll = from.variant.unroll;
     }},
    {PlanPart::Classification,
     [](FramePlan& to, const FramePlan& from) {
         to.variant.classification = from.variant.classification;
         to.variant.exactField = from.variant.exactField;
         to.variant.shaded = from.variant.shaded;
         to.variant.table = from.variant.table;
         to.variant.lengths = from.variant.lengths;
     }},
    {PlanPart::Skip,
     [](FramePlan& to, const FramePlan& from) {
         to.skip = from.skip;
         to.variant.skip = from.variant.skip;
     }},
    {PlanPart::Target,
     [](FramePlan& to, const FramePlan& from) {
         to.target = from.target;
         to.space = from.space;
     }},
    {PlanPart::Order,
     [](FramePlan& to, const FramePlan& from) {
         to.order = from.order;
         to.planesPerMark = from.planesPerMark;
         to.variant.fetchesTarget = from.variant.fetchesTarget;
     }},
    {PlanPart::Termination,
     [](FramePlan& to, const FramePlan& from) {
         to.terminationAlpha = from.terminationAlpha;
         to.variant.terminates = from.variant.terminates;
     }},
    {PlanPart::Outlines, [](FramePlan& to, const FramePlan& from) { to.tighten = from.tighten; }},
    {PlanPart::Interval,
     [](FramePlan& to, const FramePlan& from) { to.variant.interval = from.variant.interval; }},
    {PlanPart::Visibility,
     [](FramePlan& to, const FramePlan& from) { to.drawsNothing = from.drawsNothing; }},
};

void copyPart(PlanPart part, FramePlan& to, const FramePlan& from) {
    kParts[static_cast<std::size_t>(part)].copy(to, from);
}

struct Case {
    SceneFacts facts;
    Settings settings;
    gl::Caps caps;
};

Case randomCase(Dice& dice) {
    Case c;
    c.facts.sphere.radiusMm = dice.logUniform(10.0, 400.0);
    c.facts.exactField = dice.chance(0.5);
    c.facts.anythingVisible = dice.chance(0.8);
    c.facts.skip.structure = static_cast<SkipStructure>(dice.below(8));
    c.facts.occupiedFraction = dice.uniform(0.0, 1.0);
    c.facts.maxExtinctionPerMm = dice.logUniform(1e-6, 100.0);
    c.settings.classification = static_cast<Classification>(dice.below(3));
    c.settings.lattice = dice.chance(0.5) ? LatticeKind::Planar : LatticeKind::Shells;
    c.settings.jitter = dice.chance(0.5);
    c.settings.layersPerPlane = 1 + dice.below(64);
    c.settings.space = dice.chance(0.5) ? CompositingSpace::Display : CompositingSpace::Linear;
    c.settings.tighten = dice.chance(0.5);
    c.settings.shaded = dice.chance(0.5);
    if (dice.chance(0.3)) {
        c.settings.termination.reset();
    }
    if (dice.chance(0.5)) {
        c.settings.order = dice.chance(0.3) ? BlendOrder::BackToFront : BlendOrder::FrontToBack;
    }
    c.caps.isSoftware = dice.chance(0.5);
    c.caps.framebufferFetch = dice.chance(0.5);
    return c;
}

FramePlan decided(const Decision& decision, const PlanInput& input, FramePlan plan) {
    const Result<void> done = decision.decide(input, plan);
    EXPECT_TRUE(done.has_value()) << decision.name;
    return plan;
}

TEST(Decisions, ReadOnlyWhatWasDecidedBefore) {
    std::set<PlanPart> written;
    for (const Decision& decision : kDecisions) {
        for (const PlanPart part : decision.reads) {
            EXPECT_EQ(written.count(part), 1U) << decision.name;
        }
        written.insert(decision.writes.begin(), decision.writes.end());
    }
    EXPECT_EQ(written.size(), std::size(kParts)); // and nothing is left undecided
    for (std::size_t k = 0; k < std::size(kParts); ++k) {
        EXPECT_EQ(kParts[k].part, static_cast<PlanPart>(k));
    }
}

TEST(Decisions, WriteWhatTheySayAndDependOnNothingElseOfThePlan) {
    Dice dice(5);
    for (int k = 0; k < 500; ++k) {
        const Case c = randomCase(dice);
        const Case other = randomCase(dice);
        const PlanInput input{c.facts, c.settings, c.caps, {}};
        const PlanInput otherInput{other.facts, other.settings, other.caps, {}};
        FramePlan before;
        FramePlan stranger; // as another input would have it
        for (const Decision& decision : kDecisions) {
            ASSERT_TRUE(decision.decide(otherInput, stranger).has_value());
        }
        for (const Decision& decision : kDecisions) {
            const FramePlan after = decided(decision, input, before);
            FramePlan restored = after;
            for (const PlanPart part : decision.writes) {
                copyPart(part, restored, before);
            }
            EXPECT_EQ(restored, before) << decision.name;

            // The same decision in a plan of which only what it reads, and may add to, is this one.
            FramePlan elsewhere = stranger;
            elsewhere.reasons = {};
            for (const PlanPart part : decision.reads) {
                copyPart(part, elsewhere, before);
            }
            for (const PlanPart part : decision.writes) {
                copyPart(part, elsewhere, before);
            }
            FramePlan expected = elsewhere;
            for (const PlanPart part : decision.writes) {
                copyPart(part, expected, after);
            }
            EXPECT_EQ(decided(decision, input, elsewhere), expected) << decision.name;
            before = after;
        }
    }
}

} // namespace
} // namespace slabcast
