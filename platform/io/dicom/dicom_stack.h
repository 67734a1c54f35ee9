#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/volume/volume.h"
#include "platform/io/base/load_options.h"
#include "platform/io/dicom/dicom_image.h"

namespace slabcast {

/// Where each image lies, from its header; where no header says it and `options.spacingMm` is
/// given, in order of their numbers, with a note. Fails: InvalidGeometry, naming the element that
/// is missing or cannot be read.
Result<void> placeImages(const std::filesystem::path& where, DicomImages& images,
                         const LoadOptions& options, std::vector<std::string>& notes);

/// Whether all have the size of most. Fails: InvalidGeometry, naming the odd one out.
Result<void> checkSameSize(const std::filesystem::path& where, const DicomImages& images);
/// The same for orientation and spacing, of images that have their places.
Result<void> checkSamePlane(const std::filesystem::path& where, const DicomImages& images);

void setAlongNormal(DicomImages& images);

/// Slices in order, one at each place.
struct DicomStack {
    VolumeGeometry geometry;         // of the slices as they are, evenly laid from first to last
    std::vector<double> distancesMm; // of each slice from the first, along `geometry`'s third axis
    bool isEven = true;              // false only with `options.resampleUneven`
};

/// The third axis runs from the first slice to the last: right for a tilted gantry too, whose box
/// is sheared. Fails: InvalidGeometry (a slice aside of the line; uneven distances, with what they
/// are and where they change). Tested by: io_dicom_stack_test.cpp
Result<DicomStack> stackImages(const std::filesystem::path& where, const DicomImages& images,
                               const LoadOptions& options);

/// `volume` has the stack's slices; the result has even ones, at the smallest distance, each a
/// linear mix of its two neighbours. With a note. Fails: SizeOverflow.
Result<Volume> resampledEvenly(const std::filesystem::path& where, Volume volume,
                               const DicomStack& stack, const LoadOptions& options);

} // namespace slabcast
