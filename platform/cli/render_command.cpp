#include <algorithm>
#include <numeric>

#include <fmt/core.h>

#include "perf/frame_times.h"
#include "perf/report_json.h"
#include "perf/stage.h"
#include "platform/cli/commands.h"
#include "platform/cli/commit.h"
#include "platform/cli/error_table_file.h"
#include "platform/cli/open_stage.h"
#include "platform/cli/picture_file.h"
#include "platform/cli/progress.h"
#include "platform/cli/reference_pictures.h"
#include "platform/cli/skip_options.h"
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
    if (scene.skip().exists()) {
        fmt::print("skip structure: {}\n", describe(scene.skip()));
    }
    for (const ReasonText& reason : explained(plan)) {
        fmt::print("{}: {}\n", reason.what, reason.why);
    }
}

/// The sampling that is expected to do, in place of the user's; says so where reasons are asked
/// for.
Result<Settings> settingsFor(Stage& stage, const RenderOptions& options) {
    if (!options.targetError) {
        return options.settings;
    }
    const Result<std::filesystem::path> path = errorTablePath(stage.caps());
    const Result<std::vector<MeasuredError>> table =
        path ? readErrorTable(*path) : tl::unexpected(path.error());
    const Result<ErrorChoice> choice =
        table ? cheapestWithin(*options.targetError, labelOf(stage), *table)
              : tl::unexpected(table.error());
    if (!choice) {
        return tl::unexpected(choice.error());
    }
    if (options.explain) {
        fmt::print("target error {:g}: {}; expected RMSE {:.3g} at {:.3g} ms per megapixel, {} "
                   "with {}\n",
                   *options.targetError, describe(choice->sampling), choice->expectedRmse,
                   choice->expectedMsPerMegapixel,
                   choice->measurements == 1
                       ? "as measured"
                       : fmt::format("the worst of {} measurements", choice->measurements),
                   choice->ofThisScene ? "this volume and transfer function" : "other scenes");
    }
    if (Result<void> look = stage.reclassify(choice->sampling.classification); !look) {
        return tl::unexpected(look.error());
    }
    return withSampling(options.settings, choice->sampling, stage.scene().facts());
}

struct Turn {
    std::vector<double> frameMs;
    std::vector<glm::vec4> firstPicture;
};

/// The volume turned once around.
Result<Turn> drawTurn(Stage& stage, const FramePlan& plan, int frames, bool encoded) {
    if (frames > 1) {
        (void)stage.drawTimed(
            plan, 0.0); // the first frame after a compile also pays for the driver's own work
    }
    Turn turn;
    Progress progress;
    for (int k = 0; k < frames; ++k) {
        progress.show(fmt::format("frame {} of {}", k + 1, frames));
        const Result<double> ms = stage.drawTimed(plan, 360.0 * k / frames);
        if (!ms) {
            return tl::unexpected(ms.error());
        }
        turn.frameMs.push_back(*ms);
        if (k == 0) {
            turn.firstPicture = stage.picture(encoded);
        }
    }
    return turn;
}

/// How far the first frame is from the exact picture.
Result<PictureDifference> verify(Stage& stage, const FramePlan& plan, glm::ivec2 size) {
    const Result<std::vector<glm::dvec4>> picture = stage.drawOnNothing(plan);
    if (!picture) {
        return tl::unexpected(picture.error());
    }
    Progress progress;
    const std::vector<glm::dvec4> exact = continuousPicture(stage, size, [&progress](double done) {
        progress.show(fmt::format("integrating the exact picture: {:.0f} %", 100.0 * done));
    });
    return difference(*picture, exact, plan.space);
}

void print(const PictureDifference& d) {
    fmt::print("error: RMSE {:.4g}, PSNR {:.4g} dB, at most {:.4g}; CIEDE2000 {:.3g} on average, "
               "{:.3g} at the 99.9th percentile\n",
               d.rmse, d.psnr, d.max, d.meanDeltaE, d.p999DeltaE);
}

/// The first frame's cost, pixel by pixel.
struct CostPicture {
    std::vector<glm::vec4> pixels; // top row first
    nlohmann::json stats;
};

Result<CostPicture> drawCosts(Stage& stage, const FramePlan& plan, const RenderOptions& options,
                              bool encoded) {
    const HeatmapQuantity quantity = *options.heatmap;
    const Result<std::vector<PixelWork>> work = stage.workPerPixel(plan);
    if (!work) {
        return tl::unexpected(work.error());
    }
    std::vector<double> costs(work->size());
    std::transform(work->begin(), work->end(), costs.begin(),
                   [=](const PixelWork& pixel) { return costOf(pixel, quantity); });
    const double maximum = maximumOf(options.heatmapScale, costs, plan.lattice.total);
    CostPicture picture{drawHeatmap(options.size, costs, quantity, maximum),
                        {{"quantity", name(quantity)},
                         {"maximum", maximum},
                         {"sum", std::accumulate(costs.begin(), costs.end(), 0.0)}}};
    if (!encoded) {
        for (glm::vec4& pixel : picture.pixels) {
            pixel = glm::vec4(glm::vec3(linearFromSrgb(glm::dvec3(pixel))), pixel.a);
        }
    }
    return picture;
}

/// What was built to skip by, and what of it the plan has a use for.
nlohmann::json skipStats(const BuiltSkip& skip, const FramePlan& plan) {
    nlohmann::json stats = toJson(skip);
    if (!stats.is_null()) {
        stats["skips"] = plan.skip != SkipStructure::None;
        stats["tightens"] = plan.tighten;
    }
    return stats;
}

nlohmann::json stats(Stage& stage, const FramePlan& plan, const std::vector<double>& times) {
    const GpuMemory gpu = stage.renderer().gpuMemory();
    return {{"device", toJson(stage.caps())},
            {"commit", commit()},
            {"volume", toJson(stage.info())},
            {"plan", toJson(plan)},
            {"skip", skipStats(stage.scene().skip(), plan)},
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

Result<void> renderCommand(const RenderOptions& given) {
    RenderOptions options = given;
    options.input.keepValues = options.verify;
    const Result<bool> encoded = checkOutputs(options);
    if (!encoded) {
        return tl::unexpected(encoded.error());
    }
    Result<OpenStage> opened = openStage(options);
    if (!opened) {
        return tl::unexpected(opened.error());
    }
    Stage* const stage = &opened->stage;
    const Result<Settings> settings = settingsFor(*stage, options);
    if (!settings) {
        return tl::unexpected(settings.error());
    }
    const Result<FramePlan> plan = stage->decide(*settings);
    if (!plan) {
        return tl::unexpected(plan.error());
    }
    if (Result<void> ready = stage->prepare(*plan); !ready) {
        return ready;
    }
    if (options.explain) {
        explain(*plan, stage->info(), stage->scene());
    }
    const Result<Turn> turn = drawTurn(*stage, *plan, options.frames, *encoded);
    if (!turn) {
        return tl::unexpected(turn.error());
    }
    std::optional<CostPicture> costs;
    if (options.heatmap) {
        Result<CostPicture> drawn = drawCosts(*stage, *plan, options, *encoded);
        if (!drawn) {
            return tl::unexpected(drawn.error());
        }
        costs = std::move(*drawn);
    }
    std::optional<PictureDifference> error;
    if (options.verify) {
        const Result<PictureDifference> found = verify(*stage, *plan, options.size);
        if (!found) {
            return tl::unexpected(found.error());
        }
        error = *found;
    }
    if (Result<void> saved =
            savePicture(options.output, options.size, costs ? costs->pixels : turn->firstPicture,
                        costs || options.background.has_value());
        !saved) {
        return saved;
    }
    if (error) {
        print(*error);
    }
    if (options.statsFile.empty()) {
        return {};
    }
    nlohmann::json content = stats(*stage, *plan, turn->frameMs);
    if (error) {
        content["error"] = toJson(*error);
    }
    if (costs) {
        content["heatmap"] = costs->stats;
    }
    return writeFileAtomically(options.statsFile, content.dump(2) + "\n");
}

} // namespace slabcast
