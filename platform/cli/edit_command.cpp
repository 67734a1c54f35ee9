#include <filesystem>

#include <fmt/core.h>

#include "perf/edit/replay.h"
#include "perf/run_store.h"
#include "platform/cli/commands.h"
#include "platform/cli/edit_script.h"
#include "platform/cli/open_stage.h"
#include "platform/cli/ratio_file.h"
#include "platform/cli/report_files.h"
#include "platform/cli/skip_options.h"
#include "platform/cli/transfer_choice.h"
#include "platform/json/read_text.h"

namespace slabcast {

namespace {

/// The start is the script's own, or what --tf says.
Result<EditScript> scriptOf(const EditOptions& options, const Stage& stage) {
    const Scene& scene = stage.scene();
    const TransferSubject subject{scene.statistics(), stage.info().unit};
    const TransferByName byName = [&](const std::string& name) {
        return chooseTransferFunction(name, subject, stage.info().modality);
    };
    if (!options.scriptFile.empty()) {
        return readText(options.scriptFile, "script").and_then([&](const std::string& text) {
            return parseEditScript(text,
                                   std::filesystem::path(options.scriptFile).filename().string(),
                                   byName, subject);
        });
    }
    if (!options.interpolate) {
        return usualScript(scene.look().tf, scene.statistics(), options.frames);
    }
    const auto& [first, second] = *options.interpolate;
    return byName(first).and_then([&, &nameOfSecond = second](const TransferFunction& a) {
        return byName(nameOfSecond).map([&](const TransferFunction& b) {
            return interpolation(a, b, options.frames);
        });
    });
}

EditDesc descOf(const EditOptions& options, EditScript script) {
    EditDesc desc{.script = std::move(script),
                  .origin = !options.scriptFile.empty() ? "script"
                            : options.interpolate       ? "interpolation"
                                                        : "usual",
                  .settings = options.settings,
                  .ratios =
                      [](Stage& stage, const Settings& settings) {
                          return ratiosOf(stage, settings).map([](FoundRatios found) {
                              return std::move(found.ratios);
                          });
                      },
                  .live = liveOptions(options),
                  .turnDegrees = options.turnDegrees,
                  .workBudgetMs = options.workBudgetMs,
                  .budgetMs = options.budgetMs,
                  .octreeFrames = options.octreeFrames,
                  .replays = options.replays,
                  .verify = options.verify};
    desc.live.quietFrames = options.quietFrames;
    return desc;
}

/// Fails: Internal, where a frame was drawn wrong.
Result<void> verdict(const EditReport& report, const std::string& folder) {
    return report.wrongFrames == 0
               ? Result<void>{}
               : fail(ErrorCode::Internal,
                      fmt::format("{} of {} frames are not what drawing from scratch gives: see "
                                  "edit.csv in {}; report it",
                                  report.wrongFrames, report.frames, folder));
}

Result<void> write(DiskFolder& folder, const EditReport& report) {
    return folder.write("edit.csv", report.csv)
        .and_then([&] { return folder.write("edit.json", report.json); })
        .and_then([&] { return folder.makePage("edit_report.py", "edit.json and edit.csv"); });
}

} // namespace

Result<void> editCommand(const EditOptions& options, const std::string& command) {
    SceneOptions scene = options;
    scene.settings.skip = SkipStructure::None; // the scenes that are edited have what they need
    scene.settings.tighten = false;
    Result<OpenStage> opened = openStage(scene);
    if (!opened) {
        return tl::unexpected(opened.error());
    }
    Stage& stage = opened->stage;
    DiskFolder folder(options.folder);
    return scriptOf(options, stage)
        .and_then([&](EditScript script) {
            return folder.make("edit.json")
                .and_then([&] {
                    return claim(folder, {"edit", stage.info().name, command});
                })
                .map([&] { return std::move(script); });
        })
        .and_then([&](EditScript script) {
            return replayEdits(stage, descOf(options, std::move(script)), runOf(command));
        })
        .and_then([&](const EditReport& report) {
            return write(folder, report).and_then([&] {
                return verdict(report, options.folder.path);
            });
        });
}

} // namespace slabcast
