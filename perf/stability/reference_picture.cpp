#include "perf/stability/reference_picture.h"

#include <algorithm>
#include <cmath>

namespace slabcast {

namespace {

/// Low, meant and high value of what is not exactly known, as x, y and z.
glm::dvec3 around(double value, double error) {
    return {value - error, value, value + error};
}

double spread(glm::dvec3 range) {
    return std::max(range.y - range.x, range.z - range.y);
}

struct TableSpread {
    glm::dvec4 value;
    glm::dvec4 error;
};

/// The table at a value that may be off by `error`, and by what the texture unit's weights add.
TableSpread lookUpAround(const TransferTable& table, double value, double error) {
    const double last = double(table.texels.size()) - 1.0;
    const double texel = (table.lastValue - table.firstValue) / last;
    const double reach = error + texel * (1.0 / 256.0 + last * 0x1p-22);
    TableSpread result{lookUp(table, value), glm::dvec4(0.0)};
    const auto include = [&](const glm::dvec4& other) {
        result.error = glm::max(result.error, glm::abs(other - result.value));
    };
    include(lookUp(table, value - reach));
    include(lookUp(table, value + reach));
    const auto texelAt = [&](double v) {
        return std::clamp((v - table.firstValue) / texel, 0.0, last);
    };
    for (double k = std::ceil(texelAt(value - reach)); k <= texelAt(value + reach); k += 1.0) {
        include(lookUp(table, table.firstValue + k * texel));
    }
    return result;
}

/// A value that may be off by `error`, the ends of what it may be, and the texels between.
std::vector<double> valuesAround(const TransferTable& axis, double value, double error) {
    const double last = double(axis.texels.size()) - 1.0;
    const double texel = (axis.lastValue - axis.firstValue) / last;
    const double reach = error + texel * (1.0 / 256.0 + last * 0x1p-22);
    std::vector<double> values = {value, value - reach, value + reach};
    const auto texelAt = [&](double v) {
        return std::clamp((v - axis.firstValue) / texel, 0.0, last);
    };
    for (double k = std::ceil(texelAt(value - reach)); k <= texelAt(value + reach); k += 1.0) {
        values.push_back(axis.firstValue + k * texel);
    }
    return values;
}

/// Trilinear over 8 corners of any type with range.
template <class T, class At>
T trilinear(glm::ivec3 dims, glm::dvec3 uvw, T& range, At at) {
    const glm::dvec3 place =
        glm::clamp(uvw * glm::dvec3(dims) - 0.5, glm::dvec3(0.0), glm::dvec3(dims - 1));
    const glm::ivec3 low(place);
    const glm::dvec3 f = place - glm::dvec3(low);
    T sum(0.0);
    T least(1e300);
    T most(-1e300);
    for (int corner = 0; corner < 8; ++corner) {
        const glm::ivec3 up(corner & 1, corner >> 1 & 1, corner >> 2);
        const glm::dvec3 share = glm::mix(1.0 - f, f, glm::dvec3(up));
        const T value = at(glm::min(low + up, dims - 1));
        sum += value * (share.x * share.y * share.z);
        least = glm::min(least, value);
        most = glm::max(most, value);
    }
    range = most - least;
    return sum;
}

/// One step of what a filtered format holds, as the device's self-test allows it, in sampled units.
double sampledStep(TexelFormat format) {
    switch (format) {
    case TexelFormat::R8:
        return 1.0 / 255.0;
    case TexelFormat::R16:
        return 1.0 / 65535.0;
    case TexelFormat::R16F:
        return 1.0;
    default:
        return 0.0; // not filtered
    }
}

/// What a layer's opacity, baked into the table, is off by: fp16's rounding, and that between two
/// texels opacity runs linearly, not extinction: 1 - exp(-depth) leaves its chord by at most the
/// square of the difference of depths over 8. So does a premultiplied colour, whose product of two
/// linear ones leaves its chord by a quarter of the product of their differences.
double bakedError(const TransferTable& table, double value, double lengthMm) {
    const auto last = static_cast<double>(table.texels.size() - 1);
    const double place = std::clamp(
        (value - table.firstValue) * last / (table.lastValue - table.firstValue), 0.0, last);
    const auto low = static_cast<std::size_t>(std::max(0.0, std::floor(place) - 1.0));
    const std::size_t high = std::min(low + 3, table.texels.size() - 1); // a texel to either side
    double most = 0.0;
    double rise = 0.0;
    double hue = 0.0;
    for (std::size_t k = low; k <= high; ++k) {
        const double depth = table.texels[k].a * table.extinctionPerMm * lengthMm;
        most = std::max(most, -std::expm1(-depth));
        if (k > low) {
            const glm::vec4 step = glm::abs(table.texels[k] - table.texels[k - 1]);
            rise = std::max(rise, step.a * table.extinctionPerMm * lengthMm);
            hue = std::max({hue, double(step.x), double(step.y), double(step.z)});
        }
    }
    return most * 0x1p-11 + 0x1p-24 + rise * rise / 8.0 + std::min(rise, 1.0) * hue / 4.0;
}

} // namespace

struct ReferencePicture::Ray {
    LatticeRay ray;
    glm::dvec3 uvwError{0.0};
    double entryError = 0.0; // layers
    double exitError = 0.0;
};

struct ReferencePicture::Layer {
    glm::dvec4 color; // premultiplied
    double colorError;
    double alphaError;
};

ReferencePicture::ReferencePicture(const Scene& scene, const FramePlan& plan, const View& view,
                                   const Viewport& viewport)
    : scene_(scene), plan_(plan),
      frame_(makeRayFrame(view, viewport, scene.geometry(), plan.lattice)) {
    const glm::ivec3 dims = scene.geometry().dims;
    for (int z = 0; z < dims.z; ++z) {
        for (int y = 0; y < dims.y; ++y) {
            for (int x = 0; x < dims.x; ++x) {
                values_.push_back(decodedValue(scene.texels(), {x, y, z}));
            }
        }
    }
}

ReferencePicture::Ray ReferencePicture::rayOf(glm::dvec2 fragCoord) const {
    const glm::dvec2 p = glm::abs(fragCoord - frame_.viewportCentre);
    Ray result{.ray = rayAt(frame_, fragCoord)};
    const LatticeRay& ray = result.ray;
    const double total = plan_.lattice.total;
    const glm::dvec3 directionTerms = glm::abs(frame_.direction0) +
                                      glm::abs(frame_.directionX) * p.x +
                                      glm::abs(frame_.directionY) * p.y;
    const glm::dvec3 terms = glm::abs(frame_.centre0) + glm::abs(frame_.centreX) * p.x +
                             glm::abs(frame_.centreY) * p.y +
                             directionTerms * (frame_.spacing * total);
    result.uvwError = terms * 0x1p-22;
    result.entryError = result.exitError = total * 0x1p-21;
    if (frame_.sphereCentre.z - frame_.radius <= frame_.nearDepth) { // else it cuts nothing
        result.entryError +=
            (std::abs(frame_.sphereCentre.z) + frame_.nearDepth) / frame_.spacing * 0x1p-21;
    }
    for (int k = 0; k < 3; ++k) {
        const double error = result.uvwError[k] / std::max(std::abs(ray.step[k]), 1e-300);
        const double a = (0.0 - ray.centre[k]) / ray.step[k];
        const double b = (1.0 - ray.centre[k]) / ray.step[k];
        if (std::min(a, b) + error >= ray.entry) {
            result.entryError = std::max(result.entryError, error);
        }
        if (std::max(a, b) - error <= ray.exit) {
            result.exitError = std::max(result.exitError, error);
        }
    }
    return result;
}

ReferencePicture::Field ReferencePicture::fieldAt(glm::dvec3 uvw, glm::dvec3 uvwError) const {
    const glm::ivec3 dims = scene_.geometry().dims;
    double range = 0.0;
    const double value = trilinear(dims, uvw, range, [&](glm::ivec3 v) {
        return values_[(static_cast<std::size_t>(v.z) * dims.y + v.y) * dims.x + v.x];
    });
    const Texels& texels = scene_.texels();
    const double dataRange = scene_.statistics().max - scene_.statistics().min;
    const double filter =
        isExact(texels.format)
            ? dataRange * 0x1p-21
            : 3.0 / 256.0 * range + texels.valueScale * sampledStep(texels.format);
    return {value, filter + dataRange * glm::dot(uvwError, glm::dvec3(dims))};
}

/// `lengths`: least, meant and most length of the layer inside, mm.
ReferencePicture::Layer ReferencePicture::postClassified(glm::dvec3 uvw, const Ray& ray,
                                                         glm::dvec3 lengths) const {
    const Field field = fieldAt(uvw, ray.uvwError);
    const TableSpread material = lookUpAround(scene_.table(), field.value, field.error);
    const glm::dvec3 extinction = glm::max(around(material.value.w, material.error.w), 0.0);
    const glm::dvec3 alpha = 1.0 - glm::exp(-extinction * lengths);
    glm::dvec3 color(material.value);
    double colorError = std::max({material.error.x, material.error.y, material.error.z});
    if (plan_.variant.shaded && alpha.z > 0.0) {
        shade(color, colorError, uvw, ray);
    }
    const double baked = plan_.variant.lengths == Lengths::Baked
                             ? bakedError(scene_.table(), field.value, lengths.z)
                             : 0.0;
    const double alphaError = spread(alpha) + baked + 0x1p-22;
    return {glm::dvec4(color * alpha.y, alpha.y), alpha.z * colorError + baked + alphaError,
            alphaError};
}

/// Of the field, one voxel apart.
ReferencePicture::Gradient ReferencePicture::computedGradient(glm::dvec3 uvw,
                                                              const Ray& ray) const {
    const VolumeGeometry& geometry = scene_.geometry();
    glm::dvec3 perUvw(0.0);
    double differenceError = 0.0;
    for (int k = 0; k < 3; ++k) {
        glm::dvec3 h(0.0);
        h[k] = 0.5 / geometry.dims[k];
        const Field above = fieldAt(uvw + h, ray.uvwError);
        const Field below = fieldAt(uvw - h, ray.uvwError);
        perUvw[k] = (above.value - below.value) * geometry.dims[k];
        differenceError = std::max(differenceError, above.error + below.error);
    }
    const glm::dmat3 modelFromUvw(geometry.modelFromUvw());
    const glm::dvec3 gradient = glm::transpose(glm::inverse(modelFromUvw)) * perUvw;
    const double error = std::sqrt(3.0) * differenceError / geometry.smallestVoxelEdgeMm();
    return {gradient, error, glm::length(gradient), error};
}

/// As the device may filter signed bytes: with weights and results of eight bits.
ReferencePicture::Gradient ReferencePicture::bakedGradient(glm::dvec3 uvw, const Ray& ray) const {
    const NormalTexels& normals = *scene_.normals();
    const glm::i64vec3 dims(normals.dims);
    glm::dvec4 range(0.0);
    const glm::dvec4 texel = trilinear(normals.dims, uvw, range, [&](glm::i64vec3 v) {
        const auto index = static_cast<std::size_t>((v.z * dims.y + v.y) * dims.x + v.x);
        return glm::dvec4(normals.texels[index]) / 127.0;
    });
    const glm::dvec4 error =
        3.0 / 256.0 * range + 1.0 / 127.0 + 2.0 * glm::dot(ray.uvwError, glm::dvec3(normals.dims));
    const double steepness = normals.steepnessPerMm(texel);
    return {glm::dvec3(texel), glm::length(glm::dvec3(error)), steepness,
            normals.steepnessPerMm(texel + error) - steepness};
}

/// Blinn-Phong with a head light.
void ReferencePicture::shade(glm::dvec3& color, double& error, glm::dvec3 uvw,
                             const Ray& ray) const {
    const ShadingParameters& light = scene_.look().shading;
    const Gradient gradient = plan_.variant.normals == Normals::Baked ? bakedGradient(uvw, ray)
                                                                      : computedGradient(uvw, ray);
    const double steepness = gradient.steepness;
    const double steepnessError = gradient.steepnessError;
    const double weight = shadingWeight(light, steepness);
    if (shadingWeight(light, steepness + steepnessError) == 0.0) {
        return;
    }
    const glm::dvec3 toEye =
        -glm::normalize(glm::dmat3(scene_.geometry().modelFromUvw()) * ray.ray.step);
    const double length = glm::length(gradient.direction);
    const double facing =
        length > 0.0 ? std::abs(glm::dot(gradient.direction, toEye)) / length : 0.0;
    const double facingError =
        std::min(1.0, 2.0 * gradient.directionError / std::max(length, 1e-300)) + 0x1p-20;
    const auto lit = [&](double f) {
        return glm::min(color * (light.ambient + light.diffuse * f) +
                            light.specular * std::pow(f, light.shininess),
                        1.0);
    };
    // Brightness grows with `facing`, so its ends bound it; and the weight by its ends, too.
    const glm::dvec3 meant = lit(facing);
    const glm::dvec3 low = lit(std::max(0.0, facing - facingError));
    const glm::dvec3 high = lit(std::min(1.0, facing + facingError));
    const glm::dvec3 litError = glm::max(high - meant, meant - low);
    const double weightError =
        std::max(shadingWeight(light, steepness + steepnessError) - weight,
                 weight - shadingWeight(light, std::max(0.0, steepness - steepnessError)));
    const double brightest = light.ambient + light.diffuse;
    error = error * std::max(1.0, brightest) + std::max({litError.x, litError.y, litError.z}) +
            weightError;
    color = glm::mix(color, meant, weight);
}

ReferencePicture::Layer ReferencePicture::preClassified(glm::dvec3 uvw, const Ray& ray,
                                                        glm::dvec3 lengths) const {
    const ClassifiedTexels& classified = *scene_.classified();
    const glm::ivec3 dims = classified.dims;
    glm::dvec4 range(0.0);
    const glm::dvec4 texel = trilinear(dims, uvw, range, [&](glm::ivec3 v) {
        return glm::dvec4(
                   classified
                       .texels[(static_cast<std::size_t>(v.z) * dims.y + v.y) * dims.x + v.x]) /
               255.0;
    });
    const glm::dvec4 error =
        3.0 / 256.0 * range + 1.0 / 255.0 + glm::dot(ray.uvwError, glm::dvec3(dims));
    const auto opacity = [&](double a, double lengthMm) {
        return 1.0 - std::pow(1.0 - a, lengthMm / classified.referenceLengthMm);
    };
    const auto color = [&](glm::dvec4 t, double lengthMm) {
        return glm::dvec3(t) * (opacity(t.a, lengthMm) / std::max(t.a, 1e-6));
    };
    const glm::dvec4 low = glm::max(texel - error, 0.0);
    const glm::dvec4 high = glm::min(texel + error, 1.0);
    const glm::dvec3 meant = color(texel, lengths.y);
    glm::dvec3 colorError(0.0);
    for (const double a : {std::max(low.a, 1e-6), high.a}) {
        colorError = glm::max(colorError, color({glm::dvec3(high), a}, lengths.z) - meant);
        colorError = glm::max(colorError, meant - color({glm::dvec3(low), a}, lengths.x));
    }
    const glm::dvec3 alpha(opacity(low.a, lengths.x), opacity(texel.a, lengths.y),
                           opacity(high.a, lengths.z));
    return {glm::dvec4(meant, alpha.y),
            std::max({colorError.x, colorError.y, colorError.z}) + 0x1p-22,
            spread(alpha) + 0x1p-22};
}

ReferencePicture::Layer ReferencePicture::preIntegrated(int index, const Ray& ray,
                                                        glm::dvec3 lengths) const {
    const PreintegratedTable& table = *scene_.preintegrated();
    const double half = plan_.lattice.total / 2.0;
    const glm::dvec3 endError =
        ray.uvwError + glm::abs(ray.ray.step) * std::max(ray.entryError, ray.exitError);
    const auto valuesAt = [&](int boundary) {
        const double lattice = boundary - half;
        const double offset = std::clamp(lattice, ray.ray.entry, ray.ray.exit);
        const bool nearEnd =
            lattice < ray.ray.entry + ray.entryError || lattice > ray.ray.exit - ray.exitError;
        const Field field =
            fieldAt(ray.ray.centre + offset * ray.ray.step, nearEnd ? endError : ray.uvwError);
        return valuesAround(table.diagonal, field.value, field.error);
    };
    const auto colorOf = [&](double front, double back, double lengthMm) {
        const glm::dvec4 mean = lookUp(table, front, back);
        const double alpha = 1.0 - std::exp(-mean.w * lengthMm);
        return glm::dvec4(mean.w > 0.0 ? glm::dvec3(mean) * (alpha / mean.w) : glm::dvec3(0.0),
                          alpha);
    };
    const std::vector<double> fronts = valuesAt(index);
    const std::vector<double> backs = valuesAt(index + 1);
    const glm::dvec4 meant = colorOf(fronts[0], backs[0], lengths.y);
    glm::dvec4 error(0.0);
    for (const double front : fronts) {
        for (const double back : backs) {
            for (const double length : {lengths.x, lengths.z}) {
                error = glm::max(error, glm::abs(colorOf(front, back, length) - meant));
            }
        }
    }
    return {meant, std::max({error.x, error.y, error.z}) + 0x1p-22, error.w + 0x1p-22};
}

ReferencePicture::Layer ReferencePicture::classified(int index, const Ray& ray,
                                                     glm::dvec3 lengths) const {
    const glm::dvec3 uvw = samplePosition(ray.ray, plan_.lattice.total, index);
    switch (plan_.variant.classification) {
    case Classification::Post:
        return postClassified(uvw, ray, lengths);
    case Classification::Pre:
        return preClassified(uvw, ray, lengths);
    case Classification::Preintegrated:
        break;
    }
    return preIntegrated(index, ray, lengths);
}

PixelReference ReferencePicture::at(glm::dvec2 fragCoord) const {
    const Ray ray = rayOf(fragCoord);
    const double slack = ray.entryError + ray.exitError;
    PixelReference result;
    if (ray.ray.entry >= ray.ray.exit + slack) {
        return result;
    }
    result.atEdge = ray.ray.entry >= ray.ray.exit - slack || slack > 0.5;
    const int total = plan_.lattice.total;
    const LayerRange range = layersOf(ray.ray, total);
    LatticeRay shortest = ray.ray;
    LatticeRay longest = ray.ray;
    shortest.entry += ray.entryError, shortest.exit -= ray.exitError;
    longest.entry -= ray.entryError, longest.exit += ray.exitError;
    double clearest = 1.0;
    for (int i = std::max(0, range.begin - 1); i < std::min(total, range.end + 1); ++i) {
        const glm::dvec3 lengths =
            glm::dvec3(layerWeight(shortest, total, i), layerWeight(ray.ray, total, i),
                       layerWeight(longest, total, i)) *
            ray.ray.layerLengthMm;
        if (lengths.z == 0.0) {
            continue;
        }
        const Layer layer = classified(i, ray, lengths);
        result.bound += clearest * (layer.colorError + layer.alphaError);
        result.color += (1.0 - result.color.a) * layer.color;
        clearest *= 1.0 - std::max(0.0, layer.color.a - layer.alphaError);
    }
    return result;
}

double roundingPerPlane(TargetFormat target) {
    return target == TargetFormat::Rgba8 ? 3.0 / 510.0 : 0x1p-11;
}

double roundingOfDeepest(TargetFormat target) {
    return target == TargetFormat::Rgba8 ? 1.0 / 510.0 : 0x1p-11;
}

double blendingBound(const FramePlan& plan) {
    return roundingOfDeepest(plan.target) + (plan.planes - 1) * roundingPerPlane(plan.target);
}

} // namespace slabcast
