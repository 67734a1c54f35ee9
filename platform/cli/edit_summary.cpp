#include "platform/cli/edit_summary.h"
#include "perf/frame_times.h"
#include "perf/report_json.h"

#include <algorithm>
#include <map>

namespace slabcast {

using nlohmann::json;

namespace {

constexpr double kBudgetOverOctree = 1.5;

/// A number of every row that `has` one.
template <class Number, class Has>
std::vector<double> numbersOf(const std::vector<EditRow>& rows, Number number, Has has) {
    std::vector<double> numbers;
    for (const EditRow& row : rows) {
        if (has(row)) {
            numbers.push_back(number(row));
        }
    }
    return numbers;
}

template <class Number>
std::vector<double> numbersOf(const std::vector<EditRow>& rows, Number number) {
    return numbersOf(rows, number, [](const EditRow&) { return true; });
}

std::int64_t over(const std::vector<double>& ms, double budgetMs) {
    return std::count_if(ms.begin(), ms.end(), [=](double one) { return one > budgetMs; });
}

/// From each edit to the first frame that equals one from scratch, that frame counted; of the
/// edit that took most. null without edits, and where one saw no such frame before the next.
json framesToCorrect(const std::vector<EditRow>& rows) {
    std::ptrdiff_t most = 0;
    for (auto edit = rows.begin(); edit != rows.end(); ++edit) {
        if (!edit->edited) {
            continue;
        }
        const auto next =
            std::find_if(edit + 1, rows.end(), [](const EditRow& row) { return row.edited; });
        const auto correct =
            std::find_if(edit, next, [](const EditRow& row) { return row.equal.value_or(false); });
        if (correct == next) {
            return {};
        }
        most = std::max(most, correct - edit + 1);
    }
    return most > 0 ? json(most) : json();
}

} // namespace

std::vector<EditRow> mediansOf(const std::vector<std::vector<EditRow>>& replays) {
    std::vector<EditRow> rows = replays.front();
    for (std::size_t k = 0; k < rows.size(); ++k) {
        for (double EditRow::*time :
             {&EditRow::frameMs, &EditRow::editMs, &EditRow::workMs, &EditRow::prepareMs,
              &EditRow::drawMs, &EditRow::octreeMs, &EditRow::octreeWorstMs, &EditRow::naiveMs}) {
            std::vector<double> times;
            for (const std::vector<EditRow>& replay : replays) {
                times.push_back(replay[k].*time);
            }
            rows[k].*time = summarise(std::move(times)).median;
        }
        for (const std::vector<EditRow>& replay : replays) {
            if (!replay[k].equal.value_or(true)) {
                rows[k].equal = false;
            }
        }
    }
    return rows;
}

double worstOverOctree(const std::vector<std::vector<EditRow>>& replays) {
    double worst = 0.0;
    for (const std::vector<EditRow>& replay : replays) {
        for (const EditRow& row : replay) {
            worst = std::max(worst, row.frameMs / row.octreeMs);
        }
    }
    return worst;
}

json toJson(const EditRow& row, std::size_t index) {
    json result = {{"frame", index},
                   {"step", row.step},
                   {"edit", row.edited},
                   {"progress", name(row.progress)},
                   {"structure", row.structure},
                   {"frameMs", row.frameMs},
                   {"parts",
                    {{"editMs", row.editMs},
                     {"workMs", row.workMs},
                     {"prepareMs", row.prepareMs},
                     {"drawMs", row.drawMs}}},
                   {"octreeMs", row.octreeMs},
                   {"octreeWorstMs", row.octreeWorstMs},
                   {"overOctree", row.frameMs / row.octreeMs},
                   {"naiveMs", row.naiveMs},
                   {"counters", toJson(row.counters)}};
    if (row.equal) {
        result["equal"] = *row.equal;
    }
    return result;
}

json summaryOf(const std::vector<EditRow>& rows, const EditOptions& options) {
    const auto isEdit = [](const EditRow& row) { return row.edited; };
    const auto frameMs = [](const EditRow& row) { return row.frameMs; };
    const auto naiveMs = [](const EditRow& row) { return row.naiveMs; };
    const auto octreeMs = [](const EditRow& row) { return row.octreeMs; };
    const FrameTimes ratios =
        summarise(numbersOf(rows, [](const EditRow& row) { return row.frameMs / row.octreeMs; }));
    const FrameTimes naiveRatios =
        summarise(numbersOf(rows, [](const EditRow& row) { return row.naiveMs / row.octreeMs; }));
    // What the policy adds, apart from how long frames take on their own; and how far those vary.
    const FrameTimes added = summarise(numbersOf(rows, [](const EditRow& row) {
        return 1.0 + (row.editMs + row.workMs + row.prepareMs) / row.octreeMs;
    }));
    const FrameTimes spread = summarise(
        numbersOf(rows, [](const EditRow& row) { return row.octreeWorstMs / row.octreeMs; }));
    const FrameTimes octree = summarise(numbersOf(rows, octreeMs));
    const double budget = options.budgetMs.value_or(kBudgetOverOctree * octree.median);
    std::map<std::string, int> structures;
    for (const EditRow& row : rows) {
        ++structures[row.structure];
    }
    json summary = {{"worst_over_octree_frame", ratios.max},
                    {"over_octree_frame", toJson(ratios)},
                    {"worst_added_over_octree_frame", added.max},
                    {"worst_octree_frame_over_median", spread.max},
                    {"frames_over_1.5_octree_frames",
                     std::count_if(rows.begin(), rows.end(),
                                   [](const EditRow& row) {
                                       return row.frameMs > kBudgetOverOctree * row.octreeMs;
                                   })},
                    {"frames", rows.size()},
                    {"edits", std::count_if(rows.begin(), rows.end(), isEdit)},
                    {"budget_ms", budget},
                    {"budget_given", options.budgetMs.has_value()},
                    {"frames_over_budget", over(numbersOf(rows, frameMs), budget)},
                    {"frame_ms", toJson(summarise(numbersOf(rows, frameMs)))},
                    {"edit_frame_ms", toJson(summarise(numbersOf(rows, frameMs, isEdit)))},
                    {"edit_ms", toJson(summarise(numbersOf(
                                    rows, [](const EditRow& row) { return row.editMs; }, isEdit)))},
                    {"octree_frame_ms", toJson(octree)},
                    {"naive",
                     {{"frame_ms", toJson(summarise(numbersOf(rows, naiveMs)))},
                      {"edit_frame_ms", toJson(summarise(numbersOf(rows, naiveMs, isEdit)))},
                      {"worst_over_octree_frame", naiveRatios.max},
                      {"frames_over_budget", over(numbersOf(rows, naiveMs), budget)}}},
                    {"frames_by_structure", structures},
                    {"hand_overs", std::count_if(rows.begin(), rows.end(), [](const EditRow& row) {
                         return row.progress == LiveProgress::Swapped;
                     })}};
    if (options.verify) {
        summary["frames_equal"] = std::count_if(
            rows.begin(), rows.end(), [](const EditRow& row) { return row.equal.value_or(false); });
        summary["frames_to_correct"] = framesToCorrect(rows);
    }
    return summary;
}

} // namespace slabcast
