#pragma once

#include <string>
#include <vector>

#include "platform/io/dicom/dicom_header.h"

namespace slabcast {

/// What may tell a frame from others at its place: dicomKeys() and `moreKeys`, of which those that
/// DICOM does not know are left out.
void setProperties(DicomFile& file, const DicomHeader& header,
                   const std::vector<std::string>& moreKeys);

} // namespace slabcast
