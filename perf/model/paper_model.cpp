#include "perf/model/paper_model.h"

#include <algorithm>

#include "core/base/error.h"
#include "core/plan/shader_variant.h"

namespace slabcast {

namespace {

constexpr double kScreenPixels = 2960.0 * 1440.0;
constexpr int kTotalLayers = 444; // as the paper has it
constexpr double kTexelBytes = 4.0;

/// Tuples of the paper's shaders on a Mali-G71 (paper_costs.py), for one fragment, or one of its
/// layers. `turn`: what every layer takes, whatever else it does.
struct PaperCosts {
    double discarded, setUp, turn, leap, boxTest, body;
};
constexpr PaperCosts kSlicing{12, 12, 0, 0, 0, 0};
constexpr PaperCosts kUnrolled{8, 25, 2, 0, 5, 8};
constexpr PaperCosts kUnrolledSkipping{8, 25, 3, 2, 6, 13};
constexpr PaperCosts kLoop{0, 25, 6, 0, 6, 8};
constexpr PaperCosts kLoopSkipping{0, 25, 8, 2, 6, 13};

/// In the order of PaperRow and its parts.
constexpr PaperRow kSkull[] = {
    {{1, 444, false}, {350.7, 119.05, 119.05, 0, 119.05, 119.05, 118.76}},
    {{1, 444, true}, {350.7, 119.05, 119.05, 0, 119.05, 119.05, 118.76}},
    {{2, 444, false}, {175.38, 60.196, 120.39, 0, 120.39, 119.07, 118.77}},
    {{2, 444, true}, {175.38, 60.196, 120.39, 56.079, 65.044, 63.884, 63.431}},
    {{4, 444, false}, {87.676, 31.005, 124.02, 0, 124.02, 119.07, 118.77}},
    {{4, 444, true}, {87.676, 31.005, 124.02, 83.299, 42.829, 38.813, 37.868}},
    {{8, 444, false}, {43.828, 16.109, 128.87, 0, 128.87, 119.01, 118.71}},
    {{8, 444, true}, {43.828, 16.109, 128.87, 97.418, 34.892, 27.507, 25.842}},
    {{12, 444, false}, {29.224, 11.456, 137.48, 0, 137.48, 119.17, 118.84}},
    {{12, 444, true}, {29.224, 11.456, 137.48, 102.91, 39.692, 24.774, 22.48}},
    {{16, 444, false}, {21.929, 8.686, 138.98, 0, 138.98, 119.14, 118.79}},
    {{16, 444, true}, {21.929, 8.686, 138.98, 105.92, 39.009, 23.556, 20.72}},
    {{24, 444, false}, {14.628, 6.3852, 153.24, 0, 153.24, 119.23, 118.88}},
    {{24, 444, true}, {14.628, 6.3852, 153.24, 110.53, 49.752, 23.02, 19.376}},
    {{32, 444, false}, {11.011, 5.0873, 162.79, 0, 162.79, 119.1, 118.74}},
    {{32, 444, true}, {11.011, 5.0873, 162.79, 112.03, 58.905, 22.842, 18.691}},
    {{48, 444, false}, {7.2569, 4.0965, 196.63, 0, 196.63, 119.14, 118.79}},
    {{48, 444, true}, {7.2569, 4.0965, 196.63, 118.16, 88.01, 22.952, 18.205}},
    {{64, 444, false}, {5.5947, 3.6116, 231.14, 0, 231.14, 119.02, 118.71}},
    {{64, 444, true}, {5.5947, 3.6116, 231.14, 118.37, 123.15, 22.994, 17.908}},
    {{444, 444, false}, {1.0024, 1.0024, 445.07, 0, 445.07, 122.68, 122.32}},
    {{444, 444, true}, {1.0024, 1.0024, 445.07, 133.18, 331.83, 24.858, 17.367}},
};

const PaperCosts& costsOf(const PaperSettings& settings) {
    if (settings.layersPerPlane == 1) {
        return kSlicing;
    }
    const bool loops = settings.layersPerPlane == settings.totalLayers;
    return loops ? (settings.skips ? kLoopSkipping : kLoop)
                 : (settings.skips ? kUnrolledSkipping : kUnrolled);
}

/// Of n layers, skipping: 6,464 for 16 and 384 for each more or less.
double codeBytesOf(const PaperSettings& settings) {
    const bool loops = settings.layersPerPlane == settings.totalLayers;
    return loops ? 928.0 : 320.0 + 384.0 * settings.layersPerPlane;
}

FrameLoad loadOf(const PaperWork& work, const PaperSettings& settings, double fetches,
                 double pixels, const GpuRates& gpu) {
    const PaperCosts& costs = costsOf(settings);
    FrameLoad load;
    load.slots =
        pixels * ((work.fragments - work.segments) * costs.discarded + work.segments * costs.setUp +
                  work.layers * costs.turn + work.leaps * costs.leap +
                  work.boxTests * costs.boxTest + fetches * costs.body);
    load.texels = pixels * fetches * gpu.texelsOf3d;
    load.fragments = pixels * work.fragments;
    load.pixelsBlended = pixels * work.segments;
    load.tileBytes = kScreenPixels * kTexelBytes; // resolved in the tile
    load.volumeBytes = 2.0 * 256.0 * 256.0 * 256.0 * kTexelBytes;
    load.codeBytes = codeBytesOf(settings);
    return load;
}

double fpsOf(const ModelTerms& terms) {
    return 1e3 / terms.frameMs;
}

/// One of them, by the rows that `fits` takes: the fastest.
template <class Fits>
PaperFigure figureOf(const char* method, double published, std::span<const PaperRow> rows,
                     double share, Fits fits) {
    PaperFigure figure{.method = method, .publishedFps = published, .settings = {}, .terms = {}};
    for (const PaperRow& row : rows) {
        if (!fits(row.settings)) {
            continue;
        }
        const ModelTerms terms = paperFrame(row.work, row.settings, share);
        if (fpsOf(terms) > figure.modelFps) {
            figure.modelFps = fpsOf(terms);
            figure.settings = row.settings;
            figure.terms = terms;
        }
    }
    SLABCAST_EXPECTS(figure.modelFps > 0.0, rows.size());
    return figure;
}

} // namespace

ModelTerms paperFrame(const PaperWork& work, const PaperSettings& settings, double share) {
    const GpuRates& gpu = *findGpuRates("g71");
    const double pixels = share * kScreenPixels;
    return termsOf(loadOf(work, settings, work.fetches, pixels, gpu),
                   loadOf(work, settings, work.fetchesAlone, pixels, gpu), gpu);
}

std::vector<PaperRow> paperRows(const PaperVolume& volume) {
    constexpr int kViews = 6;
    std::vector<int> lengths(kUnrollLengths.begin(), kUnrollLengths.end());
    lengths.push_back(kTotalLayers);
    std::vector<PaperRow> rows;
    for (const int length : lengths) {
        for (const bool skips : {false, true}) {
            PaperRow row{{length, kTotalLayers, skips}, {}};
            for (int k = 0; k < kViews; ++k) {
                const PaperView view{.azimuthDegrees = 360.0 * k / kViews};
                const PaperWork one = paperWork(volume, view, row.settings);
                for (double PaperWork::*part : kPaperParts) {
                    row.work.*part += one.*part / kViews;
                }
            }
            rows.push_back(row);
        }
    }
    return rows;
}

std::span<const PaperRow> paperRowsOfSkull() {
    return kSkull;
}

std::vector<PaperFigure> paperFigures(std::span<const PaperRow> rows, double share) {
    const auto all = [](const PaperSettings& s) { return s.layersPerPlane == s.totalLayers; };
    return {
        figureOf("ray casting", 4.7, rows, share,
                 [&](const PaperSettings& s) { return all(s) && !s.skips; }),
        figureOf("ray casting, skipping", 8.5, rows, share,
                 [&](const PaperSettings& s) { return all(s) && s.skips; }),
        figureOf("slicing", 13.9, rows, share,
                 [&](const PaperSettings& s) { return s.layersPerPlane == 1; }),
        figureOf(
            "best hybrid, skipping", 36.0, rows, share,
            [&](const PaperSettings& s) { return s.layersPerPlane > 1 && !all(s) && s.skips; }),
    };
}

} // namespace slabcast
