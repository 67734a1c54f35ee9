#include "core/reference/continuous.h"

#include <algorithm>
#include <mutex>

#include "core/reference/cell_walk.h"
#include "core/reference/emission_integral.h"
#include "core/reference/stretches.h"
#include "core/volume/trilinear_field.h"

namespace slabcast {
namespace {

constexpr std::int64_t kPixelsAtOnce = 128;

/// A frame of a single layer: the ray's own coordinate, in diameters of the bounding sphere.
RayFrame frameOf(const ContinuousInput& input) {
    SLABCAST_EXPECTS(input.texels != nullptr && !input.texels->data.empty(), 0);
    SLABCAST_EXPECTS(input.viewport.width > 0 && input.viewport.height > 0, input.viewport.width);
    SLABCAST_EXPECTS(input.tolerance > 0.0, input.tolerance);
    const double diameterMm = 2.0 * input.geometry.boundingSphere().radiusMm;
    const Lattice whole{.kind = LatticeKind::Planar, .total = 1, .spacingMm = diameterMm};
    return makeRayFrame(input.view, input.viewport, input.geometry, whole);
}

template <class Field>
glm::dvec4 integrate(const LatticeRay& ray, const Field& field, const TransferRamps& ramps,
                     const ContinuousInput& input) {
    EmissionIntegral integral(input.tf.opacityUnitMm, input.space, input.tolerance);
    walkCells(ray, input.texels->dims,
              [&](glm::ivec3 cell, glm::dvec3 from, glm::dvec3 to, double layers) {
                  const std::array<double, 8> corners = field.cornersOf(cell);
                  const auto [low, high] = std::minmax_element(corners.begin(), corners.end());
                  if (ramps.anyVisible(ramps.holding(*low), ramps.holding(*high))) {
                      const double lengthMm = layers * ray.layerLengthMm;
                      visitStretches(
                          fieldAlong(corners, from, to), ramps,
                          [&](const TransferRamp& ramp, const Cubic& share, double part) {
                              integral.add(ramp, share, part * lengthMm);
                          });
                  }
                  return !integral.isOpaque();
              });
    return integral.premultiplied();
}

/// Counts what is done and reports it, one thread at a time.
class ProgressCount {
public:
    ProgressCount(const ReferenceProgress& report, std::int64_t total)
        : report_(report), total_(static_cast<double>(total)) {}

    void add(std::int64_t done) {
        if (report_) {
            const std::lock_guard lock(mutex_);
            done_ += done;
            report_(static_cast<double>(done_) / total_);
        }
    }

private:
    const ReferenceProgress& report_;
    double total_;
    std::mutex mutex_;
    std::int64_t done_ = 0;
};

} // namespace

std::vector<glm::dvec4> renderContinuous(const ContinuousInput& input,
                                         const ReferenceProgress& progress,
                                         const CancelToken* cancel) {
    const RayFrame frame = frameOf(input);
    const TransferRamps ramps(input.tf, input.space);
    const Viewport& viewport = input.viewport;
    const std::int64_t count = std::int64_t{viewport.width} * viewport.height;
    std::vector<glm::dvec4> pixels(static_cast<std::size_t>(count));
    ProgressCount counter(progress, count);
    const bool complete = visitTexelFormat(input.texels->format, [&](auto codec) {
        const TrilinearField field(*input.texels, codec);
        const auto integratePixels = [&](std::int64_t begin, std::int64_t end) {
            for (std::int64_t i = begin; i < end; ++i) {
                const glm::dvec2 corner(viewport.x + static_cast<double>(i % viewport.width),
                                        viewport.y + static_cast<double>(i / viewport.width));
                pixels[static_cast<std::size_t>(i)] =
                    integrate(rayAt(frame, corner + 0.5), field, ramps, input);
            }
            counter.add(end - begin);
        };
        return parallelFor(count, kPixelsAtOnce, integratePixels, cancel);
    });
    return complete ? pixels : std::vector<glm::dvec4>();
}

glm::dvec4 integrateRay(const ContinuousInput& input, glm::dvec2 fragCoord) {
    const LatticeRay ray = rayAt(frameOf(input), fragCoord);
    const TransferRamps ramps(input.tf, input.space);
    return visitTexelFormat(input.texels->format, [&](auto codec) {
        return integrate(ray, TrilinearField(*input.texels, codec), ramps, input);
    });
}

} // namespace slabcast
