#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "platform/io/base/load_options.h"
#include "platform/io/dicom/dicom_file.h"

namespace slabcast {

/// What reading headers takes of all work, for progress.
inline constexpr double kHeadersShare = 0.3;

/// The files of one series, in natural order of their names.
struct DicomSeries {
    std::vector<DicomFile> files;
    std::vector<std::string> notes;
};

/// The series of a folder that `options.series` names, or the only one. Where the folder itself
/// holds no DICOM images, those below it are looked for, to a bounded depth and number. What is not
/// DICOM, and DICOM without images of other series, is passed over; a damaged file is not.
/// Fails: EmptyFolder, AmbiguousSeries, InvalidArgument (no such series), FileTruncated and
/// FileUnreadable (the first file that is damaged). Cost: every file's header. Tested by:
/// io_dicom_series_test.cpp
Result<DicomSeries> findDicomSeries(const std::filesystem::path& folder,
                                    const LoadOptions& options);

/// Whether another file in the folder of this one belongs to its series.
bool hasSiblings(const DicomFile& file);

} // namespace slabcast
