#include "perf/error/predicted_step.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <vector>

#include "core/base/parallel.h"
#include "core/reference/material.h"
#include "core/reference/picture_difference.h"
#include "core/reference/transfer_ramps.h"
#include "core/volume/trilinear_field.h"
#include "perf/number.h"

namespace slabcast {

namespace {

constexpr double kEnergyShare = 0.99;
constexpr int kSamples = 512;  // of the transfer function
constexpr double kApart = 2.0; // ratios beyond it, either way, are called far off

/// Cosine k over the range has k half waves: mirrored at both ends, a function that ends at other
/// values than it began with has no jump there.
std::vector<double> cosineEnergies(const std::vector<double>& samples) {
    const std::size_t count = samples.size();
    std::vector<double> cosines(4 * count); // a whole turn
    for (std::size_t k = 0; k < cosines.size(); ++k) {
        cosines[k] =
            std::cos(0.5 * std::numbers::pi * static_cast<double>(k) / static_cast<double>(count));
    }
    std::vector<double> energies(count, 0.0);
    for (std::size_t k = 1; k < count; ++k) {
        double sum = 0.0;
        for (std::size_t i = 0; i < count; ++i) {
            sum += samples[i] * cosines[k * (2 * i + 1) % cosines.size()];
        }
        energies[k] = sum * sum;
    }
    return energies;
}

/// Half waves below which `share` of the energy lies; 0 of a constant.
std::size_t halfWaves(const std::vector<double>& samples, double share) {
    const std::vector<double> energies = cosineEnergies(samples);
    double total = 0.0, largest = 0.0;
    for (std::size_t k = 0; k < samples.size(); ++k) {
        total += energies[k];
        largest = std::max(largest, std::abs(samples[k]));
    }
    const auto count = static_cast<double>(samples.size());
    if (std::sqrt(total) <= 1e-12 * largest * count) {
        return 0; // rounding
    }
    double below = 0.0;
    for (std::size_t k = 0; k < energies.size(); ++k) {
        below += energies[k];
        if (below >= share * total) {
            return k;
        }
    }
    return energies.size();
}

/// Around a cell, x fastest: the gradient's greatest length at its corners. The slope along each
/// axis is that of one of its four edges, and every corner has one of each axis.
double greatestGradient(const std::array<double, 8>& corners, glm::dvec3 perMm) {
    std::array<double, 12> squares; // four edges along x, four along y, four along z
    for (unsigned k = 0; k < 4; ++k) {
        const double x = (corners[2 * k + 1] - corners[2 * k]) * perMm.x;
        const unsigned alongY = (k & 1U) + 4 * (k >> 1U);
        const double y = (corners[alongY + 2] - corners[alongY]) * perMm.y;
        const double z = (corners[k + 4] - corners[k]) * perMm.z;
        squares[k] = x * x;
        squares[4 + k] = y * y;
        squares[8 + k] = z * z;
    }
    double greatest = 0.0;
    for (unsigned k = 0; k < 8; ++k) {
        greatest = std::max(greatest, squares[k >> 1U] + squares[4 + (k & 1U) + 2 * (k >> 2U)] +
                                          squares[8 + (k & 3U)]);
    }
    return std::sqrt(greatest);
}

struct SliceGradients {
    std::vector<float> visible; // per cell
    double anywhere = 0.0;
};

template <class Field>
SliceGradients sliceOf(const Field& field, glm::ivec3 dims, int z, glm::dvec3 perMm,
                       const TransferRamps& ramps) {
    SliceGradients slice;
    for (int y = 0; y < std::max(dims.y - 1, 1); ++y) {
        for (int x = 0; x < std::max(dims.x - 1, 1); ++x) {
            const std::array<double, 8> corners = field.cornersOf({x, y, z});
            const auto [low, high] = std::minmax_element(corners.begin(), corners.end());
            const double steepest = *low == *high ? 0.0 : greatestGradient(corners, perMm);
            slice.anywhere = std::max(slice.anywhere, steepest);
            if (ramps.anyVisible(ramps.holding(*low), ramps.holding(*high))) {
                slice.visible.push_back(static_cast<float>(steepest));
            }
        }
    }
    return slice;
}

struct Measured {
    double spacing;
    double rmse;
};

/// Of the post-classified rows without jitter, coarse to fine.
std::vector<Measured> samplingErrors(const Json& rows) {
    std::vector<Measured> all;
    for (const Json& row : rows) {
        if (row.at("classify") == "post" && !row.at("jitter").flag()) {
            all.push_back({row.at("layer_spacing").number(),
                           row.at("error").at("sampling").at("rmse").number()});
        }
    }
    std::sort(all.begin(), all.end(),
              [](const Measured& a, const Measured& b) { return a.spacing > b.spacing; });
    return all;
}

/// The coarsest from which on all finer ones are good enough too.
std::optional<Measured> coarsestBelow(const std::vector<Measured>& errors, double threshold) {
    std::optional<Measured> found;
    for (auto at = errors.rbegin(); at != errors.rend() && at->rmse <= threshold; ++at) {
        found = *at;
    }
    return found;
}

std::string whyApart(const std::vector<Measured>& errors, const std::optional<Measured>& best,
                     double predictedVoxels) {
    if (errors.empty()) {
        return "nothing was measured with post-classification and without jitter";
    }
    if (!best) {
        return "no spacing that was measured comes below the threshold; the finest, " +
               number(errors.back().spacing) + ", has " + number(errors.back().rmse);
    }
    if (!std::isfinite(predictedVoxels)) {
        return "nothing that is visible varies: any step will do";
    }
    const double ratio = best->spacing / predictedVoxels;
    const std::string bound = best->spacing == errors.front().spacing
                                  ? "; the coarsest spacing that was measured is good enough, "
                                    "coarser ones may be too"
                                  : "";
    if (ratio > kApart) {
        return "a coarser step does: the bound holds for the steepest visible gradient met "
               "head-on, "
               "while the threshold is a mean over pixels whose rays meet gentler ones, and what "
               "aliases averages out along a ray" +
               bound;
    }
    if (ratio < 1.0 / kApart) {
        return "a finer step is needed: corners and steps of the transfer function have " +
               number(100.0 * (1.0 - kEnergyShare), 2) +
               " % of their energy beyond the frequency, and opacity adds up what aliases" + bound;
    }
    return "within a factor of " + number(kApart) + " of each other" + bound;
}

Json finiteOrNull(double value) {
    return std::isfinite(value) ? Json(value) : Json();
}

} // namespace

double transferFrequency(const TransferFunction& tf, double lowValue, double highValue,
                         double share) {
    if (!(lowValue < highValue)) {
        return 0.0;
    }
    std::array<std::vector<double>, 4> functions;
    for (int i = 0; i < kSamples; ++i) {
        const double value = lowValue + (i + 0.5) / kSamples * (highValue - lowValue);
        const glm::dvec4 material = materialOf(tf, CompositingSpace::Display, value);
        for (int channel = 0; channel < 3; ++channel) {
            functions[static_cast<std::size_t>(channel)].push_back(material[channel] * material.w);
        }
        functions[3].push_back(material.w);
    }
    std::size_t most = 0;
    for (const std::vector<double>& function : functions) {
        most = std::max(most, halfWaves(function, share));
    }
    return 0.5 * static_cast<double>(most) / (highValue - lowValue);
}

FieldGradients gradientsOf(const Texels& texels, const VolumeGeometry& geometry,
                           const TransferFunction& tf) {
    const TransferRamps ramps(tf, CompositingSpace::Display);
    const glm::dvec3 perMm = 1.0 / geometry.spacingMm;
    std::vector<SliceGradients> slices(static_cast<std::size_t>(std::max(texels.dims.z - 1, 1)));
    visitTexelFormat(texels.format, [&](auto codec) {
        const TrilinearField field(texels, codec);
        parallelFor(static_cast<std::int64_t>(slices.size()), 1,
                    [&](std::int64_t begin, std::int64_t end) {
                        for (std::int64_t z = begin; z < end; ++z) {
                            slices[static_cast<std::size_t>(z)] =
                                sliceOf(field, texels.dims, static_cast<int>(z), perMm, ramps);
                        }
                    });
        return true;
    });
    FieldGradients gradients;
    std::vector<float> visible;
    for (const SliceGradients& slice : slices) {
        gradients.anywhere = std::max(gradients.anywhere, slice.anywhere);
        visible.insert(visible.end(), slice.visible.begin(), slice.visible.end());
    }
    if (!visible.empty()) {
        const auto rank = visible.begin() + static_cast<std::ptrdiff_t>(
                                                0.99 * static_cast<double>(visible.size() - 1));
        std::nth_element(visible.begin(), rank, visible.end());
        gradients.percentile99 = *rank;
        gradients.greatest = *std::max_element(rank, visible.end());
    }
    return gradients;
}

double StepPrediction::stepMm(double gradientPerMm) const {
    const double frequency = transferFrequency * gradientPerMm;
    return frequency > 0.0 ? 0.5 / frequency : std::numeric_limits<double>::infinity();
}

StepPrediction predictStep(const Texels& texels, const VolumeGeometry& geometry,
                           const TransferFunction& tf, double lowValue, double highValue) {
    return {transferFrequency(tf, lowValue, highValue, kEnergyShare),
            gradientsOf(texels, geometry, tf)};
}

Json predictedStep(const StepPrediction& prediction, double smallestVoxelEdgeMm, const Json& rows) {
    const FieldGradients& gradients = prediction.gradients;
    const double predictedMm = prediction.stepMm(gradients.greatest);
    const double predictedVoxels = predictedMm / smallestVoxelEdgeMm;
    const double of99Voxels = prediction.stepMm(gradients.percentile99) / smallestVoxelEdgeMm;
    const std::vector<Measured> errors = samplingErrors(rows);
    const std::optional<Measured> best = coarsestBelow(errors, kVisibleDifference);
    const auto ratioTo = [&best](double voxels) {
        return best && std::isfinite(voxels) ? Json(best->spacing / voxels) : Json();
    };
    return {{"energy_share", kEnergyShare},
            {"transfer_cycles_per_unit", prediction.transferFrequency},
            {"gradient_per_mm", gradients.greatest},
            {"gradient_p99_per_mm", gradients.percentile99},
            {"gradient_anywhere_per_mm", gradients.anywhere},
            {"predicted_mm", finiteOrNull(predictedMm)},
            {"predicted_voxels", finiteOrNull(predictedVoxels)},
            {"predicted_p99_voxels", finiteOrNull(of99Voxels)},
            {"threshold_rmse", kVisibleDifference},
            {"measured_voxels", best ? Json(best->spacing) : Json()},
            {"measured_rmse", best ? Json(best->rmse) : Json()},
            {"ratio", ratioTo(predictedVoxels)},
            {"ratio_p99", ratioTo(of99Voxels)},
            {"why", whyApart(errors, best, predictedVoxels)}};
}

} // namespace slabcast
