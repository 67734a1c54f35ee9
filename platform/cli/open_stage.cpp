#include "platform/cli/open_stage.h"

#include "platform/cli/progress.h"
#include "platform/cli/transfer_choice.h"

namespace slabcast {

namespace {

StageDesc descOf(const SceneOptions& o, TransferFunction tf) {
    StageDesc desc{.size = o.size,
                   .camera = o.camera,
                   .fovDegrees = o.fovDegrees,
                   .stereoIpdMm = o.stereoIpdMm,
                   .background = o.background,
                   .tf = std::move(tf),
                   .settings = o.settings,
                   .skip = o.skip,
                   .skipBuilder = o.skipBuilder,
                   .exactTexels = o.input.exact,
                   .keepValues = o.input.keepValues};
    if (o.input.gpuBudgetMib) {
        desc.gpuBudgetBytes = static_cast<std::int64_t>(*o.input.gpuBudgetMib * 1048576.0);
    }
    return desc;
}

} // namespace

Result<OpenStage> openStage(const SceneOptions& options) {
    Result<Session> session = openSession();
    if (!session) {
        return tl::unexpected(session.error());
    }
    const Progress progress("reading " + options.input.volume);
    Result<Volume> volume = openVolume(options.input);
    if (!volume) {
        return tl::unexpected(volume.error());
    }
    if (volume->nonFiniteVoxels > 0) {
        say(volume->name + ": " + std::to_string(volume->nonFiniteVoxels) +
            " voxels are NaN or infinite: treated as the lowest value");
    }
    const VolumeStatistics statistics = computeStatistics(*volume);
    Result<TransferFunction> tf = chooseTransferFunction(options.tf, {statistics, volume->unit},
                                                         likelyModality(*volume, statistics));
    if (!tf) {
        return tl::unexpected(tf.error());
    }
    Result<Stage> stage = Stage::open({session->caps, session->formats}, std::move(*volume),
                                      statistics, descOf(options, std::move(*tf)), terminal());
    if (!stage) {
        return tl::unexpected(stage.error());
    }
    return OpenStage{std::move(*session), std::move(*stage)};
}

} // namespace slabcast
