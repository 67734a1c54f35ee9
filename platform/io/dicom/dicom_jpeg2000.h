#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/error.h"

namespace slabcast {

/// The samples of a grey JPEG 2000 image of this size, row by row. The error's detail is the cause
/// alone. Fails: FileUnreadable (damaged, of another size, or in colours). Tested by:
/// io_dicom_pixels_test.cpp
Result<std::vector<std::int32_t>> decodeJpeg2000(std::span<const std::byte> stream, int columns,
                                                 int rows);

} // namespace slabcast
