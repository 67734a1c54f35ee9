#include "perf/error/convergence.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "perf/number.h"

namespace slabcast {

namespace {

constexpr double kReferenceFloor = 1e-9; // the scene's references' own accuracy, with room

std::optional<double> orderBetween(double coarse, double fine, double ratio) {
    return coarse > 0.0 && fine > 0.0 ? std::optional(std::log(coarse / fine) / std::log(ratio))
                                      : std::nullopt;
}

std::optional<double> lastOf(const std::vector<std::optional<double>>& orders) {
    const auto found = std::find_if(orders.rbegin(), orders.rend(),
                                    [](const auto& order) { return order.has_value(); });
    return found == orders.rend() ? std::nullopt : *found;
}

/// Of the levels whose error is the method's own.
std::vector<double> knownOf(const std::vector<std::optional<double>>& orders) {
    std::vector<double> known;
    for (const std::optional<double>& order : orders) {
        if (order) {
            known.push_back(*order);
        }
    }
    return known;
}

void judge(Convergence& c, double floor) {
    const std::vector<double> known = knownOf(c.orders);
    if (known.size() < std::size_t{kStableOrders}) {
        c.why = std::to_string(known.size()) + " of the " + std::to_string(kStableOrders) +
                " refinements that are needed lie above the floor of " + number(floor, 2);
        return;
    }
    const auto [low, high] = std::minmax_element(known.end() - kStableOrders, known.end());
    const double spread = *high - *low;
    c.asymptotic = spread <= kOrderTolerance;
    c.why = "the last " + std::to_string(kStableOrders) + " orders differ by " + fixed(spread, 2) +
            (c.asymptotic ? ", within " : ", more than ") + number(kOrderTolerance, 2);
}

Json orNull(const std::optional<double>& value) {
    return value ? Json(*value) : Json();
}

/// What the sampling of a classification promises. Filtering colours is another picture than
/// classifying what was filtered: no step makes one of the other.
struct Promise {
    double order;
    const char* why;
};

Promise promiseOf(const std::string& classification, bool hasSteps) {
    if (classification == "preclassified") {
        return {0.0, "colours are filtered instead of values, at any step"};
    }
    if (classification == "preintegrated") {
        return {2.0, "the field is taken as linear between the ends of a layer"};
    }
    return hasSteps ? Promise{1.0, "a step of the transfer function lies within one layer"}
                    : Promise{2.0, "midpoints of a continuous integrand"};
}

} // namespace

Convergence convergenceOf(std::span<const RefinementLevel> levels, double floor) {
    Convergence c;
    for (std::size_t k = 0; k < levels.size(); ++k) {
        std::optional<double> order, selfOrder;
        if (k > 0) {
            const RefinementLevel &coarse = levels[k - 1], &fine = levels[k];
            const double ratio = coarse.size / fine.size;
            if (std::min(coarse.error, fine.error) > floor) {
                order = orderBetween(coarse.error, fine.error, ratio);
            }
            if (coarse.change && fine.change && std::min(*coarse.change, *fine.change) > floor) {
                selfOrder = orderBetween(*coarse.change, *fine.change, ratio);
            }
        }
        c.orders.push_back(order);
        c.selfOrders.push_back(selfOrder);
    }
    c.order = lastOf(c.orders);
    c.selfOrder = lastOf(c.selfOrders);
    judge(c, floor);
    return c;
}

bool hasOrder(const Convergence& convergence, double expected) {
    return convergence.asymptotic && std::abs(*convergence.order - expected) <= kOrderTolerance;
}

Json toJson(std::span<const RefinementLevel> levels, const Convergence& c) {
    Json all = Json::list();
    for (std::size_t k = 0; k < levels.size(); ++k) {
        all.push_back({{"size", levels[k].size},
                       {"rmse", levels[k].error},
                       {"change", orNull(levels[k].change)},
                       {"order", orNull(c.orders[k])},
                       {"self_order", orNull(c.selfOrders[k])}});
    }
    return {{"levels", std::move(all)},
            {"order", orNull(c.order)},
            {"self_order", orNull(c.selfOrder)},
            {"asymptotic", c.asymptotic},
            {"why", c.why}};
}

Json familyConvergence(const Json& rows, bool hasSteps) {
    std::map<std::pair<std::string, bool>, std::vector<RefinementLevel>> families;
    for (const Json& row : rows) {
        auto& levels = families[{row.at("classify").text(), row.at("jitter").flag()}];
        const double spacing = row.at("layer_spacing").number();
        const auto isThis = [=](const RefinementLevel& level) { return level.size == spacing; };
        // What is sampled depends neither on planes nor on target nor on termination.
        if (std::none_of(levels.begin(), levels.end(), isThis)) {
            levels.push_back({spacing, row.at("error").at("sampling").at("rmse").number()});
        }
    }
    Json all = Json::list();
    for (auto& [family, levels] : families) {
        std::sort(levels.begin(), levels.end(),
                  [](const auto& a, const auto& b) { return a.size > b.size; });
        const Convergence convergence = convergenceOf(levels, kReferenceFloor);
        const Promise promise = promiseOf(family.first, hasSteps);
        Json entry = toJson(levels, convergence);
        entry.update({{"classify", family.first},
                      {"jitter", family.second},
                      {"expected_order", promise.order},
                      {"why_expected", promise.why},
                      {"as_expected", hasOrder(convergence, promise.order)}});
        all.push_back(std::move(entry));
    }
    return all;
}

} // namespace slabcast
