#pragma once

#include <cstdint>
#include <filesystem>

#include "core/base/error.h"

namespace slabcast {

enum class PngChannels : std::uint8_t { Rgb = 3, Rgba = 4 };

// Row 0 is the top row, rows are tightly packed. Both replace `path` only when the image is
// complete. Fail: InvalidArgument (a size below 1), FileUnwritable. Tested by: io_write_test.cpp

/// 8 bit per channel, sRGB-encoded. Alpha is stored as it is given; PNG's readers take it as
/// not premultiplied.
Result<void> savePng(const std::filesystem::path& path, int width, int height,
                     const std::uint8_t* pixels, PngChannels channels = PngChannels::Rgba);

/// 32-bit float RGBA, stored bit for bit; EXR's readers take colour as linear and premultiplied.
Result<void> saveExr(const std::filesystem::path& path, int width, int height, const float* rgba);

} // namespace slabcast
