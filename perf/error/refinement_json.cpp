#include "perf/csv.h"
#include "perf/error/refinement.h"
#include "perf/error/refinement_scene.h"

namespace slabcast {

namespace {

constexpr CsvColumn kColumns[] = {{"kind", "/kind"},
                                  {"method", "/method"},
                                  {"control", "/control"},
                                  {"size", "/level/size"},
                                  {"unit", "/unit"},
                                  {"rmse", "/level/rmse"},
                                  {"change", "/level/change"},
                                  {"order", "/level/order"},
                                  {"self_order", "/level/self_order"},
                                  {"expected_order", "/expected_order"},
                                  {"right_order", "/right_order"},
                                  {"asymptotic", "/asymptotic"},
                                  {"as_expected", "/as_expected"},
                                  {"looks_right", "/looks_right"}};

Json toJson(const RefinementStudy& study) {
    Json all = toJson(study.levels, study.convergence);
    all.update({{"kind", study.kind},
                {"method", study.method},
                {"unit", study.unit},
                {"control", study.control},
                {"expected_order", study.expectedOrder},
                {"why_expected", study.whyExpected},
                {"right_order", study.rightOrder},
                {"floor", study.floor},
                {"as_expected", study.asExpected()},
                {"looks_right", study.looksRight()}});
    return all;
}

} // namespace

Json toJson(const std::vector<RefinementStudy>& studies) {
    Json all = Json::list();
    for (const RefinementStudy& study : studies) {
        all.push_back(toJson(study));
    }
    return {{"field", "Marschner-Lobb, one wave, 0.25, in a cube"},
            {"cube_mm", kCubeMm},
            {"order_tolerance", kOrderTolerance},
            {"stable_orders", kStableOrders},
            {"studies", std::move(all)}};
}

std::string refinementCsv(const std::vector<RefinementStudy>& studies) {
    Json rows = Json::list();
    for (const RefinementStudy& study : studies) {
        const Json whole = toJson(study);
        for (const Json& level : whole.at("levels")) {
            Json row = whole;
            row["level"] = level;
            rows.push_back(std::move(row));
        }
    }
    return csvOf(rows, kColumns);
}

} // namespace slabcast
