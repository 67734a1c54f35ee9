#pragma once

#include <glm/glm.hpp>

#include "core/view/view.h"
#include "core/volume/volume.h"

namespace slabcast {

/// Where the layers lie. Planar: equal view depth. Shells: equal distance from the eye.
enum class LatticeKind : std::uint8_t { Planar, Shells };

const char* name(LatticeKind kind);

/// `total` layers of `spacingMm`, centred on the bounding sphere's centre. Layer i in [0, total)
/// holds the offsets [i - total/2, i + 1 - total/2) in layers from the centre and is sampled in its
/// middle. How the layers are dealt out to planes is not part of it: the ratio never moves a
/// sample. Tested by: lattice_test.cpp
struct Lattice {
    LatticeKind kind = LatticeKind::Planar;
    int total = 0;
    double spacingMm = 0.0;
    bool jittered = false; // each ray's layers are moved by jitterOf() its pixel

    bool operator==(const Lattice&) const = default;
};

/// Fewest layers that cover the sphere at a spacing: ceil(2 radius / spacing), at least 1, at most
/// 2^22 (beyond which float32 no longer counts half layers).
int layersToCover(double radiusMm, double spacingMm);

/// Offset of a ray's lattice in layers, in [-1/2, 1/2): interleaved gradient noise, in integers so
/// that every device and the references agree to the last bit. Neighbouring pixels differ much, 3x3
/// blocks hold about every ninth: what banding a coarse lattice would show becomes fine grain.
/// `pixel`: counted from the viewport's lower left. Source: Jimenez 2014, "Next Generation Post
/// Processing in Call of Duty: Advanced Warfare".
double jitterOf(glm::ivec2 pixel);

/// What every pixel's ray is made from: affine in the pixel's position, in float64. The one source
/// of the shaders' uniforms and of the float64 references. With p = fragCoord - viewportCentre:
/// centre(p) = centre0 + centreX p.x + centreY p.y is where the ray crosses the depth of the
/// sphere's centre, direction(p) likewise its change per unit of depth, both in uvw.
struct RayFrame {
    glm::dvec3 centre0, centreX, centreY;
    glm::dvec3 direction0, directionX, directionY;
    glm::dvec2 tangent0, tangentPerPixel; // (x, y)/depth of the ray
    glm::dvec2 viewportCentre;
    glm::dvec2 viewportCorner; // lower left
    glm::dvec3 sphereCentre;   // (x, y, depth) in view space
    double sphereDistance;     // from the eye
    double radius;             // of the sphere, view units
    double spacing;            // of the layers, view units
    double nearDepth;
    double mmPerViewUnit;
    Lattice lattice;
};

RayFrame makeRayFrame(const View& view, const Viewport& viewport, const VolumeGeometry& geometry,
                      const Lattice& lattice);

/// Whether all layers of all rays lie beyond the eye and the near plane, whatever the volume.
bool liesBeyondNear(const RayFrame& frame, const Frustum& frustum);

/// One ray in units of layers: at offset o from the lattice's centre it is at centre + o * step
/// (uvw).
struct LatticeRay {
    glm::dvec3 centre;
    glm::dvec3 step;
    double layerLengthMm; // along this ray
    double entry; // offsets at which the ray enters and leaves box and near plane; entry >= exit:
                  // misses
    double exit;
};

/// `fragCoord` as gl_FragCoord: pixel centres at half integers, relative to the target.
LatticeRay rayAt(const RayFrame& frame, glm::dvec2 fragCoord);

/// Half-open range of layer indices.
struct LayerRange {
    int begin = 0;
    int end = 0;
};

/// The layers of [0, total) that meet the ray's part inside.
LayerRange layersOf(const LatticeRay& ray, int total);

/// Part of layer `index` that lies inside, in [0, 1]: its sample counts for that length.
double layerWeight(const LatticeRay& ray, int total, int index);

/// uvw of the layer's sample.
glm::dvec3 samplePosition(const LatticeRay& ray, int total, int index);

} // namespace slabcast
