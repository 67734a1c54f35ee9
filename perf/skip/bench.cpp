#include "perf/skip/bench.h"

#include <algorithm>
#include <iterator>

#include "perf/report_json.h"
#include "perf/run_store.h"
#include "perf/settings_json.h"
#include "perf/skip/builds.h"
#include "perf/skip/figures.h"
#include "perf/skip/frames.h"
#include "perf/skip/merging.h"
#include "perf/skip/report.h"
#include "perf/skip/search.h"
#include "perf/skip/sizes.h"

namespace slabcast::skipbench {

namespace {

/// The CT skull that assets/prepare_skull.py makes, and the TF that its goals were set with.
constexpr const char* kSkullVoxels = "7cddd6bf41a5f58c";
constexpr const char* kSkullTransfer = "CT bone";

VolumeRecord recordOf(const Stage& stage, const Input& input, const std::string& label,
                      const Workshop& workshop) {
    const Texels& texels = stage.scene().texels();
    return {.name = label,
            .input = input.volume,
            .info = stage.info(),
            .transferFunction = stage.scene().look().tf.name,
            .texelFormat = texels.format,
            .texelBytes = static_cast<std::int64_t>(texels.data.size()),
            .codesMs = workshop.codesMs(),
            .own = ownSceneOf(input, stage.scene().look().tf.name)};
}

/// The best parameters' structures, built and drawn.
Result<void> measureBest(Bench& bench, const Workshop& workshop, const BestParameters& best) {
    bench.show("building");
    Result<std::vector<Row>> builds =
        buildRows(workshop, workshop.visibilityUnder(bench.stage.scene()), best.marching,
                  kFewestFrames, bench.row(Table::Structures, {}), bench.store);
    if (!builds) {
        return tl::unexpected(builds.error());
    }
    bench.add(std::move(*builds));
    Result<std::vector<Subject>> marching = subjectsOf(bench.stage, best.marching);
    Result<std::vector<Subject>> terminating = subjectsOf(bench.stage, best.terminating);
    if (!marching || !terminating) {
        return tl::unexpected(marching ? terminating.error() : marching.error());
    }
    return measureFrames(bench, {std::move(*marching), std::move(*terminating)});
}

/// All tables of one volume but its sizes.
Result<VolumeRecord> measureVolume(Bench& bench, const Input& input, const Host& host) {
    const std::string& tfName = bench.stage.scene().look().tf.name;
    if (!bench.stage.scene().facts().anythingVisible) {
        return fail(ErrorCode::InvalidArgument,
                    input.volume + ": '" + tfName +
                        "' shows nothing of it, so there is nothing to compare: give another --tf");
    }
    const Result<TransferFunction> other = host.otherTransfer(bench.stage);
    if (!other) {
        return tl::unexpected(other.error());
    }
    const Workshop workshop(bench.stage);
    VolumeRecord record = recordOf(bench.stage, input, bench.volume, workshop);
    return searchParameters(bench)
        .and_then([&](const BestParameters& best) { return measureBest(bench, workshop, best); })
        .and_then([&] { return measureMerging(bench, workshop, *other); })
        .map([&] { return std::move(record); });
}

/// Labels that tell volumes apart.
std::string labelOf(const std::string& name, std::span<const VolumeRecord> volumes) {
    std::string label = name;
    const auto taken = [&] {
        return std::any_of(volumes.begin(), volumes.end(),
                           [&](const VolumeRecord& volume) { return volume.name == label; });
    };
    for (int k = 2; taken(); ++k) {
        label = name + " (" + std::to_string(k) + ")";
    }
    return label;
}

/// What came of all volumes so far.
struct Findings {
    std::vector<VolumeRecord> volumes;
    std::vector<Row> rows;
    gl::Caps caps;

    void add(std::vector<Row> more) {
        rows.insert(rows.end(), std::make_move_iterator(more.begin()),
                    std::make_move_iterator(more.end()));
    }
};

std::string subjectOf(const Desc& desc) {
    std::string names;
    for (const Input& input : desc.volumes) {
        names += (names.empty() ? "" : ", ") + input.volume;
    }
    return names;
}

/// All that its pieces depend on.
Json keyOf(const Desc& desc, const RunInfo& info) {
    Json volumes = Json::list();
    for (const Input& input : desc.volumes) {
        volumes.push_back(input.key);
    }
    Json key = conditionsOf(desc.stage);
    key.update({{"commit", info.commit},
                {"device", toJson(desc.device)},
                {"volumes", std::move(volumes)},
                {"sizes", Json::listOf(desc.sizes)},
                {"frames", desc.frames},
                {"quick", desc.quick}});
    return key;
}

Result<void> measureInput(const Input& input, const Desc& desc, const StageDesc& opened,
                          const Host& host, RunStore& store, Findings& findings) {
    ProgressLine progress(host.watcher);
    Result<Stage> stage = host.open(input.volume, 0, opened);
    if (!stage) {
        return tl::unexpected(stage.error());
    }
    const std::string label = labelOf(stage->info().name, findings.volumes);
    Bench bench{*stage, desc, label, progress, store};
    return measureVolume(bench, input, host).map([&](VolumeRecord record) {
        findings.volumes.push_back(std::move(record));
        findings.add(std::move(bench.rows));
        findings.caps = stage->caps();
    });
}

} // namespace

OwnScene ownSceneOf(const Input& input, const std::string& transferFunction) {
    if (input.usualTransfer && input.volume.starts_with("phantom:")) {
        return OwnScene::Phantom;
    }
    const bool skull = input.voxels == kSkullVoxels && transferFunction == kSkullTransfer;
    return skull ? OwnScene::Skull : OwnScene::None;
}

Result<Report> run(const Desc& desc, const Host& host, const RunInfo& info, ReportFolder& folder) {
    SLABCAST_EXPECTS(desc.frames >= kFewestFrames, desc.frames);
    Result<RunStore> store = RunStore::open(
        folder, {"skipbench", subjectOf(desc), info.command, keyOf(desc, info)}, host.watcher);
    if (!store) {
        return tl::unexpected(store.error());
    }
    StageDesc opened = desc.stage;
    opened.settings.shaded = true;                // for the rows that are; others leave it out
    opened.settings.skip = SkipStructure::Blocks; // codes are made here, for all that follow
    Findings findings;
    for (const Input& input : desc.volumes) {
        if (Result<void> done = measureInput(input, desc, opened, host, *store, findings); !done) {
            return tl::unexpected(done.error());
        }
        if (findings.volumes.size() == 1) {
            ProgressLine progress(host.watcher);
            Result<std::vector<Row>> sizes =
                measureSizes(desc, opened, host, findings.volumes.front(), progress, *store);
            if (!sizes) {
                return tl::unexpected(sizes.error());
            }
            findings.add(std::move(*sizes));
        }
    }
    const std::vector<Figure> figures = figuresOf(findings.volumes, findings.rows);
    return reportOf(desc, {findings.volumes, findings.rows, figures}, info, findings.caps);
}

} // namespace slabcast::skipbench
