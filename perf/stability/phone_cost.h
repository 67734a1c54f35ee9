#pragma once

#include <optional>

#include "perf/model/frame_model.h"
#include "perf/stability/bench.h"

namespace slabcast::stability {

/// Fragments, layers, looks and fetches of a view as it is drawn here, scaled to a million pixels;
/// without the volume's bytes, and no pixel waits for another. `raysPerPixel`: the share of the
/// view that meets the volume. Contract: the settings write segments out, as for a phone. Fails: as
/// slabcast::plan() and Renderer::countWork(). Tested by: stability_gl_test.cpp
Result<FrameWork> workOfMillion(Bench& bench, const Scene& scene, const Settings& settings,
                                const View& view, double raysPerPixel);

/// What that takes a GPU that is not at hand, by the model (perf/model), with the shader that it
/// would get. Nothing where the compilers' committed costs lack it. Fails: as slabcast::plan().
/// Tested by: stability_gl_test.cpp
Result<std::optional<ModelTerms>> modelledOn(const GpuRates& gpu, const Bench& bench,
                                             const Scene& scene, const Settings& settings,
                                             const FrameWork& work);

} // namespace slabcast::stability
