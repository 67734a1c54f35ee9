#include "perf/error/worst_ray.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/reference/ray_trace.h"
#include "perf/csv.h"
#include "perf/error/error_grid.h"
#include "perf/error/reference_pictures.h"

namespace slabcast {

namespace {

constexpr const char* kJsonFile = "worst_ray.json";
constexpr const char* kCsvFile = "worst_ray.csv";

constexpr CsvColumn kColumns[] = {{"layer", "/layer"},
                                  {"distance_mm", "/distance_mm"},
                                  {"x_mm", "/place_mm/0"},
                                  {"y_mm", "/place_mm/1"},
                                  {"z_mm", "/place_mm/2"},
                                  {"length_mm", "/length_mm"},
                                  {"value", "/value"},
                                  {"red", "/color/0"},
                                  {"green", "/color/1"},
                                  {"blue", "/color/2"},
                                  {"opacity", "/opacity"},
                                  {"layer_alpha", "/layer_alpha"},
                                  {"gathered_red", "/gathered/0"},
                                  {"gathered_green", "/gathered/1"},
                                  {"gathered_blue", "/gathered/2"},
                                  {"gathered_alpha", "/gathered/3"},
                                  {"exact_red", "/exact/0"},
                                  {"exact_green", "/exact/1"},
                                  {"exact_blue", "/exact/2"},
                                  {"exact_alpha", "/exact/3"}};

Json listOf(glm::dvec3 v) {
    return Json::list({v.x, v.y, v.z});
}
Json listOf(glm::dvec4 v) {
    return Json::list({v.x, v.y, v.z, v.w});
}

double farthest(glm::dvec4 a, glm::dvec4 b) {
    const glm::dvec3 apart = glm::abs(glm::dvec3(a - b));
    return std::max({apart.x, apart.y, apart.z});
}

Json layersOf(const RayTrace& trace) {
    Json layers = Json::list();
    for (const TracedLayer& layer : trace.layers) {
        layers.push_back({{"layer", layer.index},
                          {"distance_mm", layer.distanceMm},
                          {"place_mm", listOf(layer.placeMm)},
                          {"length_mm", layer.lengthMm},
                          {"value", layer.value},
                          {"color", listOf(layer.color)},
                          {"opacity", layer.opacity},
                          {"layer_alpha", layer.alpha},
                          {"gathered", listOf(layer.gathered)},
                          {"exact", listOf(layer.exact)}});
    }
    return layers;
}

/// Of the eye that a pixel belongs to.
ViewTarget targetAt(const Stage& stage, glm::ivec2 pixel) {
    const std::vector<ViewTarget> targets = stage.views(0.0);
    const auto holds = [pixel](const ViewTarget& target) {
        const Viewport& v = target.viewport;
        return pixel.x >= v.x && pixel.x < v.x + v.width && pixel.y >= v.y &&
               pixel.y < v.y + v.height;
    };
    const auto found = std::find_if(targets.begin(), targets.end(), holds);
    return found == targets.end() ? targets.front() : *found;
}

Result<Lattice> latticeOf(Stage& stage, const Sampling& sampling) {
    return stage.reclassify(sampling.classification).and_then([&]() -> Result<Lattice> {
        const Settings settings =
            withSampling(stage.desc().settings, sampling, stage.scene().facts());
        return stage.plan(settings).map([](const FramePlan& plan) { return plan.lattice; });
    });
}

RayTrace traceAt(const Stage& stage, const Lattice& lattice, glm::ivec2 pixel) {
    const ViewTarget target = targetAt(stage, pixel);
    const Scene& scene = stage.scene();
    return traceRay({.texels = &stage.values(),
                     .geometry = scene.geometry(),
                     .tf = scene.look().tf,
                     .space = scene.provided()->space,
                     .view = target.view,
                     .viewport = target.viewport,
                     .lattice = lattice,
                     .tolerance = kReferenceTolerance},
                    glm::dvec2(pixel) + 0.5);
}

Json summaryOf(const Json& row, const RayTrace& trace, glm::ivec2 size) {
    const glm::dvec4 nothing(0.0);
    const TracedLayer* last = trace.layers.empty() ? nullptr : &trace.layers.back();
    Json all = row.at("worst_pixel");
    const auto y = static_cast<int>(all.at("pixel").at(1).whole());
    all.update({{"row", row.at("id")},
                {"pixel_from_the_top", Json::list({all.at("pixel").at(0), Json(size.y - 1 - y)})},
                {"eye_mm", listOf(trace.eyeMm)},
                {"direction", listOf(trace.direction)},
                {"entry_mm", trace.entryMm},
                {"exit_mm", trace.exitMm},
                {"entry_place_mm", listOf(trace.eyeMm + trace.entryMm * trace.direction)},
                {"exit_place_mm", listOf(trace.eyeMm + trace.exitMm * trace.direction)},
                {"layers_met", trace.layers.size()},
                {"gathered", listOf(last == nullptr ? nothing : last->gathered)},
                {"exact", listOf(last == nullptr ? nothing : last->exact)},
                {"json", kJsonFile},
                {"csv", kCsvFile}});
    return all;
}

} // namespace

Json worstPixel(const std::vector<glm::dvec4>& picture, const std::vector<glm::dvec4>& reference,
                glm::ivec2 size) {
    std::size_t worst = 0;
    for (std::size_t i = 1; i < picture.size(); ++i) {
        if (farthest(picture[i], reference[i]) > farthest(picture[worst], reference[worst])) {
            worst = i;
        }
    }
    const auto width = static_cast<std::size_t>(size.x);
    return {{"pixel", Json::list({worst % width, worst / width})},
            {"picture", listOf(picture[worst])},
            {"reference", listOf(reference[worst])},
            {"error", farthest(picture[worst], reference[worst])}};
}

const Json* rowToTrace(const Json& rows) {
    const Json* best = nullptr;
    const auto rank = [](const Json& row) {
        return std::pair(std::abs(std::log(row.at("layer_spacing").number())), totalRmse(row));
    };
    for (const Json& row : rows) {
        if (row.at("classify") == name(Classification::Post) &&
            (best == nullptr || rank(row) < rank(*best))) {
            best = &row;
        }
    }
    return best;
}

Result<Json> traceWorstRay(Stage& stage, const std::vector<Sampling>& grid, const Json& rows,
                           ReportFolder& folder) {
    const Json* row = rowToTrace(rows);
    if (row == nullptr) {
        return Json();
    }
    const auto sampling = std::find_if(grid.begin(), grid.end(),
                                       [&](const Sampling& s) { return row->at("id") == idOf(s); });
    SLABCAST_EXPECTS(sampling != grid.end(), grid.size());
    const Result<Lattice> lattice = latticeOf(stage, *sampling);
    if (!lattice) {
        return tl::unexpected(lattice.error());
    }
    const Json& pixel = row->at("worst_pixel").at("pixel");
    const RayTrace trace =
        traceAt(stage, *lattice,
                {static_cast<int>(pixel.at(0).whole()), static_cast<int>(pixel.at(1).whole())});
    const Json summary = summaryOf(*row, trace, stage.desc().size);
    const Json layers = layersOf(trace);
    Json whole = summary;
    whole["layers"] = layers;
    return folder.write(kJsonFile, whole.dump(1) + "\n")
        .and_then([&] { return folder.write(kCsvFile, csvOf(layers, kColumns)); })
        .map([&] { return summary; });
}

} // namespace slabcast
