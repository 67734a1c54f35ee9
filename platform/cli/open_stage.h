#pragma once

#include "perf/stage.h"
#include "platform/cli/options.h"

namespace slabcast {

/// A stage with the context that it lives in.
struct OpenStage {
    Session session;
    Stage stage;
};

/// Opens device and volume, applies the look; says on stderr what it does meanwhile.
Result<OpenStage> openStage(const SceneOptions& options);

} // namespace slabcast
