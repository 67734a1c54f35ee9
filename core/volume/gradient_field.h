#pragma once

#include "core/volume/texel_codec.h"

namespace slabcast {

/// Gradient of the data per mm in patient space, at voxel centres. Half a voxel to either side the
/// trilinear field is the mean of two voxels, so a difference over one voxel spans two neighbours;
/// at the volume's edge it is clamped. Borrows the texels. Tested by: preclassified_test.cpp,
/// normals_test.cpp
template <class Codec>
class GradientField {
public:
    GradientField(const Texels& texels, const VolumeGeometry& geometry, Codec codec)
        : data_(texelData(texels, codec)), dims_(texels.dims),
          perMm_(glm::transpose(glm::dmat3(geometry.uvwFromModel()))) {
        for (int axis = 0; axis < 3; ++axis) {
            perMm_[axis] *= 0.5 * texels.dims[axis] * texels.valueScale / Codec::kUnitsPerSampled;
        }
    }

    /// `index`: of the voxel among the texels.
    glm::dvec3 at(glm::i64vec3 voxel, std::int64_t index) const {
        const glm::i64vec3 strides(1, dims_.x, dims_.x * dims_.y);
        glm::dvec3 difference;
        for (int axis = 0; axis < 3; ++axis) {
            const std::int64_t down = voxel[axis] > 0 ? strides[axis] : 0;
            const std::int64_t up = voxel[axis] + 1 < dims_[axis] ? strides[axis] : 0;
            difference[axis] =
                Codec::unpack(data_[index + up]) - Codec::unpack(data_[index - down]);
        }
        return perMm_ * difference;
    }

private:
    const typename Codec::Texel* data_;
    glm::i64vec3 dims_;
    glm::dmat3 perMm_; // gradient = perMm * (difference of the neighbours in codec units)
};

} // namespace slabcast
