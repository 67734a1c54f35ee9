#include "perf/run_store.h"
#include "perf/stability/bench.h"
#include "perf/stability/report.h"
#include "platform/cli/commands.h"
#include "platform/cli/progress.h"
#include "platform/cli/report_files.h"

namespace slabcast {

Result<void> stabilityCommand(const StabilityOptions& options, const std::string& command) {
    DiskFolder folder(options.folder, stability::kPictures);
    Result<Session> session = folder.make("stability.json")
                                  .and_then([&] {
                                      return claim(folder, {"stability", options.family, command});
                                  })
                                  .and_then([&] { return openSession(options.session); });
    if (!session) {
        return tl::unexpected(session.error());
    }
    Result<Renderer> renderer = Renderer::create(session->device);
    if (!renderer) {
        return tl::unexpected(renderer.error());
    }
    stability::Bench bench(*renderer, session->device, options.reduced);
    return stability::measure(bench, options.family, runOf(command), folder, terminal())
        .and_then([&] {
            return folder.makePage("stability_report.py", "stability.json and stability.csv");
        })
        .and_then([&] {
            return stability::verdict(bench.cases()).map_error([&](Error error) {
                error.detail += " in " + options.folder.path;
                return error;
            });
        });
}

} // namespace slabcast
