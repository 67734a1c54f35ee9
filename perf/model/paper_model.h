#pragma once

#include <span>
#include <vector>

#include "perf/model/frame_model.h"
#include "perf/model/paper_sampling.h"

namespace slabcast {

// The model held against the core paper's own four figures (Tukora 2020, section 3 and Fig. 4): a
// Mali-G71 MP20, 2960x1440 pixels for both eyes, two samples a pixel, a CT skull of 256^3.

/// The share of the screen that the bounding sphere's discs cover, which the paper does not print:
/// the one free constant. It is the one by which the worst of the four is off least.
inline constexpr double kPaperShare = 0.74;

/// By the costs of paper_costs.py.
ModelTerms paperFrame(const PaperWork& work, const PaperSettings& settings,
                      double share = kPaperShare);

/// One of the four.
struct PaperFigure {
    const char* method;
    double publishedFps = 0.0;
    double modelFps = 0.0;
    PaperSettings settings; // of the best hybrid those that the model finds fastest
    ModelTerms terms;
};

/// What sampling so does, for one way of dealing out the layers.
struct PaperRow {
    PaperSettings settings;
    PaperWork work;
};

/// Of a cube of 256^3: all ratios that can be written out, and ray casting; mean of six views.
std::vector<PaperRow> paperRows(const PaperVolume& volume);

/// What paperRows() gives of the demo's skull under ct-bone, resampled to 256^3.
std::span<const PaperRow> paperRowsOfSkull();

/// Ray casting without and with skipping, slicing, and the best hybrid. Contract: rows of all.
std::vector<PaperFigure> paperFigures(std::span<const PaperRow> rows, double share = kPaperShare);

} // namespace slabcast
