#pragma once

#include "core/transfer/transfer_function.h"
#include "core/volume/texels.h"
#include "perf/json.h"

namespace slabcast {

/// The highest frequency of a transfer function over a range of values, in cycles per data unit:
/// below it lies `share` of the energy (without the mean) of its extinction and of the light that
/// this sends, the greatest of the four. A piecewise linear function has no highest frequency of
/// its own. Tested by: predicted_step_test.cpp
double transferFrequency(const TransferFunction& tf, double lowValue, double highValue,
                         double share);

/// Of the trilinear field, per mm along the voxels' axes, exact: it is greatest at a cell's corner.
struct FieldGradients {
    double greatest = 0.0;     // of cells in which something is visible
    double percentile99 = 0.0; // of those cells' own greatest
    double anywhere = 0.0;     // the greatest of all cells
};

/// Cost: one pass, all cores. Tested by: predicted_step_test.cpp
FieldGradients gradientsOf(const Texels& texels, const VolumeGeometry& geometry,
                           const TransferFunction& tf);

struct StepPrediction {
    double transferFrequency = 0.0; // cycles per data unit
    FieldGradients gradients;
    /// Nyquist's step in mm for a transfer function of that frequency along a gradient: the
    /// frequency of f(g(x)) is at most that of f times the greatest |g'|. Infinite where nothing
    /// varies. Source: Bergner, Moeller, Weiskopf and Muraki 2006, "A Spectral Analysis of Function
    /// Composition and its Implications for Sampling in Direct Volume Visualization".
    double stepMm(double gradientPerMm) const;
};

/// A report's `predicted_step`: the prediction beside the coarsest spacing of `rows`,
/// post-classified without jitter, from which on the RMSE of sampling stays below 1/255, their
/// ratio, and why they are apart. Tested by: predicted_step_test.cpp
Json predictedStep(const StepPrediction& prediction, double smallestVoxelEdgeMm, const Json& rows);

/// Of a volume's own values under a look.
StepPrediction predictStep(const Texels& texels, const VolumeGeometry& geometry,
                           const TransferFunction& tf, double lowValue, double highValue);

} // namespace slabcast
