#include "platform/cli/skipbench_builds.h"

#include <chrono>
#include <optional>

namespace slabcast {

namespace {

using Clock = std::chrono::steady_clock;
using nlohmann::json;

/// One structure's builds so far.
struct Builds {
    std::vector<double> ms, updateMs;
    std::optional<BuiltSkip> last;
    std::string refused;
};

json rowOf(const Builds& builds, const SkipOptions& options, json row) {
    row.update(toJson(options));
    if (!builds.last) {
        row["refused"] = builds.refused;
        return row;
    }
    row.update({{"buildMs", toJson(summarise(builds.ms))},
                {"updateMs", infoOf(options.structure).dependsOnTransfer
                                 ? json()
                                 : toJson(summarise(builds.updateMs))},
                {"gpuBytes", gpuBytes(*builds.last)},
                {"hostBytes", hostBytes(*builds.last)},
                {"occupiedFraction", builds.last->occupiedFraction}});
    return row;
}

} // namespace

Workshop::Workshop(const Stage& stage) : stage_(stage) {
    const auto start = Clock::now();
    codes_ = encodeCodes(stage.scene().texels());
    codesMs_ = std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

CellVisibility Workshop::visibilityUnder(const Scene& scene) const {
    return cellVisibility(codes_, scene.texels(), scene.table(),
                          filterErrorSampled(stage_.session(), scene.texels().format));
}

Result<json> buildRows(const Workshop& workshop, const Scene& scene,
                       const std::vector<SkipOptions>& structures, int rounds, const json& row) {
    const CellVisibility visibility = workshop.visibilityUnder(scene);
    std::vector<Builds> all(structures.size());
    for (int round = -1; round < rounds; ++round) { // -1: touches memory for the first time
        for (std::size_t k = 0; k < structures.size(); ++k) {
            Builds& builds = all[k];
            if (!builds.refused.empty()) {
                continue;
            }
            builds.last.reset(); // two of a kind may not fit
            Result<BuiltSkip> built = workshop.build(structures[k], visibility);
            if (!built && built.error().code != ErrorCode::VolumeTooLarge) {
                return tl::unexpected(built.error());
            }
            if (!built) {
                builds.refused = built.error().detail;
                continue;
            }
            if (round >= 0) {
                builds.ms.push_back(built->buildMs);
                builds.updateMs.push_back(built->updateMs);
            }
            builds.last = std::move(*built);
        }
    }
    json rows = json::array();
    for (std::size_t k = 0; k < structures.size(); ++k) {
        if (structures[k].structure != SkipStructure::None) {
            rows.push_back(rowOf(all[k], structures[k], row));
        }
    }
    return rows;
}

} // namespace slabcast
