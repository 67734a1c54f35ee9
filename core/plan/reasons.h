#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "core/base/short_list.h"

namespace slabcast {

struct FramePlan;

/// Why a plan is as it is: one per choice, in the order of deciding. What each says, and what its
/// numbers mean: the table in reasons.cpp.
enum class ReasonId : std::uint8_t {
    Layers,
    PlanarLattice,
    ShellsLattice,
    PlanarLatticeHere,
    ShellsLatticeHere,
    Jitter,
    RatioAsked,
    RatioOfFewerPlanes,
    RatioUnmeasured,
    RatioFastest,
    ClassificationOfIntervals,
    ClassificationUnlit,
    ClassificationLit,
    ClassificationLitByNormals,
    ClassificationBaked,
    LengthsBaked,
    LengthsPerRay,
    TableFiltered,
    TableFetched,
    WideTableWarning,
    OneMaterial,
    ExactField,
    SkipNotBuilt,
    SkipNoneAsked,
    SkipAsked,
    SkipNothingEmpty,
    SkipThinPlanes,
    SkipChosen,
    TargetOfLinearLight,
    TargetRgba8,
    TargetRgba16f,
    Rgba8LosesAllWarning,
    Rgba8LosesFaintWarning,
    Rgba16fLosesFaintWarning,
    OrderAsked,
    OrderWithoutTermination,
    OrderOfOnePlane,
    OrderTooThin,
    OrderTargetRounds,
    OrderFrontToBack,
    FetchedTarget,
    NoMarks,
    Marks,
    TerminationNotAsked,
    TerminationAcross,
    TerminationOfOneLayer,
    TerminationTooThin,
    TerminationOfSegments,
    TightPlanes,
    SphereOutlines,
    NoCut,
    CutWhileEdited,
    CutInWideOutlines,
    CutAtFaces,
    CutSparesFetches,
    CutAtPlane,
    DrawsNothing,
};

/// Plain data: which reason, and its numbers.
struct Reason {
    ReasonId id = ReasonId::Layers;
    std::array<double, 5> numbers{};

    bool operator==(const Reason&) const = default;
};

/// More than any plan has.
inline constexpr std::size_t kMostReasons = 24;
using Reasons = ShortList<Reason, kMostReasons>;

/// The choice as `--explain` and reports name it, and one line that says why.
struct ReasonText {
    std::string what;
    std::string why;

    bool operator==(const ReasonText&) const = default;
};

/// The plan's reasons in words. Tested by: frame_plan_test.cpp
std::vector<ReasonText> explained(const FramePlan& plan);

bool isWarning(ReasonId id);
/// Whether the plan warns of anything.
bool warns(const FramePlan& plan);

} // namespace slabcast
