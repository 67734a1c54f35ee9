#include "core/reference/discrete.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/parallel.h"
#include "core/reference/material.h"
#include "core/transfer/transfer_integral.h"
#include "core/volume/trilinear_field.h"

namespace slabcast {

namespace {

glm::dvec4 materialOf(const TransferTable& table, CompositingSpace /*space*/, double value) {
    return lookUp(table, value);
}

/// Blinn-Phong under a head light: the half vector is the direction to the eye itself.
class HeadLight {
public:
    HeadLight(const ShadingParameters& parameters, const VolumeGeometry& geometry,
              const NormalTexels* normals)
        : parameters_(parameters), modelFromUvw_(geometry.modelFromUvw()),
          modelFromUvwCovector_(glm::transpose(glm::dmat3(geometry.uvwFromModel()))),
          normals_(normals) {}

    template <class Field>
    glm::dvec3 shade(glm::dvec3 color, const Field& field, glm::dvec3 uvw, glm::dvec3 step) const {
        const glm::dvec4 found = gradientAt(field, uvw);
        const double weight = shadingWeight(parameters_, found.w);
        const glm::dvec3 gradient(found);
        const double length = glm::length(gradient);
        if (weight == 0.0) {
            return color;
        }
        const glm::dvec3 alongRay = glm::normalize(modelFromUvw_ * step);
        const double facing = length > 0.0 ? std::abs(glm::dot(gradient, alongRay)) / length : 0.0;
        const glm::dvec3 lit = color * diffuseLight(parameters_, facing) +
                               parameters_.specular * std::pow(facing, parameters_.shininess);
        return glm::mix(color, glm::min(lit, glm::dvec3(1.0)), weight);
    }

private:
    /// In patient space: a direction of any length, and the steepness per mm.
    template <class Field>
    glm::dvec4 gradientAt(const Field& field, glm::dvec3 uvw) const {
        if (normals_ != nullptr) {
            const glm::dvec4 texel = normals_->at(uvw);
            return {glm::dvec3(texel), normals_->steepnessPerMm(texel)};
        }
        const glm::dvec3 gradient = modelFromUvwCovector_ * uvwGradient(field, uvw);
        return {gradient, glm::length(gradient)};
    }

    ShadingParameters parameters_;
    glm::dmat3 modelFromUvw_;
    glm::dmat3 modelFromUvwCovector_; // gradients transform by the inverse transpose
    const NormalTexels* normals_;     // null: the field's own gradients
};

/// A layer of a ray.
struct Layer {
    const LatticeRay& ray;
    int total;
    int index;

    double lengthMm() const { return layerWeight(ray, total, index) * ray.layerLengthMm; }
    glm::dvec3 middle() const { return samplePosition(ray, total, index); }
    glm::dvec3 front() const { return end(index); }
    glm::dvec3 back() const { return end(index + 1); }

private:
    glm::dvec3 end(int boundary) const {
        return ray.centre + std::clamp(boundary - total / 2.0, ray.entry, ray.exit) * ray.step;
    }
};

// What makes a layer's premultiplied colour of it: one class for each kind of classification.

template <class Field, class Transfer>
struct PostClassified {
    const Field& field;
    const Transfer& transfer;
    CompositingSpace space;
    std::optional<HeadLight> light;

    glm::dvec4 operator()(const Layer& layer) const {
        const glm::dvec3 uvw = layer.middle();
        const glm::dvec4 material = materialOf(transfer, space, field.at(uvw));
        const double alpha = -std::expm1(-material.w * layer.lengthMm());
        if (alpha == 0.0) {
            return glm::dvec4(0.0);
        }
        const glm::dvec3 color(material);
        return {(light ? light->shade(color, field, uvw, layer.ray.step) : color) * alpha, alpha};
    }
};

/// Filters the colours of the eight voxels around a sample. `colorsAround(cell)` gives them in the
/// order of TrilinearField::cornersOf().
template <class ColorsAround>
struct PreClassified {
    glm::dvec3 dims;
    double referenceLengthMm;
    ColorsAround colorsAround;

    glm::dvec4 operator()(const Layer& layer) const {
        const glm::dvec4 texel = filteredTexels(dims, layer.middle(), colorsAround);
        if (texel.w == 0.0) {
            return glm::dvec4(0.0);
        }
        const double depth =
            -std::log(std::max(1.0 - texel.w, 1e-30)) * (layer.lengthMm() / referenceLengthMm);
        const double alpha = -std::expm1(-depth);
        return {glm::dvec3(texel) * (alpha / texel.w), alpha};
    }
};

/// `mean(front, back)`: (extinction x colour, extinction).
template <class Field, class Mean>
struct PreIntegrated {
    const Field& field;
    Mean mean;

    glm::dvec4 operator()(const Layer& layer) const {
        const glm::dvec4 between = mean(field.at(layer.front()), field.at(layer.back()));
        const double alpha = -std::expm1(-between.w * layer.lengthMm());
        return alpha == 0.0 ? glm::dvec4(0.0)
                            : glm::dvec4(glm::dvec3(between) * (alpha / between.w), alpha);
    }
};

/// From an input's transfer to what classifies its layers.
template <class Field>
struct Classifiers {
    const DiscreteInput& input;
    const Field& field;

    template <class Transfer> // the continuous TF or its table
    auto of(const Transfer& transfer) const {
        const auto light =
            input.shading ? std::optional(HeadLight(*input.shading, input.geometry, input.normals))
                          : std::nullopt;
        return PostClassified<Field, Transfer>{field, transfer, input.space, light};
    }
    auto of(const PreclassifiedExact& exact) const {
        const auto colorOf = [this, &exact](double value) {
            const glm::dvec4 material = materialOf(exact.tf, input.space, value);
            const double alpha = -std::expm1(-material.w * exact.referenceLengthMm);
            return glm::dvec4(glm::dvec3(material) * alpha, alpha);
        };
        return preClassified(exact.referenceLengthMm, [this, colorOf](glm::ivec3 cell) {
            const std::array<double, 8> values = field.cornersOf(cell);
            std::array<glm::dvec4, 8> colors;
            std::transform(values.begin(), values.end(), colors.begin(), colorOf);
            return colors;
        });
    }
    auto of(const ClassifiedTexels* classified) const {
        SLABCAST_EXPECTS(classified != nullptr && classified->dims == input.texels->dims, 0);
        return preClassified(classified->referenceLengthMm, [classified](glm::ivec3 cell) {
            std::array<glm::dvec4, 8> colors =
                texelsAround(classified->texels, classified->dims, cell);
            for (glm::dvec4& color : colors) {
                color /= 255.0;
            }
            return colors;
        });
    }
    auto of(const PreintegratedExact& exact) const {
        return preIntegrated([integral = TransferIntegral(exact.tf, input.space)](
                                 double front, double back) { return integral.mean(front, back); });
    }
    auto of(const PreintegratedTable& table) const {
        return preIntegrated(
            [&table](double front, double back) { return lookUp(table, front, back); });
    }

private:
    template <class ColorsAround>
    auto preClassified(double referenceLengthMm, ColorsAround colorsAround) const {
        return PreClassified<ColorsAround>{field.dims(), referenceLengthMm, colorsAround};
    }
    template <class Mean>
    auto preIntegrated(Mean mean) const {
        return PreIntegrated<Field, Mean>{field, std::move(mean)};
    }
};

template <class Classifier>
glm::dvec4 compositeRay(const LatticeRay& ray, int total, const Classifier& classified) {
    const LayerRange layers = layersOf(ray, total);
    glm::dvec4 sum(0.0);
    for (int i = layers.begin; i < layers.end; ++i) {
        sum += (1.0 - sum.w) * classified(Layer{ray, total, i});
    }
    return sum;
}

} // namespace

std::vector<glm::dvec4> renderDiscrete(const DiscreteInput& input) {
    SLABCAST_EXPECTS(input.texels != nullptr && !input.texels->data.empty(), 0);
    const Viewport& viewport = input.viewport;
    SLABCAST_EXPECTS(viewport.width > 0 && viewport.height > 0, viewport.width);
    const std::size_t kind = input.transfer.index();
    SLABCAST_EXPECTS(!input.shading || kind < 2, kind); // only post-classified samples are lit
    const RayFrame frame = makeRayFrame(input.view, viewport, input.geometry, input.lattice);
    std::vector<glm::dvec4> pixels(static_cast<std::size_t>(viewport.width) * viewport.height);
    const auto renderWith = [&](const auto& classifier) {
        const auto renderRange = [&](std::int64_t begin, std::int64_t end) {
            for (std::int64_t i = begin; i < end; ++i) {
                const glm::dvec2 corner(viewport.x + i % viewport.width,
                                        viewport.y + i / viewport.width);
                pixels[static_cast<std::size_t>(i)] =
                    compositeRay(rayAt(frame, corner + 0.5), input.lattice.total, classifier);
            }
        };
        parallelFor(static_cast<std::int64_t>(pixels.size()), viewport.width, renderRange);
    };
    visitTexelFormat(input.texels->format, [&](auto codec) {
        const TrilinearField field(*input.texels, codec);
        const Classifiers<decltype(field)> classifiers{input, field};
        std::visit([&](const auto& transfer) { renderWith(classifiers.of(transfer)); },
                   input.transfer);
    });
    return pixels;
}

} // namespace slabcast
