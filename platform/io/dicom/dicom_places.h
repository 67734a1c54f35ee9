#pragma once

#include "platform/io/dicom/dicom_header.h"

namespace slabcast {

/// Where each frame lies, how it is turned, and how far its pixels are apart, as far as the file
/// says; a fault where what it says is not to be read.
void setPlaces(DicomFile& file, const DicomHeader& header);

} // namespace slabcast
