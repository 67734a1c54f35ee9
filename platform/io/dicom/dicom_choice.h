#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "platform/io/base/load_options.h"
#include "platform/io/dicom/dicom_image.h"

namespace slabcast {

/// Those images that all of `options.select` hold for: values compare as numbers where both are,
/// and one of several values of an element is enough. Fails: InvalidArgument (none is left; the
/// line lists what there is).
Result<DicomImages> selectImages(const std::filesystem::path& where, const DicomImages& images,
                                 const LoadOptions& options);

/// The images in order along their normal, one at each place: where several lie there, the
/// `options.time`-th. Fails: AmbiguousSeries (several, and none chosen: the line tells how many,
/// what they differ by and what chooses one), InvalidGeometry (all at one place),
/// InvalidArgument (no such time). Tested by:
/// io_dicom_choice_test.cpp
Result<DicomImages> onePerPlace(const std::filesystem::path& where, DicomImages images,
                                const LoadOptions& options);

/// "--select KEY=VALUE", such that it takes just the first of the two sets; or nothing.
std::optional<std::string> selectionOf(const DicomImages& wanted, const DicomImages& others);

} // namespace slabcast
