#include "platform/io/itk_volume.h"

#include <array>
#include <cmath>
#include <optional>

#include <fmt/format.h>
#include <itkObject.h>

#include "platform/io/parse_text.h"

namespace slabcast {

namespace {

using Component = itk::IOComponentEnum;

struct ComponentType {
    Component component;
    VoxelType type;
};

constexpr std::array<ComponentType, 8> kTypes = {{{Component::UCHAR, VoxelType::U8},
                                                  {Component::CHAR, VoxelType::I8},
                                                  {Component::USHORT, VoxelType::U16},
                                                  {Component::SHORT, VoxelType::I16},
                                                  {Component::UINT, VoxelType::U32},
                                                  {Component::INT, VoxelType::I32},
                                                  {Component::FLOAT, VoxelType::F32},
                                                  {Component::DOUBLE, VoxelType::F64}}};

std::optional<VoxelType> voxelType(Component component) {
    for (const ComponentType& entry : kTypes) {
        if (entry.component == component) {
            return entry.type;
        }
    }
    return std::nullopt;
}

Result<VoxelType> scalarType(const std::filesystem::path& path, const itk::ImageIOBase& io) {
    if (io.GetNumberOfComponents() != 1) {
        return fail(ErrorCode::UnsupportedType,
                    fmt::format("{}: has {} numbers per voxel, and a volume has one; extract one "
                                "channel or convert to grey",
                                path.string(), io.GetNumberOfComponents()));
    }
    const std::optional<VoxelType> type = voxelType(io.GetComponentType());
    if (!type) {
        return fail(ErrorCode::UnsupportedType,
                    fmt::format("{}: voxels of type '{}' are not read; convert them to an integer "
                                "of 8 to 32 bits, float or double",
                                path.string(),
                                itk::ImageIOBase::GetComponentTypeAsString(io.GetComponentType())));
    }
    return *type;
}

/// Axes beyond the third may only be one voxel long.
bool isThreeDimensional(const itk::ImageIOBase& io) {
    bool three = io.GetNumberOfDimensions() >= 3;
    for (unsigned axis = 3; axis < io.GetNumberOfDimensions(); ++axis) {
        three = three && io.GetDimensions(axis) == 1;
    }
    return three;
}

/// A mirrored axis is a matter of direction: the length stays positive.
VolumeGeometry geometryOf(const itk::ImageIOBase& io) {
    VolumeGeometry geometry;
    for (unsigned axis = 0; axis < 3; ++axis) {
        const double spacing = io.GetSpacing(axis);
        const std::vector<double> direction = io.GetDirection(axis);
        geometry.dims[axis] = static_cast<int>(io.GetDimensions(axis));
        geometry.spacingMm[axis] = std::abs(spacing);
        geometry.originMm[axis] = io.GetOrigin(axis);
        for (unsigned row = 0; row < 3; ++row) {
            geometry.direction[axis][row] = std::copysign(1.0, spacing) * direction[row];
        }
    }
    return geometry;
}

} // namespace

Error itkError(ErrorCode code, const std::filesystem::path& path, const std::exception& exception,
               std::string_view remedy) {
    const auto* ofItk = dynamic_cast<const itk::ExceptionObject*>(&exception);
    const std::string cause = oneLine(ofItk ? ofItk->GetDescription() : exception.what());
    return {code, fmt::format("{}: {}; {}", path.string(), cause, remedy)};
}

Result<Volume> openWithItk(const std::filesystem::path& path, itk::ImageIOBase& io) try {
    itk::Object::GlobalWarningDisplayOff(); // what matters is in the error that is returned
    io.SetFileName(path.string());
    io.ReadImageInformation();

    const Result<VoxelType> type = scalarType(path, io);
    if (!type) {
        return tl::unexpected(type.error());
    }
    if (!isThreeDimensional(io)) {
        return fail(ErrorCode::UnsupportedDims,
                    fmt::format("{}: has {} dimensions, and a volume has three; extract one volume "
                                "or stack the slices",
                                path.string(), io.GetNumberOfDimensions()));
    }
    const Result<std::int64_t> bytes =
        checkedByteCount({io.GetDimensions(0), io.GetDimensions(1), io.GetDimensions(2)}, *type);
    if (!bytes) {
        return fail(bytes.error().code, fmt::format("{}: {}", path.string(), bytes.error().detail));
    }
    Volume volume;
    volume.name = path.filename().string();
    volume.type = *type;
    volume.geometry = geometryOf(io);
    return volume;
} catch (const std::exception& exception) {
    const Error error =
        itkError(ErrorCode::FileUnreadable, path, exception,
                 "check that the file is whole and of the format that its name says");
    if (error.detail.find("orthonormal") != std::string::npos) { // of a sheared NIfTI transform
        return fail(ErrorCode::InvalidGeometry,
                    fmt::format("{}: its axes are not at right angles; resample it onto a straight "
                                "grid",
                                path.string()));
    }
    return tl::unexpected(error);
}

Result<void> readVoxels(const std::filesystem::path& path, itk::ImageIOBase& io,
                        std::byte* voxels) try {
    itk::ImageIORegion all(io.GetNumberOfDimensions());
    for (unsigned axis = 0; axis < io.GetNumberOfDimensions(); ++axis) {
        all.SetSize(axis, io.GetDimensions(axis));
    }
    io.SetIORegion(all);
    io.Read(voxels);
    return {};
} catch (const std::exception& exception) {
    return tl::unexpected(itkError(ErrorCode::FileTruncated, path, exception,
                                   "the voxels end early or are damaged: fetch the file again"));
}

Result<Volume> readWithItk(const std::filesystem::path& path, itk::ImageIOBase& io) {
    Result<Volume> volume = openWithItk(path, io);
    if (!volume) {
        return volume;
    }
    volume->voxels.resize(volume->geometry.voxelCount() * bytesPerVoxel(volume->type));
    const Result<void> read = readVoxels(path, io, volume->voxels.data());
    return read ? std::move(volume) : tl::unexpected(read.error());
}

} // namespace slabcast
