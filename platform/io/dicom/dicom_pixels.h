#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "core/base/error.h"
#include "platform/io/dicom/dicom_file.h"

namespace slabcast {

/// The pixels of one file, frame by frame as they are stored: a cell of 1 byte for 1 or 8 bits, 2
/// for 16, 4 for 32 or float, 8 for double, in the machine's byte order; compressed ones decoded
/// and nothing else done to them.
class DicomPixels {
public:
    /// Opens the file for the second and last time, with the header that was read the first time:
    /// once for a file, whose `dataset` is taken. `file` must outlive it. Fails: UnsupportedType (a
    /// compression that is not read).
    static Result<DicomPixels> open(const DicomFile& file);
    ~DicomPixels();
    DicomPixels(DicomPixels&& other) noexcept;
    DicomPixels& operator=(DicomPixels&& other) noexcept;

    /// Frames are fastest in their order. Fails: FileTruncated, FileUnreadable (damaged). Tested
    /// by: io_dicom_pixels_test.cpp
    Result<void> read(int frame, std::vector<std::byte>& cells);

private:
    struct Opened;
    explicit DicomPixels(std::unique_ptr<Opened> opened);
    std::unique_ptr<Opened> opened_;
};

} // namespace slabcast
