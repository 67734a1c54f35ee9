#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/draw/renderer.h"
#include "core/plan/frame_plan.h"
#include "core/skip/skip_structure.h"
#include "core/volume/texels.h"
#include "perf/paired_ratio.h"
#include "perf/volume_info.h"

namespace slabcast::skipbench {

/// The tables that a report's rows are of; docs/reports.md says what a row of each is.
enum class Table : std::uint8_t {
    Search,
    Finals,
    Frames,
    Ratios,
    Work,
    Structures,
    Partitions,
    Rebuild,
    Merge,
    Sizes,
};

/// What a row's frames do, as in Faludi et al. 2021, table 1: each adds to the one before.
struct Mode {
    const char* name;
    bool terminates;
    bool shaded;
};
inline constexpr Mode kMarchingOnly{"marching only", false, false};
inline constexpr Mode kEarlyExit{"early exit", true, false};
inline constexpr Mode kShading{"shading", true, true};

inline constexpr const char* kRayCasting = "ray casting"; // families of frames
inline constexpr const char* kHybrid = "hybrid";
inline constexpr const char* kSlicing = "slicing";

/// The volume resampled to a cube.
struct Cube {
    int edge = 0;
    std::int64_t volumeBytes = 0;
    double codesMs = 0.0;
};

/// One entrant's part of a race.
struct Raced {
    std::vector<double> samples; // ms, one of each round
    PairedRatio speedup{};       // times as fast as the first entrant
};

struct Memory {
    std::int64_t gpuBytes = 0;
    std::int64_t hostBytes = 0;
};

/// What a structure takes; of `refused` ones, the reason.
struct Build {
    std::vector<double> ms, updateMs, gpuMs;
    std::string refused, gpuRefused;
    Memory memory;
    double occupiedFraction = 1.0;
};

/// What partitioned maps take once; of those that are over their budget, the reason.
struct Partitions {
    double initMs = 0.0;
    Memory memory;
    std::string refused;
};

/// A transfer function that structures are brought up to date with.
struct Transfer {
    const char* key = ""; // as in Rauter et al. 2024, figure 3
    std::string name;
};

/// A distance map made again, from codes and from kept ranges of blocks: a time of each round, ms.
struct Rebuild {
    std::vector<double> ms, ofRangesMs;
};

/// Partitioned maps merged again; how many times as fast as either way to rebuild a Chebyshev map.
struct Merge {
    std::vector<double> ms;
    PairedRatio speedup{};
    PairedRatio speedupOfRanges{};
};

/// A row of any table. What its table does not have is not there.
struct Row {
    Table table = Table::Frames;
    std::string volume;
    SkipOptions options{.structure = SkipStructure::None};
    const char* family = nullptr;
    const char* mode = nullptr;
    std::optional<SkipStructure> finalsOf{};
    std::optional<Cube> cube{};
    std::optional<FramePlan> plan{};
    std::optional<double> leastMs{}; // of a few frames
    std::optional<Raced> raced{};
    std::optional<Result<WorkCounters>> counters{};
    std::optional<Build> build{};
    std::optional<Partitions> partitions{};
    std::optional<Transfer> transfer{};
    std::optional<Rebuild> rebuild{};
    std::optional<Merge> merge{};
};

/// Scenes that goals were set for: the project's own.
enum class OwnScene : std::uint8_t { None, Phantom, Skull };

/// A volume that rows are of.
struct VolumeRecord {
    std::string name;  // as rows have it
    std::string input; // as it was asked for
    VolumeInfo info{};
    std::string transferFunction{};
    TexelFormat texelFormat = TexelFormat::R8;
    std::int64_t texelBytes = 0;
    double codesMs = 0.0; // of the codes that all builds share
    OwnScene own = OwnScene::None;
};

} // namespace slabcast::skipbench
