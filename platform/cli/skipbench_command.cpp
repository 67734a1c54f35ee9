#include <fmt/core.h>

#include "perf/error/scene_key.h"
#include "perf/skip/bench.h"
#include "platform/cli/commands.h"
#include "platform/cli/open_stage.h"
#include "platform/cli/progress.h"
#include "platform/cli/report_files.h"
#include "platform/cli/transfer_choice.h"
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

/// A volume as it is read, before minutes are spent on the first: that it can be, and what its
/// pictures depend on.
Result<skipbench::Input> inputOf(const SkipbenchOptions& options, const Session& session,
                                 const std::string& input) {
    InputOptions given = options.input;
    given.volume = input;
    const InputOptions fitting =
        admittingWhatFits(std::move(given), session.device.caps(), stageDescOf(options));
    return openVolume(fitting).and_then([&](const Volume& volume) {
        const VolumeStatistics statistics = statisticsOf(volume);
        const std::string tf = transferOf(options, input);
        return chooseTransferFunction(tf, {statistics, volume.unit},
                                      likelyModality(volume, statistics))
            .map([&](const TransferFunction& chosen) {
                const std::string voxels = fingerprint(volume.voxels);
                return skipbench::Input{.volume = input,
                                        .voxels = voxels,
                                        .usualTransfer = options.tf.empty(),
                                        .key = {{"name", volume.name},
                                                {"voxels", voxels},
                                                {"type", name(volume.type)},
                                                {"placement", placementKey(volume.geometry)},
                                                {"transfer_function", transferKey(chosen)}}};
            });
    });
}

Result<std::vector<skipbench::Input>> inputsOf(const SkipbenchOptions& options,
                                               const Session& session) {
    std::vector<skipbench::Input> inputs;
    for (const std::string& volume : options.volumes) {
        Result<skipbench::Input> input = inputOf(options, session, volume);
        if (!input) {
            return tl::unexpected(input.error());
        }
        inputs.push_back(std::move(*input));
    }
    return inputs;
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
    DiskFolder folder(options.folder);
    const Result<Session> session = openSession(options.session);
    if (!session) {
        return tl::unexpected(session.error());
    }
    Result<std::vector<skipbench::Input>> inputs = inputsOf(options, *session);
    if (!inputs) {
        return tl::unexpected(inputs.error());
    }
    if (const Result<void> ready = folder.make("skipbench.json"); !ready) {
        return ready;
    }
    const skipbench::Desc desc{.volumes = std::move(*inputs),
                               .device = session->device.caps(),
                               .stage = stageDescOf(options),
                               .sizes = options.sizes,
                               .frames = options.frames,
                               .quick = options.quick};
    return skipbench::run(desc, hostOf(options, *session), runOf(command), folder)
        .and_then([&](const skipbench::Report& report) { return write(folder, report); });
}

} // namespace slabcast
