#include "platform/io/volumes/stored_values.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <limits>
#include <utility>

#include <fmt/format.h>

namespace slabcast {

namespace {

template <class T>
T at(const std::byte* place) {
    T value;
    std::memcpy(&value, place, sizeof(T));
    return value;
}

/// Front to back: no value is overwritten before it is read, for those that grow lie at the end
/// and those that shrink at the front.
template <class From, class To, class Change>
void changeEach(std::byte* to, const std::byte* from, std::size_t count, const Change& change) {
    for (std::size_t i = 0; i < count; ++i) {
        const To value = static_cast<To>(change(at<From>(from + i * sizeof(From))));
        std::memcpy(to + i * sizeof(To), &value, sizeof(To));
    }
}

template <class From>
void rescaleEach(VoxelBytes& voxels, bool toDouble, const Rescaling& rescaling) {
    const std::size_t count = voxels.size() / (toDouble ? sizeof(double) : sizeof(float));
    const std::byte* from = voxels.data() + voxels.size() - count * sizeof(From);
    const auto value = [&](From stored) {
        return rescaling.slope * static_cast<double>(stored) + rescaling.intercept;
    };
    if (toDouble) {
        changeEach<From, double>(voxels.data(), from, count, value);
    } else {
        changeEach<From, float>(voxels.data(), from, count, value);
    }
}

/// Whether a double keeps it: 53 bits from the first that is set to the last.
template <class T>
bool fitsDouble(T value) {
    const auto bits = static_cast<std::uint64_t>(value);
    const std::uint64_t size = value < 0 ? ~bits + 1 : bits;
    return size == 0 || size >> std::countr_zero(size) < std::uint64_t{1} << 53;
}

template <class T>
Result<VoxelType> narrowEach(VoxelBytes& voxels, const char* typeName) {
    const std::size_t count = voxels.size() / sizeof(T);
    T least = std::numeric_limits<T>::max();
    T most = std::numeric_limits<T>::min();
    bool doubles = true;
    for (std::size_t i = 0; i < count; ++i) {
        const T value = at<T>(voxels.data() + i * sizeof(T));
        least = std::min(least, value);
        most = std::max(most, value);
        doubles = doubles && fitsDouble(value);
    }
    const auto same = [](T value) { return value; };
    if (std::in_range<std::int32_t>(least) && std::in_range<std::int32_t>(most)) {
        changeEach<T, std::int32_t>(voxels.data(), voxels.data(), count, same);
        voxels.resize(count * sizeof(std::int32_t));
        return VoxelType::I32;
    }
    if (std::in_range<std::uint32_t>(least) && std::in_range<std::uint32_t>(most)) {
        changeEach<T, std::uint32_t>(voxels.data(), voxels.data(), count, same);
        voxels.resize(count * sizeof(std::uint32_t));
        return VoxelType::U32;
    }
    if (!doubles) {
        return fail(ErrorCode::UnsupportedType,
                    fmt::format("voxels of type '{}' from {} to {}, which no type that is read "
                                "keeps exactly; convert them to an integer of 8 to 32 bits, float "
                                "or double",
                                typeName, least, most));
    }
    changeEach<T, double>(voxels.data(), voxels.data(), count, same);
    return VoxelType::F64;
}

} // namespace

VoxelType rescaledType(StoredType stored) {
    const bool large = stored.type == VoxelType::U32 || stored.type == VoxelType::I32 ||
                       stored.type == VoxelType::F64;
    return large ? VoxelType::F64 : VoxelType::F32;
}

void rescale(VoxelBytes& voxels, StoredType stored, const Rescaling& rescaling) {
    const bool toDouble = rescaledType(stored) == VoxelType::F64;
    if (stored.wide != Wide::No) {
        return stored.wide == Wide::Signed
                   ? rescaleEach<std::int64_t>(voxels, toDouble, rescaling)
                   : rescaleEach<std::uint64_t>(voxels, toDouble, rescaling);
    }
    switch (stored.type) {
    case VoxelType::U8:
        return rescaleEach<std::uint8_t>(voxels, toDouble, rescaling);
    case VoxelType::I8:
        return rescaleEach<std::int8_t>(voxels, toDouble, rescaling);
    case VoxelType::U16:
        return rescaleEach<std::uint16_t>(voxels, toDouble, rescaling);
    case VoxelType::I16:
        return rescaleEach<std::int16_t>(voxels, toDouble, rescaling);
    case VoxelType::U32:
        return rescaleEach<std::uint32_t>(voxels, toDouble, rescaling);
    case VoxelType::I32:
        return rescaleEach<std::int32_t>(voxels, toDouble, rescaling);
    case VoxelType::F32:
        return rescaleEach<float>(voxels, toDouble, rescaling);
    case VoxelType::F64:
        return rescaleEach<double>(voxels, toDouble, rescaling);
    }
}

Result<VoxelType> narrow(VoxelBytes& voxels, Wide wide) {
    return wide == Wide::Signed ? narrowEach<std::int64_t>(voxels, "int64")
                                : narrowEach<std::uint64_t>(voxels, "uint64");
}

} // namespace slabcast
