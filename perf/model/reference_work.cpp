#include "perf/model/reference_work.h"

#include <string>
#include <string_view>
#include <vector>

#include "core/base/number_text.h"
#include "core/scene/known_devices.h"
#include "perf/model/segment_costs.h"

namespace slabcast {

namespace {

constexpr std::string_view kTable =
#include "perf/model/reference_work.inc"
    ;

/// A line: scene, layers per plane (0: all), layers in all, pixels, fragments, rays, layers, volume
/// fetches, looks, bytes of the volume, and by pixels of a wave (4, 8, 16, 64) how many times as
/// many layers and looks it does.
constexpr std::size_t kNumbers = 17;
constexpr int kWavePixels[] = {4, 8, 16, 64};

struct Row {
    ReferenceScene scene = ReferenceScene::Skull;
    std::vector<double> numbers;

    FrameWork workOn(const GpuRates& gpu) const {
        FrameWork work;
        work.pixels = numbers[2];
        work.fragments = numbers[3];
        work.rays = numbers[4];
        work.layers = numbers[5];
        work.volumeFetches = numbers[6];
        work.looks = numbers[7];
        work.volumeBytes = numbers[8];
        work.views = 2;
        std::size_t at = 9;
        for (const int pixels : kWavePixels) {
            if (pixels == gpu.waveWidth * gpu.waveHeight) {
                work.layerDivergence = numbers[at];
                work.lookDivergence = numbers[at + 1];
            }
            at += 2;
        }
        return work;
    }
};

std::vector<Row> parsed(std::string_view table) {
    std::vector<Row> rows;
    while (!table.empty()) {
        const std::size_t length = std::min(table.find('\n'), table.size());
        std::string_view line = table.substr(0, length);
        table.remove_prefix(std::min(length + 1, table.size()));
        Row row;
        row.scene = line.starts_with("skull,") ? ReferenceScene::Skull : ReferenceScene::Full;
        while (line.find(',') != std::string_view::npos) {
            line.remove_prefix(line.find(',') + 1);
            row.numbers.push_back(numberFrom(line.substr(0, line.find(','))).value_or(0.0));
        }
        if (!row.numbers.empty()) {
            SLABCAST_EXPECTS(row.numbers.size() == kNumbers, row.numbers.size());
            rows.push_back(std::move(row));
        }
    }
    return rows;
}

/// As the demo's skull is, or a volume without anything empty, in what decides a shader.
SceneFacts factsOf(ReferenceScene scene) {
    SceneFacts facts;
    facts.sphere = {glm::dvec3(0.0), 200.0};
    facts.skip.structure = SkipStructure::Proximity;
    facts.occupiedFraction = scene == ReferenceScene::Skull ? 0.2 : 1.0;
    facts.filtersTable = true;
    facts.maxExtinctionPerMm = scene == ReferenceScene::Skull ? 2.0 : 0.05;
    return facts;
}

} // namespace

std::optional<int> bestLayersPerPlane(const GpuRates& gpu, ReferenceScene scene) {
    static const std::vector<Row> rows = parsed(kTable);
    const KnownDevice* device = findKnownDevice(gpu.name);
    SLABCAST_EXPECTS(device != nullptr, gpu.megahertz);
    gl::Caps running;
    running.extensions.assign(device->extensions.begin(), device->extensions.end());
    const gl::Caps caps = assumedCaps(*device, running);
    std::optional<int> best;
    double bestMs = 0.0;
    for (const Row& row : rows) {
        if (row.scene != scene) {
            continue;
        }
        Settings settings;
        settings.totalLayers = static_cast<int>(row.numbers[1]);
        settings.layersPerPlane =
            row.numbers[0] == 0.0 ? *settings.totalLayers : static_cast<int>(row.numbers[0]);
        const Result<FramePlan> made = plan(factsOf(scene), settings, caps, {});
        SLABCAST_EXPECTS(made.has_value(), row.numbers[0]);
        const std::optional<SegmentCosts> costs = segmentCosts(gpu.compiler, made->variant);
        if (!costs) {
            continue;
        }
        FrameWork work = row.workOn(gpu);
        work.turns = made->variant.unroll == 0
                         ? std::max(work.layers / layersPerGroup(made->variant), work.looks)
                         : 0.0;
        work.layerOfOurOwn = made->order == BlendOrder::FrontToBack;
        const double ms = modelFrame(work, *costs, gpu).frameMs;
        if (!best || ms < bestMs) {
            best = static_cast<int>(row.numbers[0]);
            bestMs = ms;
        }
    }
    return best;
}

} // namespace slabcast
