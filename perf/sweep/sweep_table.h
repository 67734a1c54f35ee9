#pragma once

#include <span>
#include <vector>

#include "perf/json.h"
#include "perf/race.h"

namespace slabcast {

/// Where a row stands in a sweep.
struct SweepPlace {
    int series = 0; // the plain stack's first
    int layersPerPlane = 0;
};

/// Adds to every row its times and how many times as fast as others it is, paired within rounds:
/// over slicing of its own series, over its own ratio drawn plainly, and over plain slicing; null
/// where there is no such row. Pure. Contract: a place and as many laps for each row.
/// Tested by: sweep_table_test.cpp
void addTimes(Json& rows, std::span<const SweepPlace> places, const Laps& laps);

/// Of sweep.csv.
std::string sweepCsv(const Json& rows);

} // namespace slabcast
