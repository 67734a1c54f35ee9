#include "platform/cli/skipbench_frames.h"

#include <algorithm>
#include <limits>
#include <optional>

#include <fmt/core.h>

#include "platform/cli/skipbench_race.h"

namespace slabcast {

namespace {

using nlohmann::json;

constexpr double kRaceMs = 30e3;
constexpr double kQuickRaceMs = 6e3;
const SkipOptions kNone{.structure = SkipStructure::None};
constexpr int kHybridLayers[] = {8, 16, 32, 64};

/// A subject with planes of the one kind or the other.
struct Seat {
    const Subject* subject;
    bool tighten;
    bool skips = true; // else the structure makes rectangles of planes and does no more
};

/// The first is none with planes of the sphere, which the race's speed-ups are against. Rectangles
/// come from a structure: none has them from blocks, as it is drawn unless told otherwise.
std::vector<Seat> seatsOf(std::span<const Subject> subjects, bool onlyRectangles = false) {
    std::vector<Seat> seats;
    for (const Subject& subject : subjects) {
        const SkipStructure structure = subject.options.structure;
        if (structure == SkipStructure::None || !onlyRectangles) {
            seats.push_back({&subject, false});
        }
        if (structure != SkipStructure::None) {
            seats.push_back({&subject, true});
        }
        if (structure == SkipStructure::Blocks) {
            seats.push_back({&subject, true, false});
        }
    }
    return seats;
}

json rowOf(const SkipBench& bench, const char* table, const char* family, const BenchMode& mode) {
    json row = bench.row(table);
    row.update({{"family", family}, {"mode", mode.name}});
    return row;
}

double raceMs(const SkipBench& bench) {
    return bench.options.quick ? kQuickRaceMs : kRaceMs;
}

void add(SkipBench& bench, const json& rows) {
    bench.rows.insert(bench.rows.end(), rows.begin(), rows.end());
}

Result<Entrant> ofRays(const SkipBench& bench, const Subject& subject, const BenchMode& mode,
                       json row) {
    row.update(toJson(subject.options));
    return entrantOf(bench.stage, subject.scene, rayCasting(bench.options, mode), std::move(row));
}

Result<void> castRays(SkipBench& bench, const BestSubjects& subjects) {
    for (const BenchMode& mode : {kMarchingOnly, kEarlyExit, kShading}) {
        bench.progress.show(fmt::format("{}: ray casting, {}", bench.volume, mode.name));
        const Result<json> rows =
            raceRays(bench, subjects.of(mode), mode, rowOf(bench, "frames", "ray casting", mode),
                     bench.options.frames, raceMs(bench));
        if (!rows) {
            return tl::unexpected(rows.error());
        }
        add(bench, *rows);
    }
    return {};
}

Result<Entrant> seated(const SkipBench& bench, const Seat& seat, int layers, const BenchMode& mode,
                       const char* table, const char* family) {
    Settings settings = settingsOf(bench.options, mode);
    settings.layersPerPlane = layers;
    settings.tighten = seat.tighten;
    json row = rowOf(bench, table, family, mode);
    row.update(toJson(seat.skips ? seat.subject->options : kNone));
    if (!seat.skips) {
        settings.skip = SkipStructure::None;
    }
    return entrantOf(bench.stage, seat.subject->scene, settings, std::move(row));
}

/// A race of all seats, each with the layers per plane that `layersOf` gives it.
template <class LayersOf>
Result<void> raceSeats(SkipBench& bench, const std::vector<Seat>& seats, const BenchMode& mode,
                       const char* family, LayersOf layersOf) {
    return entrantsOf(seats,
                      [&](const Seat& seat) {
                          return layersOf(seat).and_then([&](int layers) {
                              return seated(bench, seat, layers, mode, "frames", family);
                          });
                      })
        .and_then([&](const std::vector<Entrant>& entrants) {
            return race(bench.stage, entrants, bench.options.frames, raceMs(bench));
        })
        .map([&](const json& rows) { add(bench, rows); });
}

Result<void> slice(SkipBench& bench, std::span<const Subject> subjects) {
    bench.progress.show(bench.volume + ": slicing");
    // A quick run leaves out what never pays: a fetch per layer to save no more than a layer.
    return raceSeats(bench, seatsOf(subjects, bench.options.quick), kMarchingOnly, "slicing",
                     [](const Seat&) -> Result<int> { return 1; });
}

/// Layers per plane that are fastest on the picture as it is, by the least of a few frames.
Result<int> bestLayers(SkipBench& bench, const Seat& seat, const BenchMode& mode) {
    const int total = totalLayers(settingsOf(bench.options, mode), seat.subject->scene.facts());
    int best = 0;
    double bestMs = std::numeric_limits<double>::infinity();
    for (const int layers : kHybridLayers) {
        if (layers >= total && best > 0) {
            break; // that is ray casting
        }
        const Result<Entrant> entrant = seated(bench, seat, layers, mode, "ratios", "hybrid");
        if (!entrant) {
            return tl::unexpected(entrant.error());
        }
        const Result<double> ms = leastMs(bench.stage, *entrant);
        if (!ms) {
            return tl::unexpected(ms.error());
        }
        json row = entrant->row;
        row["ms"] = *ms;
        bench.rows.push_back(std::move(row));
        if (*ms < bestMs) {
            best = layers;
            bestMs = *ms;
        }
    }
    return best;
}

Result<void> castSegments(SkipBench& bench, const BestSubjects& subjects) {
    for (const BenchMode& mode : {kMarchingOnly, kEarlyExit}) {
        const auto searched = [&](const Seat& seat) {
            bench.progress.show(fmt::format(
                "{}: hybrid, {}, {}", bench.volume, mode.name,
                name(seat.skips ? seat.subject->options.structure : SkipStructure::None)));
            bench.stage.resize(smaller(bench.options.size));
            Result<int> layers = bestLayers(bench, seat, mode);
            bench.stage.resize(bench.options.size);
            return layers;
        };
        if (Result<void> done =
                raceSeats(bench, seatsOf(subjects.of(mode)), mode, "hybrid", searched);
            !done) {
            return done;
        }
    }
    return {};
}

/// Work of one frame with parameters that are equal for all: counted, not timed.
Result<void> countWork(SkipBench& bench) {
    std::vector<Refusal> refused;
    const Result<std::vector<Subject>> subjects =
        subjectsOf(bench.stage, usualStructures(bench.options), refused);
    if (!subjects) {
        return tl::unexpected(subjects.error());
    }
    for (const Subject& subject : *subjects) {
        Result<Entrant> entrant = ofRays(bench, subject, kMarchingOnly,
                                         rowOf(bench, "work", "ray casting", kMarchingOnly));
        if (!entrant) {
            return tl::unexpected(entrant.error());
        }
        bench.stage.show(subject.scene);
        if (Result<void> ready = bench.stage.prepare(entrant->plan); !ready) {
            return ready;
        }
        entrant->row["counters"] = toJson(bench.stage.countWork(entrant->plan));
        bench.rows.push_back(std::move(entrant->row));
    }
    return {};
}

} // namespace

glm::ivec2 smaller(glm::ivec2 size) {
    return glm::max(size / 2, glm::ivec2(1));
}

Settings settingsOf(const SkipbenchOptions& options, const BenchMode& mode) {
    Settings settings = options.settings;
    settings.shaded = mode.shaded;
    settings.tighten = false;
    if (!mode.terminates) {
        settings.termination.reset();
    }
    return settings;
}

Settings rayCasting(const SkipbenchOptions& options, const BenchMode& mode) {
    Settings settings = settingsOf(options, mode);
    settings.planes = 1;
    return settings;
}

Result<json> raceRays(SkipBench& bench, std::span<const Subject> subjects, const BenchMode& mode,
                      const json& row, int rounds, double budgetMs) {
    return entrantsOf(subjects,
                      [&](const Subject& subject) { return ofRays(bench, subject, mode, row); })
        .and_then([&](const std::vector<Entrant>& entrants) {
            return race(bench.stage, entrants, rounds, budgetMs);
        });
}

Result<void> measureFrames(SkipBench& bench, const BestSubjects& subjects) {
    return castRays(bench, subjects)
        .and_then([&] { return castSegments(bench, subjects); })
        .and_then([&] { return slice(bench, subjects.of(kMarchingOnly)); })
        .and_then([&] { return countWork(bench); });
}

} // namespace slabcast
