#pragma once

#include <vector>

#include <glm/glm.hpp>

#include "core/scene/scene.h"
#include "core/view/view.h"

namespace slabcast {

/// A pixel in float64 and what a device may differ by, from the definitions alone.
struct PixelReference {
    glm::dvec4 color{0.0}; // premultiplied
    double bound = 0.0;    // classification and arithmetic; blending comes on top
    bool atEdge = false;   // the ray grazes the box: whether it meets it is a matter of rounding
};

/// Walks one ray front to back over the plan's lattice. Beside the sum it carries a bound: a layer
/// whose premultiplied colour may be off by p and whose opacity by a moves the pixel by at most T
/// (p + a), T being the largest transmittance in front of it. p and a are the spread of the
/// classification over what the field, the table and the length may be: the exact ones, give or
/// take the texture unit's filter (1/256 of the cell's range per axis and one step of the format),
/// float32 positions (2^-22 of the terms that they are summed from) and the table's own weights.
class ReferencePicture {
public:
    ReferencePicture(const Scene& scene, const FramePlan& plan, const View& view,
                     const Viewport& viewport);
    PixelReference at(glm::dvec2 fragCoord) const;

private:
    struct Ray;
    struct Layer;
    struct Field {
        double value, error;
    };
    /// Direction of any length, and steepness per mm.
    struct Gradient {
        glm::dvec3 direction;
        double directionError, steepness, steepnessError;
    };
    Ray rayOf(glm::dvec2 fragCoord) const;
    Field fieldAt(glm::dvec3 uvw, glm::dvec3 uvwError) const;
    Layer classified(int index, const Ray& ray, glm::dvec3 lengths) const;
    Layer postClassified(glm::dvec3 uvw, const Ray& ray, glm::dvec3 lengths) const;
    Layer preClassified(glm::dvec3 uvw, const Ray& ray, glm::dvec3 lengths) const;
    Layer preIntegrated(int index, const Ray& ray, glm::dvec3 lengths) const;
    Gradient computedGradient(glm::dvec3 uvw, const Ray& ray) const;
    Gradient bakedGradient(glm::dvec3 uvw, const Ray& ray) const;
    void shade(glm::dvec3& color, double& error, glm::dvec3 uvw, const Ray& ray) const;

    const Scene& scene_;
    FramePlan plan_;
    RayFrame frame_;
    std::vector<double> values_; // of all voxels
};

/// What one plane's blending may add. fp16's steps are 2^-11 at most below 1, and GL lets a device
/// take either neighbour. 8 bits hold colour, opacity and the opacity's product with what is
/// behind, and a device may round each to the nearest step; of the deepest plane only the colour.
double roundingPerPlane(TargetFormat target);
double roundingOfDeepest(TargetFormat target);
/// Of all planes.
double blendingBound(const FramePlan& plan);

} // namespace slabcast
