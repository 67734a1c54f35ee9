#include "perf/stability/sampling_bound.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/volume/trilinear_field.h"

namespace slabcast::stability {

namespace {

/// Pieces into which a layer of one voxel is cut to find the material's extremes in it.
constexpr int kPartsPerVoxel = 8;
constexpr int kPartsOfMotion = 4;

/// Length of [from, to] within [low, high].
double overlap(double from, double to, double low, double high) {
    return std::max(0.0, std::min(to, high) - std::max(from, low));
}

double largest(glm::dvec3 v) {
    return std::max({v.x, v.y, v.z});
}

/// Largest change of 1 - exp(-depth) where the depth is off by `error` to either side.
double opacityError(double depth, double error) {
    return std::exp(-depth) * std::max(std::expm1(std::min(error, depth)), -std::expm1(-error));
}

constexpr double kInfinity = std::numeric_limits<double>::infinity();

template <class Materials>
constexpr Materials kNoMaterials{kInfinity, -kInfinity, glm::dvec3(kInfinity),
                                 glm::dvec3(-kInfinity)};

template <class Materials>
void extend(Materials& all, glm::dvec3 color, double extinction) {
    all = {std::min(all.extinctionLow, extinction), std::max(all.extinctionHigh, extinction),
           glm::min(all.colorLow, color), glm::max(all.colorHigh, color)};
}

} // namespace

EyeRay eyeRayOf(const View& view, const Viewport& viewport, const VolumeGeometry& geometry,
                glm::dvec2 fragCoord) {
    const glm::dmat4 modelFromView = glm::inverse(view.viewFromModel);
    const glm::dvec2 share = (fragCoord - glm::dvec2(viewport.x, viewport.y)) /
                             glm::dvec2(viewport.width, viewport.height);
    const Frustum& f = view.frustum;
    const glm::dvec3 direction(glm::mix(f.left, f.right, share.x),
                               glm::mix(f.bottom, f.top, share.y), -1.0);
    const glm::dvec3 centre(view.viewFromModel *
                            glm::dvec4(geometry.boundingSphere().centreMm, 1.0));
    const glm::dmat4 uvwFromView = geometry.uvwFromModel() * modelFromView;
    EyeRay ray{.eyeUvw = glm::dvec3(uvwFromView[3]),
               .uvwPerMm = glm::dmat3(uvwFromView) * glm::normalize(direction),
               .cosine = 1.0 / glm::length(direction),
               .centreDepthMm = -centre.z,
               .centreDistanceMm = glm::length(centre),
               .entryMm = view.nearDepth * glm::length(direction),
               .exitMm = kInfinity};
    for (int k = 0; k < 3; ++k) {
        const double a = (0.0 - ray.eyeUvw[k]) / ray.uvwPerMm[k];
        const double b = (1.0 - ray.eyeUvw[k]) / ray.uvwPerMm[k];
        ray.entryMm = std::max(ray.entryMm, std::min(a, b));
        ray.exitMm = std::min(ray.exitMm, std::max(a, b));
    }
    return ray;
}

LayerPlace placeOf(const EyeRay& ray, const Lattice& lattice, int layer, double jitter) {
    const double offset = layer - lattice.total / 2.0 + jitter;
    const auto at = [&](double o) {
        return lattice.kind == LatticeKind::Planar
                   ? (ray.centreDepthMm + o * lattice.spacingMm) / ray.cosine
                   : ray.centreDistanceMm + o * lattice.spacingMm;
    };
    return {at(offset), at(offset + 0.5), at(offset + 1.0)};
}

SamplingBound::SamplingBound(const Scene& scene, By by)
    : tf_(scene.look().tf), table_(by == By::Table ? &scene.table() : nullptr) {
    visitTexelFormat(scene.texels().format, [&](auto codec) {
        field_ = [field = TrilinearField(scene.texels(), codec)](glm::dvec3 uvw) {
            return field.at(uvw);
        };
    });
}

double SamplingBound::valueAt(const EyeRay& ray, double mm) const {
    return field_(ray.eyeUvw + mm * ray.uvwPerMm);
}

SamplingBound::Materials SamplingBound::meant(Range values) const {
    Materials all = kNoMaterials<Materials>;
    const auto include = [&](const TransferSample& sample) {
        extend(all, sample.color, extinctionPerMm(sample.opacity, tf_.opacityUnitMm));
    };
    include(evaluate(tf_, values.low));
    include(evaluate(tf_, values.high));
    for (const TransferPoint& point : tf_.points) {
        if (values.low <= point.value && point.value <= values.high) { // of a step: both its ends
            include({point.color, point.opacity});
        }
    }
    return all;
}

SamplingBound::Materials SamplingBound::sampled(Range values) const {
    if (table_ == nullptr) {
        return meant(values);
    }
    Materials all = kNoMaterials<Materials>;
    const auto include = [&](const glm::dvec4& material) {
        extend(all, glm::dvec3(material), material.w);
    };
    include(lookUp(*table_, values.low));
    include(lookUp(*table_, values.high));
    const double last = double(table_->texels.size()) - 1.0;
    const double perTexel = (table_->lastValue - table_->firstValue) / last;
    const auto texelAt = [&](double value) {
        return std::clamp((value - table_->firstValue) / perTexel, 0.0, last);
    };
    for (double k = std::ceil(texelAt(values.low)); k <= texelAt(values.high); k += 1.0) {
        include(lookUp(*table_, table_->firstValue + k * perTexel));
    }
    return all;
}

SamplingBound::Range SamplingBound::valuesAlong(const EyeRay& ray, double fromMm, double toMm,
                                                int parts) const {
    double last = valueAt(ray, fromMm);
    Range range{last, last};
    double step = 0.0; // what may hide between two places that are looked at
    for (int k = 1; k <= parts; ++k) {
        const double value = valueAt(ray, glm::mix(fromMm, toMm, double(k) / parts));
        range = {std::min(range.low, value), std::max(range.high, value)};
        step = std::max(step, std::abs(value - last));
        last = value;
    }
    return {range.low - 0.5 * step, range.high + 0.5 * step};
}

double SamplingBound::ofSampling(const EyeRay& ray, const Lattice& lattice, double jitter) const {
    double bound = 0.0;
    double clear = 1.0;
    for (int i = 0; i < lattice.total; ++i) {
        const LayerPlace place = placeOf(ray, lattice, i, jitter);
        const double length = overlap(place.begin, place.end, ray.entryMm, ray.exitMm);
        if (length == 0.0) {
            continue;
        }
        const double value = valueAt(ray, place.middle);
        const Materials taken = sampled({value, value});
        const int parts = std::max(2, int(std::ceil(kPartsPerVoxel * (place.end - place.begin))));
        double depthError = 0.0;
        glm::dvec3 colorError(0.0);
        for (int k = 0; k < parts; ++k) {
            const double from = glm::mix(place.begin, place.end, double(k) / parts);
            const double to = glm::mix(place.begin, place.end, (k + 1.0) / parts);
            const double inside = overlap(from, to, ray.entryMm, ray.exitMm);
            if (inside == 0.0) {
                continue;
            }
            const Materials met = meant(valuesAlong(ray, from, to, 2));
            depthError += inside * std::max(met.extinctionHigh - taken.extinctionLow,
                                            taken.extinctionHigh - met.extinctionLow);
            colorError = glm::max(colorError, glm::max(met.colorHigh - taken.colorLow,
                                                       taken.colorHigh - met.colorLow));
        }
        const double alpha = -std::expm1(-taken.extinctionHigh * length);
        bound += clear * (opacityError(taken.extinctionLow * length, depthError) +
                          alpha * largest(colorError));
        clear *= std::exp(-taken.extinctionLow * length);
    }
    return bound;
}

double SamplingBound::ofMotion(const EyeRay& before, const EyeRay& after,
                               const Lattice& lattice) const {
    // Places in float64, from terms of the size of the distance, each rounded a few dozen times.
    const double rounding = 0x1p-44 * (before.centreDistanceMm + before.exitMm);
    double bound = 0.0;
    double clear = 1.0;
    for (int i = 0; i < lattice.total; ++i) {
        const LayerPlace from = placeOf(before, lattice, i, 0.0);
        const LayerPlace to = placeOf(after, lattice, i, 0.0);
        const double lengthFrom = overlap(from.begin, from.end, before.entryMm, before.exitMm);
        const double lengthTo = overlap(to.begin, to.end, after.entryMm, after.exitMm);
        const double least = std::max(0.0, std::min(lengthFrom, lengthTo) - rounding);
        const double most = std::max(lengthFrom, lengthTo) + rounding;
        if (most == rounding) {
            continue;
        }
        const Materials met =
            sampled(valuesAlong(before, std::min(from.middle, to.middle) - rounding,
                                std::max(from.middle, to.middle) + rounding, kPartsOfMotion));
        const double alphaLow = -std::expm1(-met.extinctionLow * least);
        const double alphaHigh = -std::expm1(-met.extinctionHigh * most);
        bound += clear * (alphaHigh - alphaLow + alphaHigh * largest(met.colorHigh - met.colorLow));
        clear *= 1.0 - alphaLow;
    }
    return bound;
}

} // namespace slabcast::stability
