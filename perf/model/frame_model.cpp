#include "perf/model/frame_model.h"

#include <algorithm>

namespace slabcast {

namespace {

/// Of code, to a core: half a line of the second cache. Not published; of the range's ends alone.
constexpr double kCodeBytesPerClock = 32.0;
/// That a core holds at once: 16 on Adreno (Mesa, max_waves); on a G71 384 threads are more.
constexpr double kWavesAtOnce = 16.0;
/// The rate at which tiles blend is of pixels of so many bytes.
constexpr double kUsualPixelBytes = 4.0;

FrameLoad loadOf(const FrameWork& work, const SegmentCosts& costs, const GpuRates& gpu,
                 bool diverges) {
    const double layerTimes = diverges ? work.layerDivergence : 1.0;
    const double lookTimes = diverges ? work.lookDivergence : 1.0;
    const double layers = work.layers * layerTimes;
    const double looks = work.looks * lookTimes;
    const double ends = std::min(work.rays * layerTimes, work.fragments);
    const double turns = work.turns * std::max(layerTimes, lookTimes);
    const double ofVolume = work.volumeFetches * layerTimes;
    const double ofTables = std::max(0.0, layers * costs.layer.fetches - ofVolume);
    const double texels =
        work.filtered ? gpu.texelsOf3d * (work.wideTexels ? 2.0 : 1.0) : 1.0; // of a fetch
    FrameLoad load;
    load.slots = work.fragments * costs.fragment.slots + layers * costs.layer.slots +
                 looks * costs.look.slots + ends * costs.ends.slots + turns * costs.turn.slots;
    load.texels = work.fragments * costs.fragment.fetches + ofVolume * texels + ofTables +
                  looks * costs.look.fetches + ends * costs.ends.fetches;
    load.fragments = work.fragments;
    load.pixelsBlended = work.fragments * std::max(1.0, work.bytesPerPixel / kUsualPixelBytes);
    // A layer of our own is stored and loaded before the target is stored.
    load.tileBytes = work.pixels * work.bytesPerPixel * (work.layerOfOurOwn ? 3.0 : 1.0);
    load.volumeBytes = work.volumeBytes * work.views;
    load.codeBytes = costs.codeBytes;
    return load;
}

} // namespace

ModelTerms termsOf(const FrameLoad& load, const FrameLoad& alone, const GpuRates& gpu) {
    const double clocksPerMs = gpu.megahertz * 1e3;
    const auto msAt = [clocksPerMs](double amount, double perClock) {
        return amount / (perClock * clocksPerMs);
    };
    const auto shaderMs = [&](const FrameLoad& of) {
        return std::max(msAt(of.slots, gpu.issueSlots), msAt(of.texels, gpu.texels));
    };
    const double bytesPerMs = gpu.gigabytesPerSecond * 1e6;
    ModelTerms terms;
    terms.issueMs = msAt(load.slots, gpu.issueSlots);
    terms.textureMs = msAt(load.texels, gpu.texels);
    terms.fragmentMs = msAt(load.fragments, gpu.fragments);
    terms.blendMs = msAt(load.pixelsBlended, gpu.pixels);
    terms.tileMs = load.tileBytes / bytesPerMs;
    terms.memoryMs = terms.tileMs + load.volumeBytes / bytesPerMs;
    terms.divergenceMs = shaderMs(load) - shaderMs(alone);

    const double waves = load.fragments / (gpu.waveWidth * gpu.waveHeight);
    const auto codeMs = [&](int held, double wavesAtOnce) {
        const double bytes = std::max(0.0, load.codeBytes - held);
        return msAt(waves / wavesAtOnce * bytes, kCodeBytesPerClock * gpu.cores);
    };
    terms.codeLowMs = codeMs(gpu.codeBytesHigh, kWavesAtOnce);
    terms.codeHighMs = codeMs(gpu.codeBytesLow, 1.0);

    const struct {
        const char* name;
        double ms;
    } others[] = {{"texture", terms.textureMs},
                  {"fragments", terms.fragmentMs},
                  {"blending", terms.blendMs},
                  {"memory", terms.memoryMs}};
    const auto busiest = *std::max_element(std::begin(others), std::end(others),
                                           [](auto& a, auto& b) { return a.ms < b.ms; });
    terms.limit = terms.issueMs > busiest.ms ? "instructions" : busiest.name;
    const double fastest = msAt(load.slots, gpu.issueSlotsHigh);
    terms.frameMs = std::max(terms.issueMs, busiest.ms) + terms.codeLowMs;
    terms.lowMs = std::max(fastest, busiest.ms) + terms.codeLowMs;
    terms.highMs = std::max(terms.issueMs, busiest.ms) + terms.codeHighMs;
    return terms;
}

ModelTerms modelFrame(const FrameWork& work, const SegmentCosts& costs, const GpuRates& gpu) {
    return termsOf(loadOf(work, costs, gpu, true), loadOf(work, costs, gpu, false), gpu);
}

} // namespace slabcast
