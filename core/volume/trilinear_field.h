#pragma once

#include <array>
#include <vector>

#include <glm/glm.hpp>

#include "core/volume/texel_codec.h"

namespace slabcast {

/// The scalar field that pictures are of: trilinear in the stored texels' data values,
/// clamped to the edge. Borrows the texels: they must outlive it.
/// Tested by: discrete_test.cpp, continuous_test.cpp
template <class Codec>
class TrilinearField {
public:
    TrilinearField(const Texels& texels, Codec codec)
        : data_(texelData(texels, codec)), dims_(texels.dims),
          scale_(texels.valueScale / Codec::kUnitsPerSampled), bias_(texels.valueBias) {}

    /// Data value at a point of uvw.
    double at(glm::dvec3 uvw) const {
        const glm::dvec3 place =
            glm::clamp(uvw * glm::dvec3(dims_) - 0.5, glm::dvec3(0.0), glm::dvec3(dims_ - 1));
        const glm::ivec3 low(place);
        const glm::dvec3 f = place - glm::dvec3(low);
        const std::array<double, 8> corner = cornersOf(low);
        const double front =
            glm::mix(glm::mix(corner[0], corner[1], f.x), glm::mix(corner[2], corner[3], f.x), f.y);
        const double back =
            glm::mix(glm::mix(corner[4], corner[5], f.x), glm::mix(corner[6], corner[7], f.x), f.y);
        return glm::mix(front, back, f.z);
    }

    /// Data values around the cell between the voxels `cell` and `cell` + 1: x fastest, then y,
    /// then z. Voxels beyond the edge take the edge's value, so that cell -1 is the outer half
    /// voxel.
    std::array<double, 8> cornersOf(glm::ivec3 cell) const {
        const glm::ivec3 low = glm::clamp(cell, glm::ivec3(0), dims_ - 1);
        const glm::ivec3 high = glm::clamp(cell + 1, glm::ivec3(0), dims_ - 1);
        std::array<double, 8> corner;
        for (int k = 0; k < 4; ++k) {
            const std::int64_t y = (k & 1) == 0 ? low.y : high.y;
            const std::int64_t z = (k & 2) == 0 ? low.z : high.z;
            const auto* row = data_ + (z * dims_.y + y) * dims_.x;
            corner[2 * k] = scale_ * Codec::unpack(row[low.x]) + bias_;
            corner[2 * k + 1] = scale_ * Codec::unpack(row[high.x]) + bias_;
        }
        return corner;
    }

    glm::dvec3 dims() const { return glm::dvec3(dims_); }

private:
    const typename Codec::Texel* data_;
    glm::ivec3 dims_;
    double scale_; // data value = scale * units + bias
    double bias_;
};

/// Derivative by uvw: central differences of the field over one voxel, half of it to each side.
template <class Field>
glm::dvec3 uvwGradient(const Field& field, glm::dvec3 uvw) {
    glm::dvec3 gradient;
    for (int axis = 0; axis < 3; ++axis) {
        glm::dvec3 half(0.0);
        half[axis] = 0.5 / field.dims()[axis];
        gradient[axis] = (field.at(uvw + half) - field.at(uvw - half)) * field.dims()[axis];
    }
    return gradient;
}

/// Four components at a place, filtered as the field is. `around(cell)` gives those of the eight
/// voxels around it, in the order of TrilinearField::cornersOf().
template <class Around>
glm::dvec4 filteredTexels(glm::dvec3 dims, glm::dvec3 uvw, Around around) {
    const glm::dvec3 place = glm::clamp(uvw * dims - 0.5, glm::dvec3(0.0), dims - 1.0);
    const glm::ivec3 cell(place);
    const glm::dvec3 upper = place - glm::dvec3(cell);
    const std::array<glm::dvec4, 8> corners = around(cell);
    glm::dvec4 sum(0.0);
    for (int k = 0; k < 8; ++k) {
        const glm::dvec3 share =
            glm::mix(1.0 - upper, upper, glm::dvec3(k & 1, k >> 1 & 1, k >> 2));
        sum += share.x * share.y * share.z * corners[k];
    }
    return sum;
}

/// Texels of the eight voxels from `cell` on, those beyond the far edge as the edge's.
template <class Texel>
std::array<glm::dvec4, 8> texelsAround(const std::vector<Texel>& texels, glm::i64vec3 dims,
                                       glm::ivec3 cell) {
    std::array<glm::dvec4, 8> corners;
    for (int k = 0; k < 8; ++k) {
        const glm::i64vec3 v = glm::min(glm::i64vec3(cell + glm::ivec3(k & 1, k >> 1 & 1, k >> 2)),
                                        dims - std::int64_t{1});
        corners[k] =
            glm::dvec4(texels[static_cast<std::size_t>((v.z * dims.y + v.y) * dims.x + v.x)]);
    }
    return corners;
}

} // namespace slabcast
