#include "core/volume/volume.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>
#include <optional>

#include <glm/gtc/matrix_inverse.hpp>

#include "core/base/parallel.h"
#include "core/volume/voxel_dispatch.h"

namespace slabcast {
namespace {

constexpr std::int64_t kGrain = 1 << 18;
constexpr double kUnitTolerance = 1e-2;       // files round direction cosines to a few digits
constexpr double kSmallestDeterminant = 1e-6; // of unit columns: below it the axes are coplanar

constexpr std::array kTypeNames{"uint8",  "int8",  "uint16", "int16",
                                "uint32", "int32", "float",  "double"};

bool isFinite(glm::dvec3 v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

std::string text(glm::dvec3 v) {
    return std::to_string(v.x) + " " + std::to_string(v.y) + " " + std::to_string(v.z);
}

/// Checks the geometry and makes its direction cosines exactly unit length.
Result<void> normaliseGeometry(VolumeGeometry& geometry) {
    const glm::dvec3 spacing = geometry.spacingMm;
    const glm::dvec3 extent = spacing * glm::dvec3(geometry.dims);
    if (!isFinite(extent) || glm::any(glm::lessThanEqual(spacing, glm::dvec3(0.0)))) {
        return fail(ErrorCode::InvalidGeometry,
                    "voxel spacing " + text(spacing) +
                        " is not positive and finite; correct the spacing in the file's header");
    }
    if (!isFinite(geometry.originMm)) {
        return fail(ErrorCode::InvalidGeometry,
                    "the origin is not finite; correct the origin in the file's header");
    }
    for (int axis = 0; axis < 3; ++axis) {
        const double length = glm::length(geometry.direction[axis]);
        if (!(std::abs(length - 1.0) <= kUnitTolerance)) {
            return fail(ErrorCode::InvalidGeometry,
                        "direction cosines " + text(geometry.direction[axis]) +
                            " are not a unit vector; correct the direction in the file's header");
        }
        geometry.direction[axis] /= length;
    }
    if (std::abs(glm::determinant(geometry.direction)) < kSmallestDeterminant) {
        return fail(ErrorCode::InvalidGeometry,
                    "the direction cosines lie in one plane; correct them in the file's header");
    }
    return {};
}

/// Whether voxel and data value are finite and fit float32, in which the renderer computes.
struct Presentable {
    double slope;
    double intercept;

    bool operator()(double voxel) const {
        constexpr double kLargest = std::numeric_limits<float>::max();
        return std::abs(voxel) <= kLargest && std::abs(slope * voxel + intercept) <= kLargest;
    }
};

/// The presentable voxel with the lowest data value: the largest stored one where the slope is
/// negative. 0 if there is none.
template <class T>
T lowestVoxel(std::span<const T> voxels, const Presentable& presentable) {
    std::optional<T> lowest;
    for (const T voxel : voxels) {
        if (presentable(voxel) &&
            (!lowest || (presentable.slope > 0.0 ? voxel < *lowest : voxel > *lowest))) {
            lowest = voxel;
        }
    }
    return lowest.value_or(T{0});
}

/// Returns how many voxels it replaced.
template <class T>
std::int64_t replaceUnpresentable(std::span<T> voxels, const Presentable& presentable) {
    const auto bad = [&](T voxel) { return !presentable(voxel); };
    std::atomic<std::int64_t> count{0};
    parallelFor(static_cast<std::int64_t>(voxels.size()), kGrain,
                [&](std::int64_t begin, std::int64_t end) {
                    count += std::count_if(voxels.begin() + begin, voxels.begin() + end, bad);
                });
    if (count > 0) {
        const T lowest = lowestVoxel(std::span<const T>(voxels), presentable);
        std::replace_if(voxels.begin(), voxels.end(), bad, lowest);
    }
    return count;
}

/// Integers cannot be replaced one by one: the rescaling must suit every value of their type.
bool suitsType(VoxelType type, const Presentable& presentable) {
    return visitVoxelType(type, [&]<class T>(std::type_identity<T>) {
        using Limits = std::numeric_limits<T>;
        return presentable.slope != 0.0 && presentable(0.0) &&
               (std::is_floating_point_v<T> ||
                (presentable(Limits::lowest()) && presentable(Limits::max())));
    });
}

} // namespace

std::size_t bytesPerVoxel(VoxelType type) {
    return visitVoxelType(type, []<class T>(std::type_identity<T>) { return sizeof(T); });
}

const char* name(VoxelType type) {
    const auto index = static_cast<std::size_t>(type);
    SLABCAST_EXPECTS(index < kTypeNames.size(), index);
    return kTypeNames[index];
}

bool isFloatingPoint(VoxelType type) {
    return type == VoxelType::F32 || type == VoxelType::F64;
}

std::int64_t VolumeGeometry::voxelCount() const {
    return std::int64_t{dims.x} * std::int64_t{dims.y} * std::int64_t{dims.z};
}

double VolumeGeometry::smallestVoxelEdgeMm() const {
    return std::min({spacingMm.x, spacingMm.y, spacingMm.z});
}

glm::dmat4 VolumeGeometry::modelFromUvw() const {
    glm::dmat3 axes; // column k: the box's whole edge along voxel axis k
    glm::dvec3 corner = originMm;
    for (int k = 0; k < 3; ++k) {
        const glm::dvec3 voxelEdge = direction[k] * spacingMm[k];
        axes[k] = voxelEdge * static_cast<double>(dims[k]);
        corner -= 0.5 * voxelEdge;
    }
    glm::dmat4 modelFromUvw(axes);
    modelFromUvw[3] = glm::dvec4(corner, 1.0);
    return modelFromUvw;
}

glm::dmat4 VolumeGeometry::uvwFromModel() const {
    return glm::affineInverse(modelFromUvw());
}

BoundingSphere VolumeGeometry::boundingSphere() const {
    const glm::dmat4 model = modelFromUvw();
    const glm::dvec3 centre(model * glm::dvec4(0.5, 0.5, 0.5, 1.0));
    double radius = 0.0;
    for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec4 uvw(corner & 1, (corner >> 1) & 1, (corner >> 2) & 1, 1.0);
        radius = std::max(radius, glm::distance(glm::dvec3(model * uvw), centre));
    }
    return {centre, radius};
}

double Volume::valueAt(glm::ivec3 voxel) const {
    const glm::ivec3 dims = geometry.dims;
    SLABCAST_EXPECTS(glm::all(glm::lessThan(glm::uvec3(voxel), glm::uvec3(dims))), voxel.x);
    const std::int64_t index =
        (std::int64_t{voxel.z} * dims.y + voxel.y) * std::int64_t{dims.x} + voxel.x;
    const double stored = visitVoxels(
        *this, [&](auto all) { return static_cast<double>(all[static_cast<std::size_t>(index)]); });
    return rescaleSlope * stored + rescaleIntercept;
}

Result<std::int64_t> checkedByteCount(glm::i64vec3 dims, VoxelType type) {
    std::int64_t bytes = static_cast<std::int64_t>(bytesPerVoxel(type));
    for (int axis = 0; axis < 3; ++axis) {
        const std::int64_t size = dims[axis];
        const std::string asked = "axis " + std::to_string(axis) + " has " + std::to_string(size);
        if (size <= 0) {
            return fail(ErrorCode::EmptyVolume,
                        asked + " voxels; a volume needs at least one along every axis");
        }
        if (size > std::numeric_limits<std::int32_t>::max() ||
            bytes > std::numeric_limits<std::int64_t>::max() / size) {
            return fail(ErrorCode::SizeOverflow,
                        asked + " voxels, more than can be addressed; check the file's header");
        }
        bytes *= size;
    }
    return bytes;
}

Result<Volume> validated(Volume volume) {
    const Result<std::int64_t> bytes =
        checkedByteCount(glm::i64vec3(volume.geometry.dims), volume.type);
    if (!bytes) {
        return tl::unexpected<Error>(bytes.error());
    }
    const auto size = static_cast<std::int64_t>(volume.voxels.size());
    if (size < *bytes) {
        return fail(ErrorCode::FileTruncated, "the voxels fill " + std::to_string(size) +
                                                  " bytes where the header asks for " +
                                                  std::to_string(*bytes) +
                                                  "; copy the file again or correct its header");
    }
    volume.voxels.resize(static_cast<std::size_t>(*bytes)); // what follows the voxels is padding
    if (const Result<void> geometry = normaliseGeometry(volume.geometry); !geometry) {
        return tl::unexpected<Error>(geometry.error());
    }
    const Presentable presentable{volume.rescaleSlope, volume.rescaleIntercept};
    if (!suitsType(volume.type, presentable)) {
        return fail(ErrorCode::InvalidArgument,
                    "rescale slope " + std::to_string(volume.rescaleSlope) + " and intercept " +
                        std::to_string(volume.rescaleIntercept) +
                        " give no finite data values; correct them in the file's header");
    }
    volume.nonFiniteVoxels += visitVoxels(volume, [&]<class T>(std::span<T> voxels) {
        if constexpr (std::is_floating_point_v<T>) {
            return replaceUnpresentable(voxels, presentable);
        } else {
            return std::int64_t{0};
        }
    });
    return volume;
}

} // namespace slabcast
