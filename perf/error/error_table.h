#pragma once

#include <optional>
#include <span>
#include <string>

#include "core/plan/frame_plan.h"

namespace slabcast {

/// What of the settings a picture's accuracy depends on most; all else stays as the user has it.
struct Sampling {
    double layerSpacingVoxels = 1.0;
    int layersPerPlane = 0; // 0: all of them in one plane, ray casting
    Classification classification = Classification::Post;
    TargetFormat target = TargetFormat::Rgba8;
    std::optional<double> termination;
    bool jitter = false;

    bool operator==(const Sampling&) const = default;
};

/// "post, rgba8, a layer every 0.5 voxels, 8 per plane, termination off".
std::string describe(const Sampling& sampling);

/// `base` with this sampling. Ray casting stays so at any number of layers; segments too long to
/// be written out become loops.
Settings withSampling(const Settings& base, const Sampling& sampling, const SceneFacts& facts);

/// What pictures of one volume and look have in common, however they are sampled.
struct SceneLabel {
    std::string volume;
    std::string tf;
    std::string fingerprint; // of voxels, their places and the transfer function's points
    CompositingSpace space = CompositingSpace::Display;

    bool operator==(const SceneLabel&) const = default;
};

/// One measured picture: how far from the continuous model, and what it took.
struct MeasuredError {
    SceneLabel scene;
    glm::ivec2 size{0};
    Sampling sampling;
    double rmse = 0.0;
    double msPerMegapixel = 0.0;
    std::string commit; // of the build that measured it
};

struct ErrorChoice {
    Sampling sampling;
    double expectedRmse = 0.0;
    double expectedMsPerMegapixel = 0.0;
    bool ofThisScene = false; // measured with this volume and transfer function
    int measurements = 0;     // that the expectation is the worst of
};

/// The cheapest sampling whose expected RMSE is at most `rmse`. The expected error and time of a
/// sampling are the worst that were measured with it. Where this scene itself was measured, only
/// its rows are used. Otherwise the rows of all scenes of the same compositing space are, and only
/// samplings that the greatest number of scenes was measured with: a sampling that only an easy
/// scene was measured with would promise too much. Pure.
/// Fails: FileNotFound (nothing was measured), InvalidArgument (nothing reaches `rmse`; names the
/// best that was measured).
/// Tested by: error_table_test.cpp
Result<ErrorChoice> cheapestWithin(double rmse, const SceneLabel& scene,
                                   std::span<const MeasuredError> table);

} // namespace slabcast
