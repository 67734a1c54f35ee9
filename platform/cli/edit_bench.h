#pragma once

#include <optional>
#include <string>
#include <vector>

#include "perf/report_json.h"
#include "perf/stage.h"
#include "platform/cli/edit_script.h"
#include "platform/cli/options.h"

namespace slabcast {

/// One frame of an edit as it was replayed.
struct EditRow {
    std::string step;
    bool edited = false;
    LiveProgress progress = LiveProgress::Settled; // of the work in the background
    std::string structure;                         // that skipped in this frame
    double frameMs = 0.0; // from the edit to the end of drawing: the sum of these, and the clearing
    double editMs = 0.0;
    double workMs = 0.0;
    double prepareMs = 0.0; // plan and uploads
    double drawMs = 0.0;
    double octreeMs = 0.0; // the same picture by an octree that was there, nothing else being done
    double octreeWorstMs = 0.0; // of the frames of which that is the median
    double naiveMs = 0.0;       // the same picture, the map being built anew at every edit
    Result<WorkCounters> counters = tl::unexpected(Error{});
    std::optional<bool> equal; // to a picture from scratch, where that was asked for
};

/// Replays edits with the live policy and, frame by frame, beside it what it is measured against.
/// Each has its own scene under the same transfer function; all share the texels. The policy has a
/// renderer of its own, so that the others leave its textures alone. What is slow once, as
/// compiling is, is slow once in every bench.
class EditBench {
public:
    /// `live`: what the policy is to do; `decided`: a plan whose ratio all frames are to have.
    /// Warms up. The stage must outlive the bench.
    static Result<EditBench> open(const Stage& stage, const EditOptions& options,
                                  const LiveOptions& live, const TransferFunction& start,
                                  const FramePlan& decided);

    Result<EditRow> replay(const EditFrame& frame, double turnDegrees);

    const LiveSkip& live() const { return *live_.live(); }
    /// What one build of the structure of the TF of now takes, for the naive policy.
    double naiveBuildMs() const { return naive_.skip().buildMs; }

private:
    EditBench(const Stage& stage, const EditOptions& options, Renderer policys, Renderer others)
        : stage_(&stage), options_(options), policysRenderer_(std::move(policys)),
          othersRenderer_(std::move(others)) {}

    Result<void> makeScenes(const LiveOptions& live, const TransferFunction& start);
    Result<void> warmUp(const FramePlan& decided);
    Result<FramePlan> planOf(const Scene& scene, const Settings& settings) const;
    Result<void> draw(Renderer& renderer, const Scene& scene, const FramePlan& plan,
                      double turnDegrees);
    Result<void> drawLive(const EditFrame& frame, double turnDegrees, EditRow& row);
    Result<void> drawOctree(const EditFrame& frame, double turnDegrees, EditRow& row);
    Result<void> drawNaive(const EditFrame& frame, double turnDegrees, EditRow& row);
    Result<void> compare(double turnDegrees, const std::vector<glm::vec4>& picture, EditRow& row);

    const Stage* stage_;
    EditOptions options_;
    Renderer policysRenderer_, othersRenderer_;
    Settings settings_; // with the ratio decided
    SkipOptions naiveSkip_;
    double lastDrawMs_ = 0.0;           // by the policy
    std::optional<FramePlan> lastPlan_; // of what it drew last
    gl::ColorTargets target_;
    Scene live_, octree_, naive_;
};

} // namespace slabcast
