#include "platform/cli/open_stage.h"

#include <algorithm>

#include <fmt/core.h>

#include "core/scene/memory_forecast.h"
#include "platform/cli/advice.h"
#include "platform/cli/progress.h"
#include "platform/cli/transfer_choice.h"

namespace slabcast {

namespace {

void advise(const SceneOptions& options, const Stage& stage) {
    const Scene& scene = stage.scene();
    const VolumeInfo& info = stage.info();
    const auto stepOf = [&](TexelFormat format) {
        return texelStep(format, info.type, scene.statistics());
    };
    const TexelFormat filtered =
        stage.device().texturesFor(info.type, scene.statistics(), options.input.exact).texels;
    const PictureSubject subject{
        .dims = info.dims,
        .spacingMm = info.spacingMm,
        .statistics = scene.statistics(),
        .tf = scene.look().tf,
        .laidOverBulk = isLaidOverBulk(options.tf, {scene.statistics(), info.unit}, info.modality),
        .texelStep = stepOf(scene.texels().format),
        .filteredStep = stepOf(filtered),
        .anythingVisible = scene.facts().anythingVisible,
        .mayBeConstant = options.input.volume.starts_with("phantom:")};
    for (const std::string& line : adviceOn(subject)) {
        say(info.name + ": " + line);
    }
}

/// A volume's dims as they will be drawn.
glm::ivec3 drawnDims(glm::ivec3 dims, const InputOptions& input) {
    return input.cubeEdge > 0 ? glm::ivec3(input.cubeEdge) : (dims - 1) / input.downsample + 1;
}

/// Whether the device has room for it now; names the --downsample for which it has.
Result<void> checkRoomFor(glm::ivec3 dims, const InputOptions& input, std::int64_t bytesPerTexel) {
    const Result<void> room = checkRoom(drawnDims(dims, input), bytesPerTexel);
    if (room || input.cubeEdge > 0 || room.error().code != ErrorCode::DeviceOutOfMemory) {
        return room;
    }
    constexpr int kMost = 1024;
    int enough = input.downsample + 1;
    while (enough < kMost && !checkRoom((dims - 1) / enough + 1, bytesPerTexel)) {
        ++enough;
    }
    return fail(ErrorCode::DeviceOutOfMemory,
                fmt::format("the volume has {}x{}x{} voxels, for which the GPU has no memory; load "
                            "it with --downsample {}",
                            dims.x, dims.y, dims.z, enough));
}

} // namespace

InputOptions admittingWhatFits(InputOptions input, const gl::Caps& caps, const StageDesc& desc) {
    const int leastOfColours = desc.settings.classification == Classification::Pre ? 4 : 1;
    InputOptions fitting = input;
    fitting.load.admit = [input = std::move(input), caps, budget = desc.gpuBudgetBytes,
                          leastOfColours](const Volume& header) -> Result<void> {
        const int ofScalars = bytesPerVoxel(header.type) > 1 || input.exact ? 2 : 1;
        const std::int64_t least = std::max(leastOfColours, ofScalars); // bytes per texel
        const glm::ivec3 dims = header.geometry.dims;
        const glm::ivec3 drawn = drawnDims(dims, input);
        const Result<void> fits = checkFits(drawn, least, caps, budget);
        if (fits) {
            return checkRoomFor(dims, input, least);
        }
        // Asked of all voxels, it names the --downsample that does.
        return input.cubeEdge > 0 ? fits : checkFits(dims, least, caps, budget);
    };
    return fitting;
}

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
    Result<Volume> volume = openVolume(admittingWhatFits(input, session.device.caps(), desc));
    if (!volume) {
        return tl::unexpected(volume.error());
    }
    sayNotes(input, *volume);
    if (volume->nonFiniteVoxels > 0) {
        say(volume->name + ": " + std::to_string(volume->nonFiniteVoxels) +
            " voxels are NaN or infinite: treated as the lowest value");
    }
    const VolumeStatistics statistics = statisticsOf(*volume);
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
    Result<Session> session = openSession(options.session);
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
