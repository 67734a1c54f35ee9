#pragma once

#include <dcmtk/config/osconfig.h> // before all else of DCMTK

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include <dcmtk/dcmdata/dctk.h>

#include "core/base/error.h"

namespace slabcast {

/// A DICOM file as DCMTK read it. Elements over 4 KiB, pixels above all, stay in the file until
/// they are asked for.
struct DicomDataset {
    std::unique_ptr<DcmFileFormat> format; // never null
    bool isWhole = true;                   // false: nothing after its last element could be read
    bool hasMark = false;                  // DICOM's, behind the preamble

    DcmDataset& data() const { return *format->getDataset(); }
};

/// The one place where a DICOM file is opened. DCMTK is silenced, for good, and knows its decoders
/// from then on. Fails: FileTruncated (empty; cut within its header), FileUnreadable (not DICOM).
Result<DicomDataset> openDicomDataset(const std::filesystem::path& path);
/// The same of a file with DICOM's mark; nothing of any other.
Result<std::optional<DicomDataset>> openMarkedDicomDataset(const std::filesystem::path& path);

/// DCMTK's dictionary of elements is a text that takes 25 ms to read, at its first use. Files whose
/// elements say their types need none, so slabcast-read begins without; this reads it after all.
/// Cost: nothing if that is done. Thread: one at a time, as for all reading of DICOM.
void readDictionary();

/// The pixels' element, plain, of floats or of doubles; null without.
DcmElement* pixelElement(DcmDataset& data);

/// All values of an element as DICOM writes them, with backslashes between; numbers in their
/// shortest form.
std::string dicomText(DcmElement& element);

} // namespace slabcast
