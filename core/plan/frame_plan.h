#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/gl/caps.h"
#include "core/plan/needs.h"
#include "core/plan/reasons.h"
#include "core/plan/settings.h"
#include "core/plan/shader_variant.h"
#include "core/transfer/transfer_function.h"
#include "core/view/lattice.h"
#include "core/volume/normals.h"

namespace slabcast {

/// What a plan needs to know of the volume under its transfer function.
struct SceneFacts {
    int look = 0; // which look of which scene this is true of: Scene::lookGeneration()
    BoundingSphere sphere;
    double smallestVoxelEdgeMm = 1.0;
    bool exactField = false;
    bool anythingVisible = true;
    SkipOptions skip; // the structure that was built: what can skip, and tighten planes
    double occupiedFraction = 1.0; // of its blocks or leaves
    bool oneMaterial = false;      // the transfer function is constant over the data
    double maxExtinctionPerMm = 0.0;
    double visibleColorRange = 1.0;           // of any channel
    bool wideTable = false;                   // extinction spans more than fp16 keeps
    bool filtersTable = false;                // the device's filter may read the table
    std::optional<double> classifiedLengthMm; // of a layer, in pre-classified texels
    NormalsError normals;                     // of baked ones
    bool facesAreClear = false;               // nothing visible is in a block at the volume's faces
    bool isEdited = false;                    // its look may be another one in the next frame
};

/// One way to deal the layers out to planes.
struct Ratio {
    int planes = 1;
    int layersPerPlane = 1;
    SegmentForm form = SegmentForm::Loop;

    bool operator==(const Ratio&) const = default;
};

std::string name(const Ratio& ratio); // "28x16 unrolled"

/// What a ratio took on this device: the input of `auto`.
struct RatioMeasurement {
    Ratio ratio;
    double frameMs = 0.0;
};

/// As many as ratioCandidates() gives.
inline constexpr std::size_t kMostRatios = 12;

/// Everything that a frame does, decided. Two pictures are of the same settings when their plans
/// are equal: in everything but what the plan is made from (needs, look, measured) and the reasons.
/// Plain data, nothing on the heap.
struct FramePlan {
    Needs needs;  // what the settings ask to be built: needsOf()
    int look = 0; // that it was made for: it draws no other
    Lattice lattice;
    int planes = 1;
    int layersPerPlane = 1;
    ShaderVariant variant;
    SkipStructure skip = SkipStructure::None;
    bool tighten = false;
    TargetFormat target = TargetFormat::Rgba8;
    CompositingSpace space = CompositingSpace::Display;
    double terminationAlpha = 1.0;
    BlendOrder order = BlendOrder::BackToFront;
    int planesPerMark = 0; // front to back: planes between marks of saturated pixels; 0: no marks
    bool drawsNothing = false;
    Reasons reasons;                                   // in words: explained()
    ShortList<RatioMeasurement, kMostRatios> measured; // what the ratio was chosen from

    bool operator==(const FramePlan& other) const;
};

/// The variant that draws a view of the plan: its own, or where that cuts no stay and the view's
/// near plane or eye is among the layers, the one that does.
ShaderVariant variantFor(const FramePlan& plan, const RayFrame& frame, const Frustum& frustum);
/// The one that cuts.
ShaderVariant cutVariant(const FramePlan& plan);

/// Stored alpha above which a pixel of the plan's layer counts as having passed the termination
/// opacity: a stored value stands for all that lie within half a step of it.
double saturatedAlpha(const FramePlan& plan);

/// Total layers that the settings ask for: the given number or enough for the sphere at the
/// spacing, and one more where jitter moves them.
int totalLayers(const Settings& settings, const SceneFacts& facts);

/// Ratios worth measuring for `auto`, from ray casting to slicing.
std::vector<Ratio> ratioCandidates(const Settings& settings, const SceneFacts& facts);

/// Pure: no GL, no clock. Leaves out what the scene does not need and says why.
/// Fails: InvalidArgument (a number outside its range; planes and layersPerPlane both set; an
/// unrolled form beyond the list). Tested by: frame_plan_test.cpp
Result<FramePlan> plan(const SceneFacts& facts, const Settings& settings, const gl::Caps& caps,
                       std::span<const RatioMeasurement> measurements);

} // namespace slabcast
