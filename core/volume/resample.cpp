#include "core/volume/resample.h"

#include <algorithm>
#include <array>
#include <vector>

#include "core/base/parallel.h"
#include "core/volume/downsample.h"
#include "core/volume/regrid.h"
#include "core/volume/voxel_dispatch.h"

namespace slabcast {
namespace {

constexpr std::int64_t kRowGrain = 64;

/// Between which two old voxels along an axis a new one's centre lies, and how far.
struct Between {
    std::int64_t low = 0;
    std::int64_t high = 0;
    double part = 0.0; // of `high`
};

std::vector<Between> betweenAlong(int oldSize, int newSize) {
    std::vector<Between> places(static_cast<std::size_t>(newSize));
    for (int k = 0; k < newSize; ++k) {
        const double centre = std::clamp((k + 0.5) * oldSize / newSize - 0.5, 0.0, oldSize - 1.0);
        const auto low = static_cast<std::int64_t>(centre);
        places[static_cast<std::size_t>(k)] = {low, std::min<std::int64_t>(low + 1, oldSize - 1),
                                               centre - static_cast<double>(low)};
    }
    return places;
}

double mixed(double a, double b, double part) {
    return a + part * (b - a);
}

template <class T>
void interpolateAll(std::span<const T> voxels, glm::i64vec3 oldDims, std::span<T> out,
                    glm::i64vec3 newDims) {
    std::array<std::vector<Between>, 3> between;
    for (int axis = 0; axis < 3; ++axis) {
        between[static_cast<std::size_t>(axis)] =
            betweenAlong(static_cast<int>(oldDims[axis]), static_cast<int>(newDims[axis]));
    }
    parallelFor(newDims.y * newDims.z, kRowGrain, [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t row = begin; row < end; ++row) {
            const Between& y = between[1][static_cast<std::size_t>(row % newDims.y)];
            const Between& z = between[2][static_cast<std::size_t>(row / newDims.y)];
            const auto rowAt = [&](std::int64_t v, std::int64_t w) {
                return voxels.data() + (w * oldDims.y + v) * oldDims.x;
            };
            const T* const rows[] = {rowAt(y.low, z.low), rowAt(y.high, z.low),
                                     rowAt(y.low, z.high), rowAt(y.high, z.high)};
            const auto across = [&](std::int64_t x) {
                return mixed(mixed(double(rows[0][x]), double(rows[1][x]), y.part),
                             mixed(double(rows[2][x]), double(rows[3][x]), y.part), z.part);
            };
            T* to = out.data() + row * newDims.x;
            for (const Between& x : between[0]) {
                *to++ = roundedTo<T>(mixed(across(x.low), across(x.high), x.part));
            }
        }
    });
}

Volume interpolated(const Volume& volume, glm::ivec3 dims) {
    Volume result = emptyOverSameBox(volume, dims);
    visitVoxels(volume, [&]<class T>(std::span<const T> voxels) {
        const std::span<T> out(reinterpret_cast<T*>(result.voxels.data()),
                               result.voxels.size() / sizeof(T));
        interpolateAll(voxels, glm::i64vec3(volume.geometry.dims), out, glm::i64vec3(dims));
    });
    return result;
}

} // namespace

Result<Volume> resample(const Volume& volume, glm::ivec3 dims) {
    if (glm::any(glm::lessThan(dims, glm::ivec3(1)))) {
        return fail(ErrorCode::InvalidArgument,
                    "an edge to resample to is below 1; give whole numbers from 1");
    }
    if (const Result<std::int64_t> bytes = checkedByteCount(glm::i64vec3(dims), volume.type);
        !bytes) {
        return tl::unexpected<Error>(bytes.error());
    }
    const glm::ivec3 factor = glm::max(volume.geometry.dims / dims, glm::ivec3(1));
    if (factor == glm::ivec3(1)) {
        return interpolated(volume, dims);
    }
    return downsample(volume, factor).map([&](const Volume& averaged) {
        return averaged.geometry.dims == dims ? averaged : interpolated(averaged, dims);
    });
}

} // namespace slabcast
