#include "core/volume/downsample.h"

#include <algorithm>
#include <array>

#include "core/base/parallel.h"
#include "core/volume/regrid.h"
#include "core/volume/voxel_dispatch.h"

namespace slabcast {
namespace {

/// The old voxels along one axis that a new one covers, and how much of it each fills.
struct Cover {
    std::int64_t first = 0;
    std::vector<double> weights; // sum to 1
};

std::vector<Cover> coversAlong(std::int64_t oldSize, std::int64_t newSize) {
    std::vector<Cover> covers(static_cast<std::size_t>(newSize));
    for (std::int64_t k = 0; k < newSize; ++k) {
        // In units of 1/newSize of an old voxel all faces are whole numbers, so no sliver is left.
        const std::int64_t begin = k * oldSize;
        const std::int64_t end = begin + oldSize;
        Cover& cover = covers[static_cast<std::size_t>(k)];
        cover.first = begin / newSize;
        for (std::int64_t voxel = cover.first; voxel * newSize < end; ++voxel) {
            const std::int64_t inside =
                std::min(end, (voxel + 1) * newSize) - std::max(begin, voxel * newSize);
            cover.weights.push_back(static_cast<double>(inside) / static_cast<double>(oldSize));
        }
    }
    return covers;
}

template <class T>
double averageOf(std::span<const T> voxels, glm::i64vec3 dims, const Cover& x, const Cover& y,
                 const Cover& z) {
    double sum = 0.0;
    for (std::size_t k = 0; k < z.weights.size(); ++k) {
        for (std::size_t j = 0; j < y.weights.size(); ++j) {
            const std::int64_t row = (z.first + static_cast<std::int64_t>(k)) * dims.y + y.first +
                                     static_cast<std::int64_t>(j);
            const T* begin = voxels.data() + row * dims.x + x.first;
            double rowSum = 0.0;
            for (std::size_t i = 0; i < x.weights.size(); ++i) {
                rowSum += x.weights[i] * static_cast<double>(begin[i]);
            }
            sum += z.weights[k] * y.weights[j] * rowSum;
        }
    }
    return sum;
}

template <class T>
void averageAll(std::span<const T> voxels, glm::i64vec3 oldDims, std::span<T> out,
                glm::i64vec3 newDims) {
    std::array<std::vector<Cover>, 3> covers;
    for (int axis = 0; axis < 3; ++axis) {
        covers[static_cast<std::size_t>(axis)] = coversAlong(oldDims[axis], newDims[axis]);
    }
    parallelFor(newDims.y * newDims.z, 16, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t row = begin; row < end; ++row) {
            const Cover& y = covers[1][static_cast<std::size_t>(row % newDims.y)];
            const Cover& z = covers[2][static_cast<std::size_t>(row / newDims.y)];
            for (std::int64_t x = 0; x < newDims.x; ++x) {
                out[static_cast<std::size_t>(row * newDims.x + x)] = roundedTo<T>(
                    averageOf(voxels, oldDims, covers[0][static_cast<std::size_t>(x)], y, z));
            }
        }
    });
}

} // namespace

Result<Volume> downsample(const Volume& volume, glm::ivec3 factor) {
    if (glm::any(glm::lessThan(factor, glm::ivec3(1)))) {
        return fail(ErrorCode::InvalidArgument,
                    "a downsampling factor is below 1; give whole numbers from 1");
    }
    const glm::i64vec3 oldDims(volume.geometry.dims);
    const glm::i64vec3 newDims =
        (oldDims - std::int64_t{1}) / glm::i64vec3(factor) + std::int64_t{1};
    Volume result = emptyOverSameBox(volume, glm::ivec3(newDims));
    visitVoxels(volume, [&]<class T>(std::span<const T> voxels) {
        const std::span<T> out(reinterpret_cast<T*>(result.voxels.data()),
                               static_cast<std::size_t>(result.geometry.voxelCount()));
        averageAll(voxels, oldDims, out, newDims);
    });
    return result;
}

} // namespace slabcast
