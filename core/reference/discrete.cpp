#include "core/reference/discrete.h"

#include <algorithm>
#include <cmath>

#include "core/base/parallel.h"
#include "core/reference/material.h"
#include "core/reference/trilinear_field.h"

namespace slabcast {

namespace {

glm::dvec4 materialOf(const TransferTable& table, CompositingSpace /*space*/, double value) {
    return lookUp(table, value);
}

/// Blinn-Phong under a head light: the half vector is the direction to the eye itself.
class HeadLight {
public:
    HeadLight(const ShadingParameters& parameters, const VolumeGeometry& geometry)
        : parameters_(parameters), modelFromUvw_(geometry.modelFromUvw()),
          modelFromUvwCovector_(glm::transpose(glm::dmat3(geometry.uvwFromModel()))) {}

    template <class Field>
    glm::dvec3 shade(glm::dvec3 color, const Field& field, glm::dvec3 uvw, glm::dvec3 step) const {
        const glm::dvec3 gradient = modelFromUvwCovector_ * uvwGradient(field, uvw);
        const double steepness = glm::length(gradient);
        const double weight = shadingWeight(parameters_, steepness);
        if (weight == 0.0) {
            return color;
        }
        const glm::dvec3 alongRay = glm::normalize(modelFromUvw_ * step);
        const double facing = std::abs(glm::dot(gradient, alongRay)) / steepness;
        const glm::dvec3 lit = color * diffuseLight(parameters_, facing) +
                               parameters_.specular * std::pow(facing, parameters_.shininess);
        return glm::mix(color, glm::min(lit, glm::dvec3(1.0)), weight);
    }

private:
    template <class Field>
    static glm::dvec3 uvwGradient(const Field& field, glm::dvec3 uvw) {
        glm::dvec3 gradient;
        for (int axis = 0; axis < 3; ++axis) {
            glm::dvec3 half(0.0);
            half[axis] = 0.5 / field.dims()[axis];
            gradient[axis] = (field.at(uvw + half) - field.at(uvw - half)) * field.dims()[axis];
        }
        return gradient;
    }

    ShadingParameters parameters_;
    glm::dmat3 modelFromUvw_;
    glm::dmat3 modelFromUvwCovector_; // gradients transform by the inverse transpose
};

template <class Field, class Transfer>
glm::dvec4 compositeRay(const LatticeRay& ray, const DiscreteInput& input, const Field& field,
                        const Transfer& transfer, const std::optional<HeadLight>& light) {
    const int total = input.lattice.total;
    const LayerRange layers = layersOf(ray, total);
    glm::dvec4 sum(0.0);
    for (int i = layers.begin; i < layers.end; ++i) {
        const glm::dvec3 uvw = samplePosition(ray, total, i);
        const glm::dvec4 material = materialOf(transfer, input.space, field.at(uvw));
        const double lengthMm = layerWeight(ray, total, i) * ray.layerLengthMm;
        const double alpha = -std::expm1(-material.w * lengthMm);
        if (alpha > 0.0) {
            const glm::dvec3 color(material);
            const glm::dvec3 lit = light ? light->shade(color, field, uvw, ray.step) : color;
            sum += (1.0 - sum.w) * glm::dvec4(lit * alpha, alpha);
        }
    }
    return sum;
}

} // namespace

std::vector<glm::dvec4> renderDiscrete(const DiscreteInput& input) {
    SLABCAST_EXPECTS(input.texels != nullptr && !input.texels->data.empty(), 0);
    const Viewport& viewport = input.viewport;
    SLABCAST_EXPECTS(viewport.width > 0 && viewport.height > 0, viewport.width);
    const RayFrame frame = makeRayFrame(input.view, viewport, input.geometry, input.lattice);
    const std::optional<HeadLight> light =
        input.shading ? std::optional(HeadLight(*input.shading, input.geometry)) : std::nullopt;
    std::vector<glm::dvec4> pixels(static_cast<std::size_t>(viewport.width) * viewport.height);
    visitTexelFormat(input.texels->format, [&](auto codec) {
        const TrilinearField field(*input.texels, codec);
        const auto renderWith = [&](const auto& transfer) {
            parallelFor(static_cast<std::int64_t>(pixels.size()), viewport.width,
                        [&](std::int64_t begin, std::int64_t end) {
                            for (std::int64_t i = begin; i < end; ++i) {
                                const glm::dvec2 corner(viewport.x + i % viewport.width,
                                                        viewport.y + i / viewport.width);
                                pixels[static_cast<std::size_t>(i)] = compositeRay(
                                    rayAt(frame, corner + 0.5), input, field, transfer, light);
                            }
                        });
        };
        std::visit(renderWith, input.transfer);
    });
    return pixels;
}

} // namespace slabcast
