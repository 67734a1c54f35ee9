#include <optional>

#include <fmt/core.h>

#include "perf/error/error_table_json.h"
#include "perf/frame/frame_report.h"
#include "platform/cli/commands.h"
#include "platform/cli/error_table_file.h"
#include "platform/cli/open_stage.h"
#include "platform/cli/picture_file.h"
#include "platform/cli/ratio_file.h"
#include "platform/cli/report_files.h"
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
    const Result<std::vector<MeasuredError>> table = readErrorTable(stage.caps());
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

/// One still picture is the same in every run: its ratio goes by no clock. Of several frames it may
/// be what was measured.
Result<FramePlan> planOf(Stage& stage, const Settings& settings, const RenderOptions& options) {
    if (options.frames == 1) {
        return stage.decide(settings);
    }
    return ratiosOf(stage, settings).and_then([&](const FoundRatios& found) {
        if (options.explain && !found.origin.empty()) {
            fmt::print("ratios: {}\n", found.origin);
        }
        return stage.decide(settings, found.ratios);
    });
}

void print(const PictureDifference& d) {
    fmt::print("error: RMSE {:.4g}, PSNR {:.4g} dB, at most {:.4g}; CIEDE2000 {:.3g} on average, "
               "{:.3g} at the 99.9th percentile\n",
               d.rmse, d.psnr, d.max, d.meanDeltaE, d.p999DeltaE);
}

/// Both outputs are known to be writable before any work is done, so that neither is left without
/// the other.
Result<bool> checkOutputs(const RenderOptions& options) {
    if (!options.statsFile.empty()) {
        if (const Result<void> sound = checkWritable(options.statsFile); !sound) {
            return tl::unexpected(sound.error());
        }
    }
    return pictureIsEncoded(options.output);
}

/// What is asked for of a plan.
struct Drawing {
    Turn turn;
    std::optional<CostPicture> costs;
    std::optional<PictureDifference> error;
};

Result<Drawing> drawAll(Stage& stage, const FramePlan& plan, const RenderOptions& options,
                        bool encoded) {
    Drawing drawing;
    Result<Turn> turn = drawTurn(stage, plan, options.frames, encoded);
    if (!turn) {
        return tl::unexpected(turn.error());
    }
    drawing.turn = std::move(*turn);
    if (options.heatmap) {
        Result<CostPicture> costs =
            drawCosts(stage, plan, *options.heatmap, options.heatmapScale, encoded);
        if (!costs) {
            return tl::unexpected(costs.error());
        }
        drawing.costs = std::move(*costs);
    }
    if (options.verify) {
        const Result<PictureDifference> error = errorOf(stage, plan);
        if (!error) {
            return tl::unexpected(error.error());
        }
        drawing.error = *error;
    }
    return drawing;
}

Result<void> writeAll(Stage& stage, const FramePlan& plan, const Settings& settings,
                      const RenderOptions& options, const Drawing& drawing) {
    const auto& [turn, costs, error] = drawing;
    if (Result<void> saved =
            savePicture(options.output, options.size, costs ? costs->pixels : turn.firstPicture,
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
    const FrameFindings findings{turn.frameMs, error, costs ? &*costs : nullptr};
    return writeFileAtomically(options.statsFile,
                               frameReport(stage, plan, settings, findings, runOf("")));
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
    Stage& stage = opened->stage;
    const Result<Settings> settings = settingsFor(stage, options);
    const Result<FramePlan> plan =
        settings.and_then([&](const Settings& s) { return planOf(stage, s, options); });
    if (!plan) {
        return tl::unexpected(plan.error());
    }
    if (Result<void> ready = stage.prepare(*plan); !ready) {
        return ready;
    }
    if (options.explain) {
        explain(*plan, stage.info(), stage.scene());
    }
    return drawAll(stage, *plan, options, *encoded).and_then([&](const Drawing& drawing) {
        return writeAll(stage, *plan, *settings, options, drawing);
    });
}

} // namespace slabcast
