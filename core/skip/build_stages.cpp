#include "core/skip/build_stages.h"

namespace slabcast {

namespace {

bool runStage(const BuildStage& stage, const CancelToken* cancel) {
    if (!stage.inOrder) {
        return parallelFor(stage.items, 1, stage.run, cancel);
    }
    for (std::int64_t i = 0; i < stage.items; ++i) {
        if (cancel != nullptr && cancel->load(std::memory_order_relaxed)) {
            return false;
        }
        stage.run(i, i + 1);
    }
    return true;
}

} // namespace

Result<void> runStages(const BuildStages& stages, const CancelToken* cancel) {
    for (const BuildStage& stage : stages) {
        if (!runStage(stage, cancel)) {
            return fail(ErrorCode::Internal,
                        "skip structure: cancelled; build it again when needed");
        }
    }
    return {};
}

} // namespace slabcast
