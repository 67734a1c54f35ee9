#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/volume/volume.h"
#include "platform/io/base/load_options.h"

namespace slabcast {

// One reader per family of formats; loadVolume() chooses and validates. None of them throws.

/// Says that `file` is read now, and how much of all is done; Cancelled where it is to stop.
/// Readers call it for each file, page or few MiB.
Result<void> going(const LoadOptions& options, const std::filesystem::path& file, double done);
/// Whether the volume may be read on. Readers ask before they make room for voxels.
Result<void> admitted(const LoadOptions& options, const Volume& header);
/// What a volume's voxels go into.
VoxelBytes makeVoxels(const LoadOptions& options, std::size_t size);

Result<Volume> readNrrd(const std::filesystem::path& path, const LoadOptions& options);
Result<Volume> readNifti(const std::filesystem::path& path, const LoadOptions& options);
Result<Volume> readMetaImage(const std::filesystem::path& path, const LoadOptions& options);

Result<Volume> readDicomFile(const std::filesystem::path& path, const LoadOptions& options);
/// Without `options.series`: the only one.
Result<Volume> readDicomSeries(const std::filesystem::path& folder, const LoadOptions& options);
/// Whether the file carries DICOM's mark behind its preamble.
bool hasDicomMark(const std::filesystem::path& path);
/// Whether any of the files does.
bool holdDicom(const std::vector<std::filesystem::path>& files);

/// All pages of one file.
Result<Volume> readImagePages(const std::filesystem::path& path, const LoadOptions& options);
/// One slice per file, in natural order of the names; a single file gives its pages.
Result<Volume> readImageStack(const std::filesystem::path& folder,
                              std::vector<std::filesystem::path> files, const LoadOptions& options);
/// By the end of the name.
bool isImage(const std::filesystem::path& path);

/// Plain voxels, as `options.raw` has them.
Result<Volume> readRaw(const std::filesystem::path& path, const LoadOptions& options);

} // namespace slabcast
