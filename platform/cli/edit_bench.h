#pragma once

#include <optional>
#include <string>
#include <vector>

#include "platform/cli/draw.h"
#include "platform/cli/edit_script.h"

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
    double naiveMs = 0.0;  // the same picture, the map being built anew at every edit
    Result<WorkCounters> counters = tl::unexpected(Error{});
    std::optional<bool> equal; // to a picture from scratch, where that was asked for
};

/// Replays edits with the live policy and, frame by frame, beside it what it is measured against.
/// Each has its own scene under the same transfer function; all share the texels. The policy has a
/// renderer of its own, so that the others leave its textures alone.
class EditBench {
public:
    /// `live`: what the policy is to do. Decides the ratio, warms up.
    static Result<EditBench> open(Stage stage, const EditOptions& options, const LiveOptions& live,
                                  const TransferFunction& start);

    Result<EditRow> replay(const EditFrame& frame, double turnDegrees);

    const Stage& stage() const { return stage_; }
    const FramePlan& firstPlan() const { return firstPlan_; } // whose ratio all frames have
    const LiveSkip& live() const { return *live_.live(); }
    int layersPerPlane() const { return settings_.layersPerPlane.value_or(1); }
    int planesNow() const {
        const int total = totalLayers(settings_, live_.facts());
        return (total + layersPerPlane() - 1) / layersPerPlane();
    }
    /// What one build of the structure of the TF of now takes, for the naive policy.
    double naiveBuildMs() const { return naive_.skip().buildMs; }

private:
    EditBench(Stage stage, Renderer renderer, const EditOptions& options)
        : stage_(std::move(stage)), renderer_(std::move(renderer)), options_(options) {}

    Result<void> makeScenes(const LiveOptions& live, const TransferFunction& start);
    Result<void> warmUp();
    Result<FramePlan> planOf(const Scene& scene, const Settings& settings) const;
    Result<void> draw(Renderer& renderer, const Scene& scene, const FramePlan& plan,
                      double turnDegrees);
    Result<void> drawLive(const EditFrame& frame, double turnDegrees, EditRow& row);
    Result<void> drawOctree(const EditFrame& frame, double turnDegrees, EditRow& row);
    Result<void> drawNaive(const EditFrame& frame, double turnDegrees, EditRow& row);
    Result<void> compare(double turnDegrees, const std::vector<glm::vec4>& picture, EditRow& row);

    Stage stage_;       // its renderer draws for comparison
    Renderer renderer_; // the policy's
    EditOptions options_;
    FramePlan firstPlan_;
    Settings settings_; // with the ratio decided
    SkipOptions naiveSkip_;
    gl::ColorTargets target_;
    Scene live_, octree_, naive_;
};

} // namespace slabcast
