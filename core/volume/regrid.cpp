#include "core/volume/regrid.h"

namespace slabcast {

VolumeGeometry sameBox(const VolumeGeometry& old, glm::ivec3 dims) {
    VolumeGeometry geometry = old;
    geometry.dims = dims;
    for (int axis = 0; axis < 3; ++axis) {
        geometry.spacingMm[axis] = old.spacingMm[axis] * old.dims[axis] / dims[axis];
        // The box's corner stays, so the first centre moves by half the growth.
        geometry.originMm +=
            0.5 * (geometry.spacingMm[axis] - old.spacingMm[axis]) * old.direction[axis];
    }
    return geometry;
}

Volume emptyOverSameBox(const Volume& volume, glm::ivec3 dims) {
    Volume result;
    result.name = volume.name;
    result.unit = volume.unit;
    result.modality = volume.modality;
    result.type = volume.type;
    result.geometry = sameBox(volume.geometry, dims);
    result.rescaleSlope = volume.rescaleSlope;
    result.rescaleIntercept = volume.rescaleIntercept;
    result.nonFiniteVoxels = volume.nonFiniteVoxels;
    result.notes = volume.notes;
    result.voxels.resize(static_cast<std::size_t>(result.geometry.voxelCount()) *
                         bytesPerVoxel(result.type));
    return result;
}

} // namespace slabcast
