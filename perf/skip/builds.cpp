#include "perf/skip/builds.h"

#include <algorithm>
#include <functional>
#include <optional>

#include "core/base/stopwatch.h"
#include "perf/skip/row_json.h"

namespace slabcast::skipbench {

namespace {

/// Why a structure cannot be had on one side: too large, or beyond the device.
constexpr ErrorCode kRefusals[] = {ErrorCode::VolumeTooLarge, ErrorCode::DeviceUnsupported,
                                   ErrorCode::DeviceOutOfMemory};

constexpr double kBuildsMs = 2.5e3; // of a structure on one side, after which one more is too many
/// A software driver's shaders take seconds for so many, a graphics processor's milliseconds.
constexpr std::int64_t kMostSoftwareVoxels = 1 << 24;

/// One structure's builds on one side so far.
struct Builds {
    std::vector<double> ms, updateMs;
    double spentMs = 0.0;
    std::optional<BuiltSkip> last;
    std::string refused;

    /// Once more, where there is time and it was not refused. One that is not `counted` touches
    /// memory for the first time and compiles what it needs: it counts where it is to be the last.
    Result<void> again(const std::function<Result<BuiltSkip>()>& build, bool counted) {
        if (!refused.empty() || spentMs > kBuildsMs) {
            return {};
        }
        last.reset(); // two of a kind may not fit
        Result<BuiltSkip> built = build();
        if (!built) {
            if (std::find(std::begin(kRefusals), std::end(kRefusals), built.error().code) ==
                std::end(kRefusals)) {
                return tl::unexpected(built.error());
            }
            refused = built.error().detail;
            ms.clear();
            updateMs.clear();
            return {};
        }
        spentMs += built->buildMs;
        if (counted || spentMs > kBuildsMs) {
            ms.push_back(built->buildMs);
            updateMs.push_back(built->updateMs);
        }
        last = std::move(*built);
        return {};
    }
};

Build resultOf(const SkipOptions& options, Builds cpu, Builds gpu) {
    if (infoOf(options.structure).dependsOnTransfer) {
        cpu.updateMs.clear(); // it is built anew
    }
    Build build{.ms = std::move(cpu.ms),
                .updateMs = std::move(cpu.updateMs),
                .gpuMs = std::move(gpu.ms),
                .refused = std::move(cpu.refused),
                .gpuRefused = std::move(gpu.refused)};
    if (cpu.last) {
        build.memory = {gpuBytes(*cpu.last), hostBytes(*cpu.last)};
        build.occupiedFraction = cpu.last->occupiedFraction;
    }
    return build;
}

} // namespace

Workshop::Workshop(Stage& stage) : stage_(stage) {
    const Stopwatch watch;
    codes_ = encodeCodes(stage.scene().texels());
    codesMs_ = watch.ms();
}

CellVisibility Workshop::visibilityUnder(const Scene& scene) const {
    return cellVisibility(codes_, scene.texels(), scene.table(), stage_.filterErrorSampled());
}

Result<BuiltSkip> Workshop::buildOnGpu(const SkipOptions& options) const {
    const glm::i64vec3 dims(stage_.info().dims);
    if (stage_.caps().isSoftware && dims.x * dims.y * dims.z > kMostSoftwareVoxels) {
        return fail(ErrorCode::DeviceUnsupported,
                    "a software driver takes minutes for so many voxels: not measured");
    }
    Scene scene = stage_.scene();
    return stage_.renderer().buildSkip(scene, options).map([&] { return scene.skip(); });
}

namespace {

/// The same of each structure but none, in turn.
Result<std::vector<Build>> buildAll(const Workshop& workshop, const CellVisibility& visibility,
                                    std::span<const Row> rows, int rounds) {
    struct Sides {
        Builds cpu, gpu;
    };
    std::vector<Sides> all(rows.size());
    for (int round = -1; round < rounds; ++round) {
        for (std::size_t k = 0; k < rows.size(); ++k) {
            const SkipOptions& options = rows[k].options;
            const Result<void> built =
                all[k]
                    .cpu.again([&] { return workshop.build(options, visibility); }, round >= 0)
                    .and_then([&] {
                        return all[k].gpu.again([&] { return workshop.buildOnGpu(options); },
                                                round >= 0);
                    });
            if (!built) {
                return tl::unexpected(built.error());
            }
        }
    }
    std::vector<Build> builds;
    for (std::size_t k = 0; k < rows.size(); ++k) {
        builds.push_back(resultOf(rows[k].options, std::move(all[k].cpu), std::move(all[k].gpu)));
    }
    return builds;
}

} // namespace

Result<std::vector<Row>> buildRows(const Workshop& workshop, const CellVisibility& visibility,
                                   std::span<const SkipOptions> structures, int rounds,
                                   const Row& beginning, RunStore& store) {
    std::vector<Row> rows;
    std::string id = "builds";
    for (const SkipOptions& options : structures) {
        if (options.structure != SkipStructure::None) {
            rows.push_back(beginning);
            rows.back().options = options;
            id += " " + idOf(rows.back());
        }
    }
    const Json* kept = store.find(id);
    if (kept == nullptr || kept->at("builds").size() != rows.size()) {
        const Result<std::vector<Build>> builds = buildAll(workshop, visibility, rows, rounds);
        if (!builds) {
            return tl::unexpected(builds.error());
        }
        Json piece = {{"id", id}, {"builds", Json::list()}};
        for (const Build& build : *builds) {
            piece["builds"].push_back(keptOf(build));
        }
        if (Result<void> done = store.add(std::move(piece)); !done) {
            return tl::unexpected(done.error());
        }
        kept = store.find(id);
    }
    for (std::size_t k = 0; k < rows.size(); ++k) {
        rows[k].build = buildOf(kept->at("builds").at(k));
    }
    return rows;
}

} // namespace slabcast::skipbench
