#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "perf/median_interval.h"

namespace slabcast::skipbench {

struct Row;
struct VolumeRecord;

enum class Sense : std::uint8_t { AtLeast, AtMost };

/// What a goal was set for, and what was measured.
struct Figure {
    std::string key;                          // for programs
    std::string name;                         // for people
    std::string volume;                       // as rows name it
    std::optional<double> value;              // none where its rows were not measured
    std::optional<MedianInterval> interval{}; // of a value that is paired within rounds
    std::optional<double> goal;               // none where none was set for such a volume
    Sense sense = Sense::AtLeast;
    std::string from; // in words

    /// Nothing without a value or a goal.
    std::optional<bool> reached() const;
};

const char* name(Sense sense); // ">=" or "<="

/// The figures to reach, each worked out from measured rows. A goal stands only where it was set
/// for: the project's skull under bone, its gap phantom, or any of its own scenes. Contract: rows
/// of a race have as many samples as its others. Tested by: figures_test.cpp
std::vector<Figure> figuresOf(std::span<const VolumeRecord> volumes, std::span<const Row> rows);

/// How many figures have a value and a goal, and how many of these reach it.
struct Tally {
    int judged = 0;
    int reached = 0;
};
Tally tallyOf(std::span<const Figure> figures);

/// "summary: 3 of 4 figures reached", and what of the others does not hold.
std::string lineOf(std::span<const Figure> figures);

} // namespace slabcast::skipbench
