#pragma once

#include <optional>
#include <span>

#include "core/base/short_list.h"
#include "core/plan/accumulate_rules.h"
#include "core/plan/frame_plan.h"

/// The decisions that make a plan, each in a file of its own. Pure: no GL, no clock, no text.
namespace slabcast {

/// What decisions read beside the plan in the making.
struct PlanInput {
    const SceneFacts& facts;
    const Settings& settings;
    const gl::Caps& caps;
    std::span<const RatioMeasurement> measurements;
};

/// What is decided about a plan. Which members a part has: decisions_test.cpp.
enum class PlanPart : std::uint8_t {
    Lattice,
    Ratio,
    Classification,
    Skip,
    Target,
    Order,
    Termination,
    Outlines,
    Interval,
    Visibility,
};

/// Chooses its parts, and adds a reason for each choice. Fails: InvalidArgument.
using Decide = Result<void> (*)(const PlanInput& in, FramePlan& plan);

struct Decision {
    const char* name;
    Decide decide;
    ShortList<PlanPart, 4> reads; // of the plan, written by decisions before
    ShortList<PlanPart, 2> writes;
};

Result<void> decideLattice(const PlanInput& in, FramePlan& plan);
Result<void> decideRatio(const PlanInput& in, FramePlan& plan);
Result<void> decideClassification(const PlanInput& in, FramePlan& plan);
Result<void> decideSkip(const PlanInput& in, FramePlan& plan);
Result<void> decideTarget(const PlanInput& in, FramePlan& plan);
Result<void> decideOrder(const PlanInput& in, FramePlan& plan);
Result<void> decideTermination(const PlanInput& in, FramePlan& plan);
Result<void> decideOutlines(const PlanInput& in, FramePlan& plan);
Result<void> decideInterval(const PlanInput& in, FramePlan& plan);
Result<void> decideVisibility(const PlanInput& in, FramePlan& plan);

/// In the order of deciding. Tested by: decisions_test.cpp
inline constexpr Decision kDecisions[] = {
    {"lattice", decideLattice, {}, {PlanPart::Lattice}},
    {"ratio", decideRatio, {PlanPart::Lattice}, {PlanPart::Ratio}},
    {"classification", decideClassification, {PlanPart::Lattice}, {PlanPart::Classification}},
    {"skip", decideSkip, {PlanPart::Ratio}, {PlanPart::Skip}},
    {"target", decideTarget, {PlanPart::Lattice, PlanPart::Ratio}, {PlanPart::Target}},
    {"order",
     decideOrder,
     {PlanPart::Lattice, PlanPart::Ratio, PlanPart::Target},
     {PlanPart::Order, PlanPart::Termination}},
    {"termination",
     decideTermination,
     {PlanPart::Lattice, PlanPart::Ratio, PlanPart::Order},
     {PlanPart::Termination}},
    {"outlines", decideOutlines, {}, {PlanPart::Outlines}},
    {"interval",
     decideInterval,
     {PlanPart::Lattice, PlanPart::Ratio, PlanPart::Classification, PlanPart::Outlines},
     {PlanPart::Interval}},
    {"visibility", decideVisibility, {}, {PlanPart::Visibility}},
};

// What several decisions and their reasons reckon with.

/// Below as many layers per plane a look at the structure costs what it saves: every plane needs
/// its own. On the skull 2 take a quarter more time with skipping than without, 4 as much, 8 a
/// tenth to a quarter less (llvmpipe).
inline constexpr int kFewestLayersToSkip = 4;

/// Above this share of occupied blocks a skip fetch per layer costs more than the few layers that
/// it saves.
inline constexpr double kWorthSkipping = 0.95;

/// What speaks for looking at the skip structure.
enum class LooksCost : std::uint8_t { SpareEightFetches, AsMeasuredHere, AsMeasuredElsewhere };

/// What a ratio goes by that was neither asked for nor measured.
enum class RatioRule : std::uint8_t { Middle, WholeRays, Modelled };

inline void because(FramePlan& plan, ReasonId id, std::array<double, 5> numbers = {}) {
    plan.reasons.add({id, numbers});
}

/// The opacity that rays are left at: what is asked for, where layers are combined so that there is
/// one.
inline std::optional<double> terminationOf(const PlanInput& in, const FramePlan& plan) {
    return ruleOf(plan.variant.accumulate).terminates ? in.settings.termination : std::nullopt;
}

/// Planes that hold all layers.
int planesFor(int total, int layersPerPlane);

/// Optical depth of the densest run of layers that the transfer function can make, straight ahead.
double straightDepthOf(const PlanInput& in, const FramePlan& plan, double layers);
/// The same of oblique rays: obliqueness lengthens it by less than 2 up to 120 degrees.
double mostDepthOf(const PlanInput& in, const FramePlan& plan, double layers);

/// Half of a target's step, of the values next to 1.
double halfStepBelowOne(TargetFormat format);

} // namespace slabcast
