#include "perf/stability/expected.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "core/base/parallel.h"
#include "perf/stability/reference_picture.h"
#include "perf/stability/sampling_bound.h"

namespace slabcast::stability {

namespace {

/// Fills one entry per judged pixel, on all cores.
template <class T, class Of>
std::vector<T> perPixel(const Exhibit& exhibit, const Of& of) {
    const int columns = exhibit.columns();
    std::vector<T> result(static_cast<std::size_t>(columns) * exhibit.size.y);
    parallelFor(static_cast<std::int64_t>(result.size()), 64,
                [&](std::int64_t begin, std::int64_t end) {
                    for (std::int64_t i = begin; i < end; ++i) {
                        result[i] = of(exhibit.fragCoord(int(i % columns), int(i / columns)));
                    }
                });
    return result;
}

/// Length of the ray in the box grown by `grow` on every side and beyond the near plane, mm.
double chordMm(const EyeRay& ray, double nearMm, glm::dvec3 grow) {
    double begin = std::max(0.0, nearMm);
    double end = std::numeric_limits<double>::infinity();
    for (int k = 0; k < 3; ++k) {
        const double low = -grow[k] - ray.eyeUvw[k];
        const double high = 1.0 + grow[k] - ray.eyeUvw[k];
        if (low >= high || (ray.uvwPerMm[k] == 0.0 && (low > 0.0 || high < 0.0))) {
            return 0.0;
        }
        if (ray.uvwPerMm[k] != 0.0) {
            const double a = low / ray.uvwPerMm[k];
            const double b = high / ray.uvwPerMm[k];
            begin = std::max(begin, std::min(a, b));
            end = std::min(end, std::max(a, b));
        }
    }
    return std::max(0.0, end - begin);
}

/// What float32 may do to a ray: to its positions in uvw by 2^-22 of the terms that they are summed
/// from; to the ends of its stretch inside, which are counted in layers, by 2^-21 of their number
/// each; to the near plane by 2^-21 of its distance from the lattice's centre.
struct RayError {
    glm::dvec3 uvw;
    double lengthMm;
    double nearMm;
};

RayError rayError(const RayFrame& frame, const LatticeRay& ray, glm::dvec2 fragCoord) {
    const glm::dvec2 p = glm::abs(fragCoord - frame.viewportCentre);
    const double total = frame.lattice.total;
    const glm::dvec3 direction = glm::abs(frame.direction0) + glm::abs(frame.directionX) * p.x +
                                 glm::abs(frame.directionY) * p.y;
    const glm::dvec3 terms = glm::abs(frame.centre0) + glm::abs(frame.centreX) * p.x +
                             glm::abs(frame.centreY) * p.y + direction * (frame.spacing * total);
    const double nearLayers =
        (std::abs(frame.sphereCentre.z) + frame.nearDepth) / frame.spacing * 0x1p-21;
    return {terms * 0x1p-22, 2.0 * total * 0x1p-21 * ray.layerLengthMm,
            nearLayers * ray.layerLengthMm};
}

} // namespace

ExpectedPicture expectedFromSamples(const Exhibit& exhibit, const FramePlan& plan) {
    const ReferencePicture reference(exhibit.scene, plan, exhibit.view, exhibit.viewport());
    return perPixel<PixelReference>(exhibit,
                                    [&](glm::dvec2 fragCoord) { return reference.at(fragCoord); });
}

ExpectedPicture expectedOfUniform(const Exhibit& exhibit, const FramePlan& plan,
                                  double extinctionPerMm, glm::dvec3 color) {
    const RayFrame frame =
        makeRayFrame(exhibit.view, exhibit.viewport(), exhibit.scene.geometry(), plan.lattice);
    // Every layer's opacity is off by 2^-22, its place in the sum by as much.
    const double layers = plan.lattice.total * 0x1p-21;
    // A baked one is rounded to fp16: by 2^-12 of itself, which is of its depth as much and the
    // more the denser a layer is.
    const double layerDepth = extinctionPerMm * plan.lattice.spacingMm;
    const double baked = plan.variant.lengths == Lengths::Baked
                             ? 0x1p-12 * std::expm1(layerDepth) / layerDepth
                             : 0.0;
    return perPixel<PixelReference>(exhibit, [&](glm::dvec2 fragCoord) {
        const EyeRay ray =
            eyeRayOf(exhibit.view, exhibit.viewport(), exhibit.scene.geometry(), fragCoord);
        const RayError error = rayError(frame, rayAt(frame, fragCoord), fragCoord);
        const double near = exhibit.view.nearDepth / ray.cosine;
        const auto alphaOf = [&](double chord) {
            return 1.0 - std::exp(-extinctionPerMm * std::max(0.0, chord));
        };
        const double alpha = alphaOf(chordMm(ray, near, glm::dvec3(0.0)));
        const double least =
            alphaOf(chordMm(ray, near + error.nearMm, -error.uvw) - error.lengthMm);
        const double longest = chordMm(ray, near - error.nearMm, error.uvw);
        const double most = longest > 0.0 ? alphaOf(longest + error.lengthMm) : 0.0;
        const double depth = extinctionPerMm * std::max(0.0, longest);
        const double bound =
            std::max(most - alpha, alpha - least) + baked * depth * std::exp(-depth);
        return PixelReference{glm::dvec4(color * alpha, alpha),
                              longest > 0.0 ? bound + layers : 0.0, false};
    });
}

ExpectedPicture expectedFromIntegral(const Exhibit& exhibit, const FramePlan& plan) {
    SLABCAST_EXPECTS(exhibit.columnStride == 1, exhibit.columnStride);
    ExpectedPicture expected = expectedFromSamples(exhibit, plan);
    const std::vector<glm::dvec4> truth =
        continuousPicture(exhibit.scene, exhibit.view, exhibit.size);
    const SamplingBound bound(exhibit.scene, SamplingBound::By::Table);
    const std::vector<double> sampling = perPixel<double>(exhibit, [&](glm::dvec2 fragCoord) {
        return bound.ofSampling(
            eyeRayOf(exhibit.view, exhibit.viewport(), exhibit.scene.geometry(), fragCoord),
            plan.lattice, 0.0);
    });
    for (std::size_t i = 0; i < expected.size(); ++i) {
        expected[i] = {truth[i], expected[i].bound + sampling[i], expected[i].atEdge};
    }
    return expected;
}

std::vector<double> blendingBounds(const Exhibit& exhibit, const FramePlan& plan,
                                   double extinctionPerMm) {
    const RayFrame frame =
        makeRayFrame(exhibit.view, exhibit.viewport(), exhibit.scene.geometry(), plan.lattice);
    return perPixel<double>(exhibit, [&](glm::dvec2 fragCoord) {
        const LatticeRay ray = rayAt(frame, fragCoord);
        const LayerRange range = layersOf(ray, plan.lattice.total);
        const double depthPerLayer = extinctionPerMm * ray.layerLengthMm;
        // A layer more at either end: rounding may let the ray meet it.
        const int first = std::max(0, range.begin - 1) / plan.layersPerPlane;
        const int last = std::min(plan.lattice.total - 1, range.end) / plan.layersPerPlane;
        double sum = 0.0;
        for (int plane = first; plane <= last; ++plane) {
            const double inFront =
                plane * double(plan.layersPerPlane) - plan.lattice.total / 2.0 - ray.entry;
            const double seen = std::exp(-depthPerLayer * std::max(0.0, inFront - 1.0));
            sum +=
                (plane == last ? roundingOfDeepest(plan.target) : roundingPerPlane(plan.target)) *
                seen;
        }
        return sum;
    });
}

Verdict judge(const Exhibit& exhibit, const Picture& picture, const ExpectedPicture& expected,
              const std::vector<double>& blending) {
    Verdict verdict;
    const int columns = exhibit.columns();
    for (std::size_t i = 0; i < expected.size(); ++i) {
        const PixelReference& meant = expected[i];
        const double bound = meant.bound + blending[i];
        if (meant.atEdge || bound >= 1.0) {
            continue;
        }
        const std::size_t row = i / columns;
        const std::size_t column = i % columns * exhibit.columnStride;
        const glm::dvec4 pixel(picture.pixels[row * exhibit.size.x + column]);
        const glm::dvec4 off = glm::abs(pixel - meant.color);
        const double most = std::max({off.x, off.y, off.z, off.w});
        const double share = most == 0.0 ? 0.0 : most / bound;
        verdict.share = share <= verdict.share ? verdict.share : share; // NaN stays
        ++verdict.judged;
        verdict.lit += meant.color.a > bound; // black would fail
    }
    return verdict;
}

int differingPixels(const Picture& a, const Picture& b) {
    SLABCAST_EXPECTS(a.size == b.size, a.size.x);
    int count = 0;
    for (std::size_t i = 0; i < a.pixels.size(); ++i) {
        count += std::memcmp(&a.pixels[i], &b.pixels[i], sizeof a.pixels[i]) != 0;
    }
    return count;
}

int nonFiniteComponents(const Picture& picture) {
    int count = 0;
    for (const glm::vec4& pixel : picture.pixels) {
        for (int k = 0; k < 4; ++k) {
            count += !std::isfinite(pixel[k]);
        }
    }
    return count;
}

} // namespace slabcast::stability
