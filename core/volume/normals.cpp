#include "core/volume/normals.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/parallel.h"
#include "core/volume/gradient_field.h"
#include "core/volume/trilinear_field.h"

namespace slabcast {

namespace {

constexpr double kSteps = 127.0; // of a signed byte, as textures hold it
constexpr std::int64_t kRowGrain = 64;
constexpr int kPlaces = 1 << 14;

glm::i8vec4 packedGradient(glm::dvec3 gradient, double steepestPerMm) {
    const double steepness = glm::length(gradient);
    if (!(steepness > 0.0)) {
        return glm::i8vec4(0);
    }
    const double root = std::min(std::sqrt(steepness / steepestPerMm), 1.0);
    return {glm::round(glm::dvec4(gradient / steepness, 1.0) * root * kSteps)};
}

/// Place k of a sequence that fills the unit cube evenly.
/// Source: Roberts, The unreasonable effectiveness of quasirandom sequences, 2018.
glm::dvec3 evenPlace(int k) {
    constexpr double g = 1.2207440846057596; // g^4 = g + 1
    return glm::fract(glm::dvec3(0.5) + double(k) / glm::dvec3(g, g * g, g * g * g));
}

template <class Codec>
NormalsError errorOf(const NormalTexels& normals, const TrilinearField<Codec>& field,
                     const VolumeGeometry& geometry, double floorPerMm) {
    const glm::dmat3 toPatient = glm::transpose(glm::dmat3(geometry.uvwFromModel()));
    std::vector<double> angles;
    double sum = 0.0;
    for (int k = 0; k < kPlaces; ++k) {
        const glm::dvec3 uvw = evenPlace(k);
        const glm::dvec3 gradient = toPatient * uvwGradient(field, uvw);
        const glm::dvec3 baked(normals.at(uvw));
        if (!(glm::length(gradient) > floorPerMm)) {
            continue;
        }
        const double across = glm::length(glm::cross(gradient, baked));
        const double along = std::abs(glm::dot(gradient, baked));
        angles.push_back(std::atan2(across, along) * 180.0 / std::numbers::pi);
        sum += angles.back();
    }
    if (angles.empty()) {
        return {};
    }
    const auto most = angles.begin() + static_cast<std::ptrdiff_t>(angles.size() * 19 / 20);
    std::nth_element(angles.begin(), most, angles.end());
    return {sum / double(angles.size()), *most, static_cast<int>(angles.size())};
}

} // namespace

glm::dvec4 NormalTexels::at(glm::dvec3 uvw) const {
    const auto around = [this](glm::ivec3 cell) { return texelsAround(texels, dims, cell); };
    return filteredTexels(dims, uvw, around) / kSteps;
}

double NormalTexels::steepnessPerMm(const glm::dvec4& texel) const {
    return texel.w * texel.w * steepestPerMm;
}

NormalTexels bakeNormals(const Texels& texels, const VolumeGeometry& geometry, double steepestPerMm,
                         double floorPerMm) {
    SLABCAST_EXPECTS(steepestPerMm > 0.0, steepestPerMm);
    const glm::i64vec3 dims(texels.dims);
    NormalTexels normals{texels.dims, steepestPerMm, {}, {}};
    normals.texels.resize(static_cast<std::size_t>(dims.x * dims.y * dims.z));
    visitTexelFormat(texels.format, [&]<class Codec>(Codec codec) {
        const GradientField gradients(texels, geometry, codec);
        parallelFor(dims.y * dims.z, kRowGrain, [&](std::int64_t begin, std::int64_t end) {
            for (std::int64_t index = begin * dims.x; index < end * dims.x; ++index) {
                const std::int64_t row = index / dims.x;
                const glm::i64vec3 voxel(index % dims.x, row % dims.y, row / dims.y);
                normals.texels[static_cast<std::size_t>(index)] =
                    packedGradient(gradients.at(voxel, index), steepestPerMm);
            }
        });
        normals.error = errorOf(normals, TrilinearField(texels, codec), geometry, floorPerMm);
    });
    return normals;
}

} // namespace slabcast
