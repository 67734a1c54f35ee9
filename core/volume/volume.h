#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "core/base/error.h"
#include "core/volume/voxel_bytes.h"

namespace slabcast {

enum class VoxelType : std::uint8_t { U8, I8, U16, I16, U32, I32, F32, F64 };

std::size_t bytesPerVoxel(VoxelType type);
const char* name(VoxelType type); // "uint8", "int16", "float", ...
bool isFloatingPoint(VoxelType type);

/// What made the picture, where the file says so: a hint for the default transfer function.
enum class Modality : std::uint8_t { Unknown, Ct, Mr };

struct BoundingSphere {
    glm::dvec3 centreMm{0.0};
    double radiusMm = 0.0;
};

/// Where the voxels lie in patient space: LPS (x to the left, y to the back, z up), in mm.
struct VolumeGeometry {
    glm::ivec3 dims{0};
    glm::dvec3 spacingMm{1.0};
    glm::dvec3 originMm{0.0};  // centre of voxel (0,0,0)
    glm::dmat3 direction{1.0}; // column k: unit vector of voxel axis k (direction cosines)

    std::int64_t voxelCount() const;
    double smallestVoxelEdgeMm() const;
    /// uvw is [0,1]^3 over the whole box, outer half voxels included; the centre of voxel i lies at
    /// (i+0.5)/dims.
    glm::dmat4 modelFromUvw() const;
    glm::dmat4 uvwFromModel() const;
    /// Around all eight corners of the box, also of a sheared one.
    BoundingSphere boundingSphere() const;
};

/// Voxels as they came, x fastest, then y, then z, in the machine's byte order.
/// A data value is `rescaleSlope * voxel + rescaleIntercept`, in `unit`.
struct Volume {
    std::string name;
    std::string unit;
    Modality modality = Modality::Unknown;
    VoxelType type = VoxelType::U8;
    VolumeGeometry geometry;
    double rescaleSlope = 1.0;
    double rescaleIntercept = 0.0;
    std::int64_t nonFiniteVoxels =
        0; // NaN and infinities found on load, since replaced by the lowest finite data value
    VoxelBytes voxels;
    std::vector<std::string> notes; // what its reader assumed or left out: a line each

    /// Data value of one voxel. For tests and small loops: bulk code dispatches on the type once.
    double valueAt(glm::ivec3 voxel) const;
};

/// Everything that a loader must hold before a volume may be used: positive dims whose product
/// fits, as many bytes as they ask for, finite positive spacing, direction cosines that span space,
/// finite non-zero slope. Replaces and counts non-finite voxels, and those outside float32's range.
/// Bytes after the last voxel are dropped; direction cosines become exactly unit length.
/// Fails: EmptyVolume, SizeOverflow, FileTruncated, InvalidGeometry, InvalidArgument (rescaling).
/// Tested by: volume_test.cpp
Result<Volume> validated(Volume volume);

/// dims.x * dims.y * dims.z * bytes, or SizeOverflow / EmptyVolume. For loaders, before they
/// allocate.
Result<std::int64_t> checkedByteCount(glm::i64vec3 dims, VoxelType type);

} // namespace slabcast
