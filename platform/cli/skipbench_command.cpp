#include <fmt/core.h>

#include "perf/skip/bench.h"
#include "platform/cli/commands.h"
#include "platform/cli/open_stage.h"
#include "platform/cli/progress.h"
#include "platform/cli/report_files.h"
#include "platform/json/transfer_json.h"

namespace slabcast {

namespace {

/// What a volume is shown with: a phantom may have a preset of its own.
std::string transferOf(const SkipbenchOptions& options, const std::string& volume) {
    for (const std::string& preset : presetNames()) {
        const std::string phantom = "phantom:" + preset;
        if (options.tf.empty() && (volume == phantom || volume.starts_with(phantom + ":"))) {
            return preset;
        }
    }
    return options.tf;
}

/// A preset that suits the volume's kind and is not what it is shown with already.
Result<TransferFunction> otherPreset(const Stage& stage) {
    const Scene& scene = stage.scene();
    const bool ct = stage.info().modality == Modality::Ct;
    for (const char* preset : {ct ? "ct-bone-skin" : "linear", ct ? "ct-lung" : "mr"}) {
        Result<TransferFunction> tf = presetTransferFunction(preset, scene.statistics());
        if (!tf || tf->name != scene.look().tf.name) {
            return tf;
        }
    }
    return presetTransferFunction("angio", scene.statistics());
}

/// That all volumes fit and can be read, before minutes are spent on the first.
Result<void> checkVolumes(const SkipbenchOptions& options, const Session& session) {
    for (const std::string& name : options.volumes) {
        InputOptions input = options.input;
        input.volume = name;
        const Result<Volume> volume = openVolume(
            admittingWhatFits(std::move(input), session.device.caps(), stageDescOf(options)));
        if (!volume) {
            return tl::unexpected(volume.error());
        }
    }
    return {};
}

skipbench::Host hostOf(const SkipbenchOptions& options, const Session& session) {
    const auto open = [&](const std::string& volume, int cubeEdge, StageDesc desc) {
        InputOptions input = options.input;
        input.volume = volume;
        input.cubeEdge = cubeEdge;
        return openStage(session, input, transferOf(options, volume), std::move(desc));
    };
    return {.open = open, .otherTransfer = otherPreset, .watcher = terminal()};
}

Result<void> write(DiskFolder& folder, const skipbench::Report& report) {
    return folder.write("skipbench.csv", report.csv)
        .and_then([&] { return folder.write("skipbench.json", report.json); })
        .and_then([&] {
            return folder.makePage("skipbench_report.py", "skipbench.json and skipbench.csv");
        })
        .map([&] { fmt::print("{}\n", report.line); });
}

} // namespace

Result<void> skipbenchCommand(const SkipbenchOptions& options, const std::string& command) {
    DiskFolder folder(options.outputFolder);
    const Result<Session> session = openSession();
    if (!session) {
        return tl::unexpected(session.error());
    }
    if (const Result<void> ready =
            checkVolumes(options, *session).and_then([&] { return folder.make("skipbench.json"); });
        !ready) {
        return ready;
    }
    const skipbench::Desc desc{.volumes = options.volumes,
                               .stage = stageDescOf(options),
                               .sizes = options.sizes,
                               .frames = options.frames,
                               .quick = options.quick};
    return skipbench::run(desc, hostOf(options, *session), runOf(command))
        .and_then([&](const skipbench::Report& report) { return write(folder, report); });
}

} // namespace slabcast
