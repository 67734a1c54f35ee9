#include "core/reference/formula_ray.h"

#include <cmath>

#include "core/reference/gauss_kronrod.h"
#include "core/reference/material.h"

namespace slabcast {

namespace {

glm::dvec4 materialAt(const FormulaInput& input, glm::dvec3 uvw) {
    const double value = input.field(glm::clamp(uvw, 0.0, 1.0));
    return materialOf(input.tf, CompositingSpace::Display, value);
}

/// How opaque a layer of this extinction and length is, by the rule.
double layerAlpha(RayRule::Opacity opacity, double extinctionPerMm, double lengthMm,
                  double unitMm) {
    const double ofUnit = -std::expm1(-extinctionPerMm * unitMm);
    switch (opacity) {
    case RayRule::Opacity::Linear:
        return std::min(1.0, ofUnit * lengthMm / unitMm);
    case RayRule::Opacity::Uncorrected:
        return ofUnit;
    case RayRule::Opacity::PerLength:
        break;
    }
    return -std::expm1(-extinctionPerMm * lengthMm);
}

} // namespace

glm::dvec4 integrateFormula(const FormulaInput& input, const LatticeRay& ray, int pieces) {
    SLABCAST_EXPECTS(pieces > 0, pieces);
    if (!(ray.entry < ray.exit)) {
        return glm::dvec4(0.0);
    }
    const GaussKronrod& rule = kGaussKronrod;
    const double piece = (ray.exit - ray.entry) / pieces;
    const double lengthMm = piece * ray.layerLengthMm;
    double depth = 0.0;
    glm::dvec3 color(0.0);
    for (int k = 0; k < pieces; ++k) {
        std::array<glm::dvec4, GaussKronrod::kNodes> material;
        for (std::size_t i = 0; i < GaussKronrod::kNodes; ++i) {
            const double offset = ray.entry + (k + rule.nodes[i]) * piece;
            material[i] = materialAt(input, ray.centre + offset * ray.step);
        }
        double inPiece = 0.0;
        for (std::size_t i = 0; i < GaussKronrod::kNodes; ++i) {
            double before = 0.0;
            for (std::size_t j = 0; j < GaussKronrod::kNodes; ++j) {
                before += rule.integralTo[j][i] * material[j].w;
            }
            const double reaches = std::exp(-depth - before * lengthMm);
            color += rule.weights[i] * lengthMm * material[i].w * reaches * glm::dvec3(material[i]);
            inPiece += rule.weights[i] * material[i].w;
        }
        depth += inPiece * lengthMm;
    }
    return {color, -std::expm1(-depth)};
}

const std::vector<RayRule>& rayRules() {
    using Opacity = RayRule::Opacity;
    static const std::vector<RayRule> rules{
        RayRule{},
        {.name = "front ends",
         .order = 1.0,
         .why = "samples at the front end of each layer are half a layer early: order 1",
         .place = 0.0},
        {.name = "unweighted ends",
         .order = 1.0,
         .why = "the layers that stick out of the box count in full, half a layer too much at "
                "either end: order 1",
         .weightedEnds = false},
        {.name = "no opacity correction",
         .order = 0.0,
         .why = "every layer has the opacity of the reference length however thin it is: the "
                "picture turns opaque, order 0",
         .opacity = Opacity::Uncorrected},
        {.name = "linear opacity",
         .order = 0.0,
         .why = "opacity is scaled by the length instead of 1 - (1 - a)^length: it converges to "
                "another picture, order 0 against the truth",
         .opacity = Opacity::Linear},
        {.name = "back over front",
         .order = 0.0,
         .why = "each layer is blended over those in front of it: the picture from behind, order 0",
         .nearOverFar = false}};
    return rules;
}

glm::dvec4 sampleFormula(const FormulaInput& input, const LatticeRay& ray, int total,
                         const RayRule& rule) {
    const LayerRange layers = layersOf(ray, total);
    glm::dvec4 sum(0.0);
    for (int i = layers.begin; i < layers.end; ++i) {
        const double part = rule.weightedEnds ? layerWeight(ray, total, i) : 1.0;
        const glm::dvec3 uvw = ray.centre + (i - total / 2.0 + rule.place) * ray.step;
        const glm::dvec4 material = materialAt(input, uvw);
        const double alpha =
            layerAlpha(rule.opacity, material.w, part * ray.layerLengthMm, input.tf.opacityUnitMm);
        const glm::dvec4 layer(glm::dvec3(material) * alpha, alpha);
        sum = rule.nearOverFar ? sum + (1.0 - sum.w) * layer : layer + (1.0 - alpha) * sum;
    }
    return sum;
}

} // namespace slabcast
