#pragma once

#include "perf/stage.h"
#include "platform/cli/options.h"

namespace slabcast {

/// A stage with the context that it lives in.
struct OpenStage {
    Session session;
    Stage stage;
};

/// What a stage of these options is opened with, but for its transfer function.
StageDesc stageDescOf(const SceneOptions& options);

/// Refuses, before its voxels are read, what no texture of the device or of the budget can hold,
/// whatever format will be chosen. Contract: the device's context is current then.
InputOptions admittingWhatFits(InputOptions input, const gl::Caps& caps, const StageDesc& desc);

/// Opens a volume in a context that is there, under a TF by chooseTransferFunction(); says on
/// stderr what it does meanwhile.
Result<Stage> openStage(const Session& session, const InputOptions& input, const std::string& tf,
                        StageDesc desc);

/// Opens the device too; says where a picture of it will hardly be what was expected (adviceOn()).
Result<OpenStage> openStage(const SceneOptions& options);

} // namespace slabcast
