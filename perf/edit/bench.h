#pragma once

#include <optional>
#include <vector>

#include "core/draw/renderer.h"
#include "core/gl/color_targets.h"
#include "core/scene/live_scene.h"
#include "core/scene/scene.h"
#include "perf/edit/replay.h"
#include "perf/edit/report.h"

namespace slabcast {

/// Replays edits with the live policy and, frame by frame, beside it what it is measured against.
/// Each has its own scene under the same transfer function; all share the texels. The policy has a
/// renderer of its own, so that the others leave its textures alone. What is slow once, as
/// compiling is, is slow once in every bench.
class EditBench {
public:
    /// `decided`: a plan whose ratio all frames are to have. Warms up. Stage and desc must outlive
    /// the bench.
    static Result<EditBench> open(const Stage& stage, const EditDesc& desc,
                                  const FramePlan& decided);

    Result<EditRow> replay(const EditFrame& frame, double turnDegrees);

    /// What was built so far.
    EditBuilds builds() const;

private:
    EditBench(const Stage& stage, const EditDesc& desc, Renderer policys, Renderer others)
        : stage_(&stage), desc_(&desc), policysRenderer_(std::move(policys)),
          othersRenderer_(std::move(others)) {}

    Result<void> makeScenes();
    Result<void> warmUp(const FramePlan& decided);
    Result<FramePlan> planOf(const Scene& scene, const Settings& settings) const;
    Result<void> draw(Renderer& renderer, const Scene& scene, const FramePlan& plan,
                      double turnDegrees);
    Result<void> drawLive(const EditFrame& frame, double turnDegrees, EditRow& row);
    Result<void> drawOctree(const EditFrame& frame, double turnDegrees, EditRow& row);
    Result<void> drawNaive(const EditFrame& frame, double turnDegrees, EditRow& row);
    Result<void> compare(double turnDegrees, const std::vector<glm::vec4>& picture, EditRow& row);

    const Stage* stage_;
    const EditDesc* desc_;
    Renderer policysRenderer_, othersRenderer_;
    Settings settings_; // with the ratio decided
    SkipOptions naiveSkip_;
    double lastDrawMs_ = 0.0;           // by the policy
    std::optional<FramePlan> lastPlan_; // of what it drew last
    gl::ColorTargets target_;
    std::optional<LiveScene> live_, octree_;
    Scene naive_;
};

} // namespace slabcast
