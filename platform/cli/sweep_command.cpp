#include <cstdlib>

#include "perf/sweep/sweep.h"
#include "platform/cli/commands.h"
#include "platform/cli/open_stage.h"
#include "platform/cli/ratio_file.h"
#include "platform/cli/report_files.h"

namespace slabcast {

Result<void> sweepCommand(const SweepOptions& options, const std::string& command) {
    // Compile times are part of the report: a driver that finds its earlier results would report
    // none.
    setenv("MESA_SHADER_CACHE_DISABLE", "true", 0);
    Result<OpenStage> opened = openStage(options);
    if (!opened) {
        return tl::unexpected(opened.error());
    }
    DiskFolder folder(options.folder, kSweepThumbnails);
    const SweepDesc desc{options.layersPerPlane, options.frames};
    return folder.make("sweep.json")
        .and_then([&] { return sweep(opened->stage, desc, runOf(command), folder); })
        .map([&](std::vector<RatioMeasurement> ratios) {
            if (!ratios.empty()) {
                keepRatios(opened->stage, options.settings, std::move(ratios));
            }
        })
        .and_then([&] { return folder.makePage("report.py", "sweep.json and sweep.csv"); });
}

} // namespace slabcast
