#include <fmt/core.h>

#include "perf/model/model_report.h"
#include "perf/run_store.h"
#include "platform/cli/commands.h"
#include "platform/cli/open_stage.h"
#include "platform/cli/report_files.h"

namespace slabcast {

namespace {

constexpr int kPaperEdge = 256; // voxels, of the paper's skull

/// The volume once more, as the paper had its own.
Result<PaperVolume> paperVolumeOf(const ModelOptions& options, const TransferFunction& tf) {
    InputOptions cube = options.input;
    cube.downsample = 1;
    cube.cubeEdge = kPaperEdge;
    return openVolume(cube).map([&](const Volume& volume) { return paperVolume(volume, tf); });
}

} // namespace

Result<void> modelCommand(const ModelOptions& options, const std::string& command) {
    Result<OpenStage> opened = openStage(options);
    if (!opened) {
        return tl::unexpected(opened.error());
    }
    Stage& stage = opened->stage;
    DiskFolder folder(options.folder);
    return folder.make("model.json")
        .and_then([&] {
            return claim(folder, {"model", stage.info().name, command});
        })
        .and_then([&] { return paperVolumeOf(options, stage.scene().look().tf); })
        .and_then([&](PaperVolume paper) {
            return modelReport(stage, {options.layersPerPlane, std::move(paper)}, runOf(command),
                               folder);
        })
        .map([](const std::vector<std::string>& lines) {
            for (const std::string& line : lines) {
                fmt::print("{}\n", line);
            }
        });
}

} // namespace slabcast
