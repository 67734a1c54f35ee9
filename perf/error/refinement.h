#pragma once

#include <string>
#include <vector>

#include "perf/error/convergence.h"
#include "perf/stage.h"

namespace slabcast {

/// One method, refined: what was measured, what was expected before, and whether they agree.
struct RefinementStudy {
    std::string kind;   // step, grid or pixel: what is refined
    std::string method; // what is measured
    std::string unit;   // of the levels' sizes
    double rightOrder = 2.0;
    double expectedOrder = 2.0; // of a negative control: of the mistake
    std::string whyExpected;
    bool control = false;
    double floor = 0.0; // of what the truth or the target resolve
    std::vector<RefinementLevel> levels;
    Convergence convergence;

    bool asExpected() const { return hasOrder(convergence, expectedOrder); }
    /// What a negative control must not.
    bool looksRight() const { return hasOrder(convergence, rightOrder); }
};

/// Refines step, grid and pixel, in float64, in a field by formula whose pictures are known
/// exactly: a Marschner-Lobb signal of one wave, in a box whose rays meet no knot of the transfer
/// function. Beside the renderer's own way stand mistakes as negative controls, judged alike.
/// Cost: about 0.5 s on two cores.
/// Source: Etiene et al. 2014, "Verifying Volume Rendering Using Discretization Error Analysis".
/// Tested by: refinement_test.cpp
std::vector<RefinementStudy> refine();

/// The same of what the device draws: step and grid, by ray casting into RGBA16F from float32
/// texels. So that three refinements lie above that target's rounding, which is measured where
/// nothing else errs, the field is one cosine wave along each axis: its asymptotic range begins at
/// few voxels a wave. Fails: as Stage::open(), Stage::prepare() and Stage::drawOnNothing().
Result<std::vector<RefinementStudy>> refineOnDevice(const Device& device);

/// A report's `refinement`: `field`, tolerances and `studies`.
Json toJson(const std::vector<RefinementStudy>& studies);
/// A line per level. Tested by: refinement_test.cpp
std::string refinementCsv(const std::vector<RefinementStudy>& studies);

} // namespace slabcast
