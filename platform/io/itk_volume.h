#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include <itkImageIOBase.h>

#include "core/base/error.h"
#include "core/volume/volume.h"

namespace slabcast {

/// ITK throws; this is the border. The exception's text becomes one line behind the path and
/// the remedy.
Error itkError(ErrorCode code, const std::filesystem::path& path, const std::exception& exception,
               std::string_view remedy);

/// Opens `path` and takes type, dims and geometry from it; no voxels yet. DICOM also gives
/// modality and unit.
/// Fails: FileUnreadable, UnsupportedType, UnsupportedDims, EmptyVolume, SizeOverflow.
Result<Volume> openWithItk(const std::filesystem::path& path, itk::ImageIOBase& io);

/// All voxels of the opened file. Fails: FileTruncated.
Result<void> readVoxels(const std::filesystem::path& path, itk::ImageIOBase& io, std::byte* voxels);

/// Both steps.
Result<Volume> readWithItk(const std::filesystem::path& path, itk::ImageIOBase& io);

} // namespace slabcast
