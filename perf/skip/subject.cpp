#include "perf/skip/subject.h"

#include <iterator>

namespace slabcast::skipbench {

namespace {

constexpr int kUsualPartitions = 64; // as in Rauter et al. 2024, figure 4

} // namespace

void Bench::add(std::vector<Row> more) {
    rows.insert(rows.end(), std::make_move_iterator(more.begin()),
                std::make_move_iterator(more.end()));
}

Result<double> Bench::timed(const std::string& id,
                            const std::function<Result<double>()>& measure) const {
    const Json* kept = store.find(id);
    if (kept != nullptr && kept->at("ms").number() > 0.0) {
        return kept->at("ms").number();
    }
    return measure().and_then([&](double ms) {
        return store.add({{"id", id}, {"ms", ms}}).map([=] { return ms; });
    });
}

std::vector<SkipOptions> usualStructures(const Desc& desc) {
    std::vector<SkipOptions> all;
    for (const SkipStructureInfo& info : skipStructures()) {
        all.push_back({.structure = info.structure,
                       .partitions = kUsualPartitions,
                       .separateMinimum = info.structure == SkipStructure::Partitioned,
                       .memoryBudgetBytes = desc.stage.settings.skipOptions.memoryBudgetBytes});
    }
    return all;
}

Result<std::vector<Subject>> subjectsOf(const Stage& stage,
                                        std::span<const SkipOptions> structures) {
    std::vector<Subject> subjects;
    for (const SkipOptions& options : structures) {
        Result<Scene> scene = stage.variation(stage.scene().look().tf, options);
        if (scene) {
            subjects.push_back({options, std::move(*scene)});
        } else if (scene.error().code != ErrorCode::VolumeTooLarge) {
            return tl::unexpected(scene.error());
        }
    }
    return subjects;
}

} // namespace slabcast::skipbench
