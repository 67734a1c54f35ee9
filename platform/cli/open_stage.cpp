#include "platform/cli/open_stage.h"

#include "core/scene/memory_forecast.h"
#include "platform/cli/advice.h"
#include "platform/cli/progress.h"
#include "platform/cli/transfer_choice.h"

namespace slabcast {

namespace {

/// Between neighbouring data values of texels; 0 where every voxel is kept exactly.
double stepOf(const Texels& texels) {
    const double steps = texels.format == TexelFormat::R8    ? 255.0
                         : texels.format == TexelFormat::R16 ? 65535.0
                                                             : 1.0;
    return texels.maxQuantisationError > 0.0 ? texels.valueScale / steps : 0.0;
}

void advise(const SceneOptions& options, const Stage& stage) {
    const Scene& scene = stage.scene();
    const VolumeInfo& info = stage.info();
    const PictureSubject subject{
        .dims = info.dims,
        .spacingMm = info.spacingMm,
        .statistics = scene.statistics(),
        .tf = scene.look().tf,
        .laidOverBulk = isLaidOverBulk(options.tf, {scene.statistics(), info.unit}, info.modality),
        .texelStep = stepOf(scene.texels()),
        .anythingVisible = scene.facts().anythingVisible,
        .mayBeConstant = options.input.volume.starts_with("phantom:")};
    for (const std::string& line : adviceOn(subject)) {
        say(info.name + ": " + line);
    }
}

/// Refuses, before its voxels are read, what no texture of the device or of the budget can hold,
/// whatever format will be chosen.
LoadOptions admittingWhatFits(const InputOptions& input, const gl::Caps& caps,
                              std::optional<std::int64_t> budgetBytes) {
    LoadOptions load = input.load;
    load.admit = [&input, &caps, budgetBytes](const Volume& header) -> Result<void> {
        if (input.cubeEdge > 0 || input.downsample > 1) {
            return {}; // what is drawn is made of these voxels
        }
        const std::int64_t least = bytesPerVoxel(header.type) == 1 ? 1 : 2; // bytes per texel
        return checkFits(header.geometry.dims, least, caps, budgetBytes);
    };
    return load;
}

} // namespace

StageDesc stageDescOf(const SceneOptions& o) {
    StageDesc desc{.size = o.size,
                   .camera = o.camera,
                   .fovDegrees = o.fovDegrees,
                   .stereoIpdMm = o.stereoIpdMm,
                   .background = o.background,
                   .tf = {},
                   .settings = o.settings,
                   .exactTexels = o.input.exact,
                   .keepValues = o.input.keepValues};
    if (o.input.gpuBudgetMib) {
        desc.gpuBudgetBytes = static_cast<std::int64_t>(*o.input.gpuBudgetMib * 1048576.0);
    }
    return desc;
}

Result<Stage> openStage(const Session& session, const InputOptions& input, const std::string& tf,
                        StageDesc desc) {
    const Progress progress("reading " + input.volume);
    InputOptions fitting = input;
    fitting.load = admittingWhatFits(input, session.device.caps(), desc.gpuBudgetBytes);
    Result<Volume> volume = openVolume(fitting);
    if (!volume) {
        return tl::unexpected(volume.error());
    }
    if (volume->nonFiniteVoxels > 0) {
        say(volume->name + ": " + std::to_string(volume->nonFiniteVoxels) +
            " voxels are NaN or infinite: treated as the lowest value");
    }
    const VolumeStatistics statistics = computeStatistics(*volume);
    const Modality modality = likelyModality(*volume, statistics);
    Result<TransferFunction> chosen =
        chooseTransferFunction(tf, {statistics, volume->unit}, modality);
    if (!chosen) {
        return tl::unexpected(chosen.error());
    }
    desc.tf = std::move(*chosen);
    return Stage::open(session.device, std::move(*volume), statistics, std::move(desc), terminal());
}

Result<OpenStage> openStage(const SceneOptions& options) {
    Result<Session> session = openSession();
    if (!session) {
        return tl::unexpected(session.error());
    }
    return openStage(*session, options.input, options.tf, stageDescOf(options))
        .map([&](Stage stage) {
            advise(options, stage);
            return OpenStage{std::move(*session), std::move(stage)};
        });
}

} // namespace slabcast
