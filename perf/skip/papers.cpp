#include "perf/skip/papers.h"

#include <array>
#include <utility>

namespace slabcast::skipbench {

namespace {

/// Frame times without a structure and with each, and what the structures took to generate, ms.
struct FaludiDataset {
    const char* name;
    std::array<int, 3> dims;
    std::array<double, 5> marching, earlyExit, shading;
    std::array<double, 4> generation;
};

/// Columns: none, distance map, Boolean, min-max and bitfield octree.
constexpr FaludiDataset kFaludi[] = {{"Lungs",
                                      {512, 512, 690},
                                      {12.05, 5.98, 7.32, 15.59, 7.91},
                                      {7.83, 2.76, 4.50, 10.16, 4.75},
                                      {12.47, 7.54, 8.20, 13.41, 8.52},
                                      {59.2, 7.7, 7.1, 7.0}},
                                     {"Head MRI",
                                      {512, 640, 184},
                                      {10.90, 7.03, 9.81, 14.82, 11.28},
                                      {5.41, 1.51, 2.33, 3.11, 2.56},
                                      {7.66, 3.89, 4.37, 4.83, 4.59},
                                      {39.6, 9.4, 7.9, 5.3}},
                                     {"Aneurysm",
                                      {256, 256, 256},
                                      {6.41, 0.94, 2.46, 2.47, 2.46},
                                      {6.32, 0.82, 2.22, 2.24, 2.24},
                                      {6.78, 1.18, 2.33, 2.34, 2.35},
                                      {14.0, 5.2, 5.2, 5.2}},
                                     {"Manix",
                                      {512, 446, 459},
                                      {9.17, 2.59, 4.27, 4.39, 4.35},
                                      {6.48, 0.92, 1.72, 1.74, 1.74},
                                      {7.81, 2.27, 2.59, 2.67, 2.63},
                                      {54.6, 4.2, 3.5, 4.4}},
                                     {"Beetle",
                                      {832, 832, 494},
                                      {19.31, 2.07, 2.82, 2.87, 2.85},
                                      {17.20, 0.69, 1.28, 1.30, 1.29},
                                      {18.58, 1.29, 1.63, 1.65, 1.64},
                                      {118.2, 12.0, 12.1, 9.8}},
                                     {"Kingsnake",
                                      {1024, 1024, 795},
                                      {23.82, 2.35, 3.26, 3.39, 3.45},
                                      {21.58, 1.29, 2.33, 2.39, 2.41},
                                      {23.38, 2.46, 2.96, 3.04, 3.06},
                                      {350.4, 18.3, 23.5, 23.7}}};

/// Per transfer function: rebuilding the distance map, then merging 16, 32, 64, 128 and 256
/// partitions, ms.
struct RauterDataset {
    const char* name;
    std::array<int, 3> dims;
    std::array<double, 5> initialisation;
    std::array<std::array<double, 6>, 6> update;
};

constexpr RauterDataset kRauter[] = {{"manix",
                                      {512, 512, 460},
                                      {58.1, 115.3, 227.9, 454.4, 905.2},
                                      {{{3.50, 0.20, 0.27, 0.42, 0.69, 1.30},
                                        {2.55, 0.20, 0.26, 0.44, 0.70, 1.27},
                                        {4.31, 0.18, 0.19, 0.28, 0.44, 0.69},
                                        {4.03, 0.17, 0.22, 0.28, 0.41, 0.71},
                                        {3.85, 0.20, 0.26, 0.38, 0.58, 0.98},
                                        {3.66, 0.18, 0.20, 0.26, 0.44, 0.71}}}},
                                     {"stag beetle",
                                      {832, 832, 494},
                                      {146.4, 299.9, 608.7, 1233.0, 2491.8},
                                      {{{10.10, 0.41, 0.55, 0.87, 1.40, 2.58},
                                        {0.40, 0.41, 0.58, 0.85, 1.38, 2.59},
                                        {12.23, 0.31, 0.39, 0.58, 0.81, 1.40},
                                        {11.30, 0.33, 0.40, 0.58, 0.80, 1.42},
                                        {11.13, 0.45, 0.51, 0.74, 1.14, 2.03},
                                        {11.12, 0.33, 0.40, 0.57, 0.85, 1.42}}}},
                                     {"kingsnake",
                                      {1024, 1024, 795},
                                      {228.2, 458.2, 913.7, 1825.9, 3659.2},
                                      {{{9.63, 0.80, 1.25, 1.97, 3.58, 6.71},
                                        {7.28, 0.80, 1.25, 1.99, 3.56, 6.70},
                                        {21.40, 0.63, 0.77, 1.23, 1.94, 3.58},
                                        {14.59, 0.63, 0.76, 1.23, 1.94, 3.59},
                                        {15.28, 0.79, 1.08, 1.68, 2.86, 5.39},
                                        {9.76, 0.66, 0.79, 1.26, 2.09, 3.60}}}}};

Json faludi() {
    Json datasets = Json::list();
    for (const FaludiDataset& d : kFaludi) {
        datasets.push_back({{"name", d.name},
                            {"dims", Json::listOf(d.dims)},
                            {"marching_only", Json::listOf(d.marching)},
                            {"early_exit", Json::listOf(d.earlyExit)},
                            {"shading", Json::listOf(d.shading)},
                            {"generation", Json::listOf(d.generation)}});
    }
    return {{"source", "Faludi et al. 2021, table 1"},
            {"device", "AMD Radeon RX 6800 XT, 2160x2160 pixels"},
            {"structures", Json::list({"none", "distance map", "boolean-octree", "minmax-octree",
                                       "bitfield-octree"})},
            {"datasets", std::move(datasets)}};
}

Json rauter() {
    Json datasets = Json::list();
    for (const RauterDataset& d : kRauter) {
        Json update = Json::list();
        for (const auto& ms : d.update) {
            update.push_back(Json::listOf(ms));
        }
        datasets.push_back({{"name", d.name},
                            {"dims", Json::listOf(d.dims)},
                            {"initialisation", Json::listOf(d.initialisation)},
                            {"update", std::move(update)}});
    }
    return {{"source", "Rauter et al. 2024, table 1"},
            {"device", "NVIDIA RTX 4090, blocks of 4 voxels"},
            {"partitions", Json::list({16, 32, 64, 128, 256})},
            {"datasets", std::move(datasets)}};
}

} // namespace

Json publishedTables() {
    return {{"faludi", faludi()}, {"rauter", rauter()}};
}

} // namespace slabcast::skipbench
