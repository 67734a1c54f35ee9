#include <fmt/core.h>

#include "platform/cli/commands.h"
#include "platform/cli/draw.h"
#include "platform/cli/picture_file.h"
#include "platform/cli/progress.h"
#include "platform/io/atomic_file.h"

namespace slabcast {

namespace {

void explain(const FramePlan& plan, const VolumeInfo& info, const Scene& scene) {
    fmt::print("texels {}: {}; off by at most {:.4g} {}\n", name(scene.texels().format),
               info.formatReason, scene.texels().maxQuantisationError, info.unit);
    constexpr double kMib = 1048576.0;
    fmt::print("memory: {:.1f} MiB for the texels on the GPU, {:.1f} MiB on the host\n",
               static_cast<double>(info.forecast.gpuTexelBytes) / kMib,
               static_cast<double>(info.forecast.hostBytes()) / kMib);
    for (const Reason& reason : plan.reasons) {
        fmt::print("{}: {}\n", reason.what, reason.why);
    }
}

nlohmann::json stats(Stage& stage, const FramePlan& plan, const std::vector<double>& times) {
    const GpuMemory gpu = stage.renderer().gpuMemory();
    return {{"device", toJson(stage.session().caps)},
            {"commit", commit()},
            {"volume", toJson(stage.info())},
            {"plan", toJson(plan)},
            {"frame_ms", toJson(summarise(times))},
            {"counters", toJson(stage.countWork(plan))},
            {"compile_ms", stage.renderer().compileMs(plan.variant)},
            {"quantisation_error", stage.scene().texels().maxQuantisationError},
            {"memory",
             {{"host_peak_bytes", peakHostBytes()},
              {"gpu_volume_bytes", gpu.volumeBytes},
              {"gpu_skip_bytes", gpu.skipBytes},
              {"gpu_other_bytes", gpu.otherBytes}}}};
}

/// Both outputs are known to be writable before any work is done, so that neither is left without
/// the other.
Result<bool> checkOutputs(const RenderOptions& options) {
    if (!options.statsFile.empty()) {
        if (const Result<void> sound = checkWritable(options.statsFile); !sound) {
            return tl::unexpected(sound.error());
        }
        if (std::filesystem::absolute(options.statsFile).lexically_normal() ==
            std::filesystem::absolute(options.output).lexically_normal()) {
            return fail(
                ErrorCode::InvalidArgument,
                options.statsFile +
                    ": is named for both picture and statistics; give --stats another name");
        }
    }
    return pictureIsEncoded(options.output);
}

} // namespace

Result<void> renderCommand(const RenderOptions& options) {
    const Result<bool> encoded = checkOutputs(options);
    if (!encoded) {
        return tl::unexpected(encoded.error());
    }
    Result<Stage> stage = Stage::open(options);
    if (!stage) {
        return tl::unexpected(stage.error());
    }
    const Result<FramePlan> plan = stage->decide(options.settings);
    if (!plan) {
        return tl::unexpected(plan.error());
    }
    if (Result<void> ready = stage->prepare(*plan); !ready) {
        return ready;
    }
    if (options.explain) {
        explain(*plan, stage->info(), stage->scene());
    }
    if (options.frames > 1) {
        (void)stage->drawTimed(
            *plan, 0.0); // the first frame after a compile also pays for the driver's own work
    }
    std::vector<double> times;
    Progress progress;
    std::vector<glm::vec4> picture;
    for (int k = 0; k < options.frames; ++k) {
        progress.show(fmt::format("frame {} of {}", k + 1, options.frames));
        const Result<double> ms = stage->drawTimed(*plan, 360.0 * k / options.frames);
        if (!ms) {
            return tl::unexpected(ms.error());
        }
        times.push_back(*ms);
        if (k == 0) {
            picture = stage->picture(*encoded);
        }
    }
    if (Result<void> saved =
            savePicture(options.output, options.size, picture, options.background.has_value());
        !saved) {
        return saved;
    }
    return options.statsFile.empty()
               ? Result<void>{}
               : writeFileAtomically(options.statsFile, stats(*stage, *plan, times).dump(2) + "\n");
}

} // namespace slabcast
