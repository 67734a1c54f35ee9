#pragma once

#include <functional>

#include "core/scene/scene.h"
#include "core/view/view.h"

namespace slabcast::stability {

/// A pixel's ray by what it is: a straight line from the eye. Deliberately not made from the
/// renderer's own frame of rays.
struct EyeRay {
    glm::dvec3 eyeUvw{0.0};
    glm::dvec3 uvwPerMm{0.0};
    double cosine = 1.0;        // of the angle to the view axis
    double centreDepthMm = 0.0; // of the bounding sphere's centre
    double centreDistanceMm = 0.0;
    double entryMm = 0.0; // where it is inside the box; entry >= exit: misses
    double exitMm = 0.0;
};

/// `view` without scale: view units are mm.
EyeRay eyeRayOf(const View& view, const Viewport& viewport, const VolumeGeometry& geometry,
                glm::dvec2 fragCoord);

/// A layer's place along a ray, mm from the eye: planar layers at equal depths, shells at equal
/// distances.
struct LayerPlace {
    double begin, middle, end;
};
LayerPlace placeOf(const EyeRay& ray, const Lattice& lattice, int layer, double jitter);

/// How far samples may put a pixel from the integral, from the field along its ray alone. With all
/// colours in [0, 1], a layer whose opacity is off by a and whose colour by c moves the pixel by at
/// most T (a + alpha c), T being what the layers before it let through: layers are replaced one
/// after the other, and the rest of the pixel is the same before and after. One part is an
/// estimate: the field's extremes along a stretch are those of a few places on it, widened by half
/// of the largest step between neighbours, which a cubic within a cell may in principle exceed.
class SamplingBound {
public:
    /// How samples are classified: by the continuous TF, or by the table as a device holds it.
    enum class By { Transfer, Table };
    /// Of unlit, post-classified scenes in display space.
    SamplingBound(const Scene& scene, By by);

    /// Between the samples' sum and the integral: each layer stands for its length by the material
    /// in its middle, and the TF's material in the layer is within its extremes there.
    double ofSampling(const EyeRay& ray, const Lattice& lattice, double jitter) const;

    /// Between the sums of one ray seen in two views, whose lattices move its samples from the one
    /// place to the other: the material is within its extremes along the way. Not jittered.
    double ofMotion(const EyeRay& before, const EyeRay& after, const Lattice& lattice) const;

private:
    /// Extremes over a range of values.
    struct Materials {
        double extinctionLow, extinctionHigh; // 1/mm
        glm::dvec3 colorLow, colorHigh;
    };
    struct Range {
        double low, high;
    };
    Materials meant(Range values) const;   // by the TF
    Materials sampled(Range values) const; // as samples are classified
    Range valuesAlong(const EyeRay& ray, double fromMm, double toMm, int parts) const;
    double valueAt(const EyeRay& ray, double mm) const;

    std::function<double(glm::dvec3 uvw)> field_;
    const TransferFunction& tf_;
    const TransferTable* table_ = nullptr;
};

} // namespace slabcast::stability
