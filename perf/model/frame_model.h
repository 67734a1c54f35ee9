#pragma once

#include "perf/model/gpu_rates.h"

namespace slabcast {

// How long a frame takes a GPU, by a model: counted work, times what its compiler says of the
// shader, over what is published of the GPU. Nothing is fitted. What comes out is called a model's
// wherever it is shown.

/// Part of a segment shader, by the GPU's compiler, for one fragment.
struct PartCosts {
    double slots = 0.0;   // instructions issued
    double fetches = 0.0; // of any texture
};

/// A segment shader in parts, each done as often as the work says.
struct SegmentCosts {
    PartCosts fragment; // set-up and end
    PartCosts layer;    // that is evaluated, the volume's fetches included
    PartCosts look;     // at the skip structure
    PartCosts ends;     // of a ray: the layers that its entry and its exit cut, where apart
    PartCosts turn;     // of a loop over groups, beside what is done in it
    double codeBytes = 0.0;
};

/// What a frame does.
struct FrameWork {
    double pixels = 0.0; // of all views
    double fragments = 0.0;
    double rays = 0.0;   // pixels that are drawn at all
    double layers = 0.0; // evaluated
    double volumeFetches = 0.0;
    double looks = 0.0;
    double turns = 0.0; // of loops
    // How many times as much waves do, since their pixels wait for each other.
    double layerDivergence = 1.0;
    double lookDivergence = 1.0;
    double volumeBytes = 0.0; // of its texture
    int views = 1;
    double bytesPerPixel = 4.0; // of the target
    bool layerOfOurOwn = false; // that is stored, loaded and composited
    bool filtered = true;       // the volume's texels, or fetched as they are
    bool wideTexels = false;    // of more than 32 bits
};

/// What is asked of the parts of a GPU, which work side by side.
struct FrameLoad {
    double slots = 0.0;
    double texels = 0.0; // bilinear ones
    double fragments = 0.0;
    double pixelsBlended = 0.0;
    double tileBytes = 0.0;
    double volumeBytes = 0.0;
    double codeBytes = 0.0;
};

/// Milliseconds.
struct ModelTerms {
    double issueMs = 0.0;
    double textureMs = 0.0;
    double fragmentMs = 0.0; // fragments begun
    double blendMs = 0.0;    // planes, in the tile
    double tileMs = 0.0;     // tiles stored, and loaded where a layer is composited
    double memoryMs = 0.0;   // tiles, and the volume once per view: the least there is

    double divergenceMs = 0.0; // that issue or texture would be spared if no pixel waited
    // Of code that the instruction cache does not hold: fetched anew for all waves that a core
    // holds at once, or for each.
    double codeLowMs = 0.0;
    double codeHighMs = 0.0;

    double frameMs = 0.0;   // the busiest part's, and codeLowMs
    double lowMs = 0.0;     // by the most that is claimed of the GPU
    double highMs = 0.0;    // with codeHighMs
    const char* limit = ""; // what the busiest part does
};

/// Pure. `alone`: the same if no pixel waited for another.
ModelTerms termsOf(const FrameLoad& load, const FrameLoad& alone, const GpuRates& gpu);

/// Pure. Tested by: frame_model_test.cpp
ModelTerms modelFrame(const FrameWork& work, const SegmentCosts& costs, const GpuRates& gpu);

} // namespace slabcast
