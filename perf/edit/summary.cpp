#include "perf/edit/summary.h"

#include <algorithm>

namespace slabcast {

namespace {

using Number = double (*)(const EditRow&);

bool isAny(const EditRow&) {
    return true;
}
bool isEdit(const EditRow& row) {
    return row.edited;
}

double frameMs(const EditRow& row) {
    return row.frameMs;
}
double naiveMs(const EditRow& row) {
    return row.naiveMs;
}
double overOctree(const EditRow& row) {
    return row.frameMs / row.octreeMs;
}

/// A number of every row that counts.
std::vector<double> numbersOf(const std::vector<EditRow>& rows, Number number,
                              bool (*counts)(const EditRow&) = isAny) {
    std::vector<double> numbers;
    for (const EditRow& row : rows) {
        if (counts(row)) {
            numbers.push_back(number(row));
        }
    }
    return numbers;
}

FrameTimes timesOf(const std::vector<EditRow>& rows, Number number,
                   bool (*counts)(const EditRow&) = isAny) {
    return summarise(numbersOf(rows, number, counts));
}

double worstOf(const std::vector<EditRow>& rows, Number number) {
    return timesOf(rows, number).max;
}

template <class Holds>
int countOf(const std::vector<EditRow>& rows, Holds holds) {
    return static_cast<int>(std::count_if(rows.begin(), rows.end(), holds));
}

std::optional<int> framesToCorrect(const std::vector<EditRow>& rows) {
    std::ptrdiff_t most = 0;
    for (auto edit = rows.begin(); edit != rows.end(); ++edit) {
        if (!edit->edited) {
            continue;
        }
        const auto next = std::find_if(edit + 1, rows.end(), isEdit);
        const auto correct =
            std::find_if(edit, next, [](const EditRow& row) { return row.equal.value_or(false); });
        if (correct == next) {
            return std::nullopt;
        }
        most = std::max(most, correct - edit + 1);
    }
    return most > 0 ? std::optional(static_cast<int>(most)) : std::nullopt;
}

} // namespace

std::vector<EditRow> mediansOf(const EditReplays& replays) {
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

double worstOverOctree(const EditReplays& replays) {
    double worst = 0.0;
    for (const std::vector<EditRow>& replay : replays) {
        worst = std::max(worst, worstOf(replay, overOctree));
    }
    return worst;
}

double budgetOf(const EditRow& row, std::optional<double> givenMs) {
    return givenMs.value_or(kBudgetOverOctree * row.octreeMs);
}

EditSummary summaryOf(const std::vector<EditRow>& rows, std::optional<double> givenMs) {
    EditSummary s{.frames = static_cast<int>(rows.size()), .edits = countOf(rows, isEdit)};
    s.frameMs = timesOf(rows, frameMs);
    s.octreeMs = timesOf(rows, [](const EditRow& row) { return row.octreeMs; });
    s.naiveMs = timesOf(rows, naiveMs);
    s.editFrameMs = timesOf(rows, frameMs, isEdit);
    s.editMs = timesOf(
        rows, [](const EditRow& row) { return row.editMs; }, isEdit);
    s.naiveEditFrameMs = timesOf(rows, naiveMs, isEdit);
    s.overOctree = timesOf(rows, overOctree);
    // What the policy adds, apart from how long frames take on their own; and how far those vary.
    s.worstAdded = worstOf(rows, [](const EditRow& row) {
        return 1.0 + (row.editMs + row.workMs + row.prepareMs) / row.octreeMs;
    });
    s.worstOctreeSpread =
        worstOf(rows, [](const EditRow& row) { return row.octreeWorstMs / row.octreeMs; });
    s.worstNaive = worstOf(rows, [](const EditRow& row) { return row.naiveMs / row.octreeMs; });
    s.framesOverBudget =
        countOf(rows, [&](const EditRow& row) { return row.frameMs > budgetOf(row, givenMs); });
    s.naiveFramesOverBudget =
        countOf(rows, [&](const EditRow& row) { return row.naiveMs > budgetOf(row, givenMs); });
    for (const EditRow& row : rows) {
        ++s.framesByStructure[row.structure];
    }
    s.handOvers =
        countOf(rows, [](const EditRow& row) { return row.progress == LiveProgress::Swapped; });
    s.framesEqual = countOf(rows, [](const EditRow& row) { return row.equal.value_or(false); });
    s.framesToCorrect = framesToCorrect(rows);
    return s;
}

} // namespace slabcast
