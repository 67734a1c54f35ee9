#include "perf/error/error_grid.h"

#include <algorithm>
#include <cmath>

#include "perf/number.h"

namespace slabcast {

namespace {

constexpr const char* kParts[] = {"total", "sampling", "table", "gpu"};
constexpr double kFloor = 1e-9;
constexpr int kEnough = 15; // digits that tell two settings apart
/// Ray casting: where leaving a ray early shows most, and what is drawn in the least time.
constexpr int kVariedLayersPerPlane = 0;

template <class T>
void fill(std::vector<T>& axis, std::vector<T> defaults) {
    if (axis.empty()) {
        axis = std::move(defaults);
    }
}

/// Rows of one family differ in spacing alone.
Json familyOf(const Json& row) {
    Json family;
    for (const char* key : {"layers_per_plane", "classify", "target", "termination", "jitter"}) {
        family[key] = row.at(key);
    }
    return family;
}

std::optional<double> rmseOf(const Json& row, const char* part) {
    const Json& error = row.at("error").at(part);
    return error.isNull() ? std::nullopt : std::optional(error.at("rmse").number());
}

/// Where sampling is most of the total, the total is not yet at what table and GPU leave.
bool atFloor(const Json& row, const char* part) {
    const std::optional<double> rmse = rmseOf(row, part);
    if (!rmse || *rmse < kFloor) {
        return true;
    }
    const std::optional<double> sampling = rmseOf(row, "sampling");
    return std::string_view(part) == "total" && (!sampling || *sampling < 0.5 * *rmse);
}

Json orderOf(const Json& coarse, const Json& fine, const char* part) {
    if (atFloor(coarse, part) || atFloor(fine, part)) {
        return nullptr;
    }
    return std::log(*rmseOf(coarse, part) / *rmseOf(fine, part)) /
           std::log(coarse.at("layer_spacing").number() / fine.at("layer_spacing").number());
}

/// The row of the same family with the next larger spacing.
const Json* nextCoarser(const Json& rows, const Json& row) {
    const Json* found = nullptr;
    for (const Json& other : rows) {
        const bool coarser = other.at("layer_spacing").number() > row.at("layer_spacing").number();
        if (coarser && familyOf(other) == familyOf(row) &&
            (found == nullptr ||
             other.at("layer_spacing").number() < found->at("layer_spacing").number())) {
            found = &other;
        }
    }
    return found;
}

} // namespace

GridAxes completed(GridAxes given, bool quick) {
    fill(given.spacings,
         quick ? std::vector{2.0, 1.0, 0.5, 0.25} : std::vector{4.0, 2.0, 1.0, 0.5, 0.25, 0.125});
    std::sort(given.spacings.rbegin(), given.spacings.rend());
    fill(given.layersPerPlane, {0, 1, 8, 16, 64});
    // A length that holds all layers is ray casting too: of equal plans the first is measured.
    std::stable_partition(given.layersPerPlane.begin(), given.layersPerPlane.end(),
                          [](int layers) { return layers == 0; });
    fill(given.classifications,
         {Classification::Post, Classification::Pre, Classification::Preintegrated});
    fill(given.targets, {TargetFormat::Rgba8, TargetFormat::Rgba16f});
    fill(given.terminations, {Settings{}.termination, std::nullopt});
    fill(given.jitter, {false, true});
    return given;
}

std::vector<Sampling> gridOf(const GridAxes& axes, bool quick) {
    const auto& lengths = axes.layersPerPlane;
    const bool listed =
        std::find(lengths.begin(), lengths.end(), kVariedLayersPerPlane) != lengths.end();
    const int varied = listed ? kVariedLayersPerPlane : lengths.back();
    std::vector<Sampling> grid;
    const auto add = [&](const Sampling& s) {
        const int variations =
            (s.jitter != axes.jitter.front()) + (s.termination != axes.terminations.front());
        if (!quick || variations == 0 || (variations == 1 && s.layersPerPlane == varied)) {
            grid.push_back(s);
        }
    };
    for (const Classification classification : axes.classifications) {
        for (const bool jitter : axes.jitter) {
            for (const double spacing : axes.spacings) {
                for (const int layers : axes.layersPerPlane) {
                    for (const TargetFormat target : axes.targets) {
                        for (const auto& termination : axes.terminations) {
                            add({spacing, layers, classification, target, termination, jitter});
                        }
                    }
                }
            }
        }
    }
    return grid;
}

std::string idOf(const Sampling& s) {
    const std::string termination = s.termination ? number(*s.termination, kEnough) : "off";
    return std::string(name(s.classification)) + "_" + name(s.target) + "_s" +
           number(s.layerSpacingVoxels, kEnough) + "_l" + std::to_string(s.layersPerPlane) + "_t" +
           termination + (s.jitter ? "_jitter" : "");
}

Json toJson(const std::optional<double>& termination) {
    return termination ? Json(*termination) : Json("off");
}

Json toJson(const GridAxes& axes) {
    const auto list = [](const auto& values, auto&& convert) {
        Json all = Json::list();
        for (const auto& value : values) {
            all.push_back(convert(value));
        }
        return all;
    };
    const auto named = [](auto value) { return name(value); };
    return {{"layer_spacing", Json::listOf(axes.spacings)},
            {"layers_per_plane", Json::listOf(axes.layersPerPlane)},
            {"classify", list(axes.classifications, named)},
            {"target", list(axes.targets, named)},
            {"termination",
             list(axes.terminations, [](const std::optional<double>& t) { return toJson(t); })},
            {"jitter", Json::listOf(axes.jitter)}};
}

Json toJson(const Sampling& s) {
    return {{"layer_spacing", s.layerSpacingVoxels}, {"layers_per_plane", s.layersPerPlane},
            {"classify", name(s.classification)},    {"target", name(s.target)},
            {"termination", toJson(s.termination)},  {"jitter", s.jitter}};
}

void addOrders(Json& rows) {
    for (Json& row : rows) {
        const Json* coarser = nextCoarser(rows, row);
        Json order;
        for (const char* part : kParts) {
            order[part] = coarser == nullptr ? Json() : orderOf(*coarser, row, part);
        }
        row["order"] = std::move(order);
        row["coarser"] = coarser == nullptr ? Json() : coarser->at("id");
    }
}

std::vector<std::size_t> frontOf(const Json& rows, std::optional<double> (*cost)(const Json&)) {
    std::vector<std::pair<std::pair<double, double>, std::size_t>> ranked;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        if (const std::optional<double> c = cost(rows.at(i))) {
            ranked.push_back({{*c, totalRmse(rows.at(i))}, i});
        }
    }
    std::sort(ranked.begin(), ranked.end());
    std::vector<std::size_t> front;
    for (const auto& [rank, index] : ranked) {
        if (front.empty() || rank.second < totalRmse(rows.at(front.back()))) {
            front.push_back(index);
        }
    }
    return front;
}

double totalRmse(const Json& row) {
    return row.at("error").at("total").at("rmse").number();
}

} // namespace slabcast
