#include "perf/skip/frames.h"

#include <limits>

#include "perf/skip/race.h"
#include "perf/skip/row_json.h"

namespace slabcast::skipbench {

namespace {

constexpr double kRaceMs = 30e3;
constexpr double kQuickRaceMs = 6e3;
constexpr SkipOptions kNone{.structure = SkipStructure::None};
constexpr int kHybridLayers[] = {8, 16, 32, 64};

/// A subject with planes of the one kind or the other.
struct Seat {
    const Subject* subject;
    bool tighten;
    bool skips = true; // else the structure makes rectangles of planes and does no more

    const SkipOptions& options() const { return skips ? subject->options : kNone; }
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

/// The same lattice, target and classification for all that is compared; planes of the whole
/// sphere, unless changed, so that structures differ in nothing but what they skip.
Settings settingsOf(const Desc& desc, const Mode& mode) {
    Settings settings = desc.stage.settings;
    settings.shaded = mode.shaded;
    settings.tighten = false;
    if (!mode.terminates) {
        settings.termination.reset();
    }
    return settings;
}

Row rowOf(const Bench& bench, Table table, const char* family, const Mode& mode,
          const SkipOptions& options = kNone) {
    Row row = bench.row(table, options);
    row.family = family;
    row.mode = mode.name;
    return row;
}

double raceMs(const Bench& bench) {
    return bench.desc.quick ? kQuickRaceMs : kRaceMs;
}

Result<Entrant> ofRays(const Bench& bench, const Subject& subject, const Mode& mode, Row row) {
    row.options = subject.options;
    return entrantOf(bench.stage, subject.scene, rayCasting(bench.desc, mode), std::move(row));
}

Result<void> castRays(Bench& bench, const BestSubjects& subjects) {
    for (const Mode& mode : {kMarchingOnly, kEarlyExit, kShading}) {
        bench.show(std::string("ray casting, ") + mode.name);
        Result<std::vector<Row>> rows =
            raceRays(bench, subjects.of(mode), mode, rowOf(bench, Table::Frames, kRayCasting, mode),
                     bench.desc.frames, raceMs(bench));
        if (!rows) {
            return tl::unexpected(rows.error());
        }
        bench.add(std::move(*rows));
    }
    return {};
}

/// What a seat enters a race as.
struct Ticket {
    Table table;
    const char* family;
    Mode mode;
};

Result<Entrant> seated(const Bench& bench, const Seat& seat, int layers, const Ticket& ticket) {
    Settings settings = settingsOf(bench.desc, ticket.mode);
    settings.layersPerPlane = layers;
    settings.tighten = seat.tighten;
    if (!seat.skips) {
        settings.skip = SkipStructure::None;
    }
    return entrantOf(bench.stage, seat.subject->scene, settings,
                     rowOf(bench, ticket.table, ticket.family, ticket.mode, seat.options()));
}

/// A race of all seats, each with the layers per plane that `layersOf` gives it.
template <class LayersOf>
Result<void> raceSeats(Bench& bench, const std::vector<Seat>& seats, const char* family,
                       const Mode& mode, LayersOf layersOf) {
    const Ticket ticket{Table::Frames, family, mode};
    return entrantsOf(seats,
                      [&](const Seat& seat) {
                          return layersOf(seat).and_then(
                              [&](int layers) { return seated(bench, seat, layers, ticket); });
                      })
        .and_then([&](const std::vector<Entrant>& entrants) {
            return race(bench, entrants, bench.desc.frames, raceMs(bench));
        })
        .map([&](std::vector<Row> rows) { bench.add(std::move(rows)); });
}

Result<void> slice(Bench& bench, std::span<const Subject> subjects) {
    bench.show("slicing");
    // A quick run leaves out what never pays: a fetch per layer to save no more than a layer.
    return raceSeats(bench, seatsOf(subjects, bench.desc.quick), kSlicing, kMarchingOnly,
                     [](const Seat&) -> Result<int> { return 1; });
}

/// Layers per plane that are fastest on the picture as it is, by the least of a few frames.
Result<int> bestLayers(Bench& bench, const Seat& seat, const Mode& mode) {
    const int total = totalLayers(settingsOf(bench.desc, mode), seat.subject->scene.facts());
    int best = 0;
    double bestMs = std::numeric_limits<double>::infinity();
    for (const int layers : kHybridLayers) {
        if (layers >= total && best > 0) {
            break; // that is ray casting
        }
        Result<Entrant> entrant = seated(bench, seat, layers, {Table::Ratios, kHybrid, mode});
        if (!entrant) {
            return tl::unexpected(entrant.error());
        }
        const Result<double> ms =
            bench.timed(idOf(entrant->row), [&] { return leastMs(bench.stage, *entrant); });
        if (!ms) {
            return tl::unexpected(ms.error());
        }
        entrant->row.leastMs = *ms;
        bench.rows.push_back(std::move(entrant->row));
        if (*ms < bestMs) {
            best = layers;
            bestMs = *ms;
        }
    }
    return best;
}

Result<void> castSegments(Bench& bench, const BestSubjects& subjects) {
    const glm::ivec2 size = bench.desc.stage.size;
    for (const Mode& mode : {kMarchingOnly, kEarlyExit}) {
        const auto searched = [&](const Seat& seat) {
            bench.show(std::string("hybrid, ") + mode.name + ", " + name(seat.options().structure));
            bench.stage.resize(smaller(size));
            Result<int> layers = bestLayers(bench, seat, mode);
            bench.stage.resize(size);
            return layers;
        };
        if (Result<void> done =
                raceSeats(bench, seatsOf(subjects.of(mode)), kHybrid, mode, searched);
            !done) {
            return done;
        }
    }
    return {};
}

/// Work of one frame with parameters that are equal for all: counted, not timed.
Result<void> countWork(Bench& bench) {
    const Result<std::vector<Subject>> subjects =
        subjectsOf(bench.stage, usualStructures(bench.desc));
    if (!subjects) {
        return tl::unexpected(subjects.error());
    }
    for (const Subject& subject : *subjects) {
        Result<Entrant> entrant = ofRays(bench, subject, kMarchingOnly,
                                         rowOf(bench, Table::Work, kRayCasting, kMarchingOnly));
        if (!entrant) {
            return tl::unexpected(entrant.error());
        }
        Row& row = entrant->row;
        bench.stage.show(subject.scene);
        if (Result<void> ready = bench.stage.prepare(*row.plan); !ready) {
            return ready;
        }
        row.counters = bench.stage.countWork(*row.plan);
        bench.rows.push_back(std::move(row));
    }
    return {};
}

} // namespace

glm::ivec2 smaller(glm::ivec2 size) {
    return glm::max(size / 2, glm::ivec2(1));
}

Settings rayCasting(const Desc& desc, const Mode& mode) {
    Settings settings = settingsOf(desc, mode);
    settings.planes = 1;
    return settings;
}

Result<std::vector<Row>> raceRays(Bench& bench, std::span<const Subject> subjects, const Mode& mode,
                                  const Row& beginning, int rounds, double budgetMs) {
    return entrantsOf(
               subjects,
               [&](const Subject& subject) { return ofRays(bench, subject, mode, beginning); })
        .and_then([&](const std::vector<Entrant>& entrants) {
            return race(bench, entrants, rounds, budgetMs);
        });
}

Result<void> measureFrames(Bench& bench, const BestSubjects& subjects) {
    return castRays(bench, subjects)
        .and_then([&] { return castSegments(bench, subjects); })
        .and_then([&] { return slice(bench, subjects.of(kMarchingOnly)); })
        .and_then([&] { return countWork(bench); });
}

} // namespace slabcast::skipbench
