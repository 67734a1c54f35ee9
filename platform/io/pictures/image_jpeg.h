#pragma once

#include <cstddef>
#include <string_view>

namespace slabcast {

/// The grey pixels of a JPEG of 8 bits, row by row as they are stored. False where the file has
/// other sizes or is damaged: its library fills in grey and goes on, and only counts what it
/// missed. Tested by: io_images_test.cpp
bool readGreyJpeg(std::string_view file, int width, int height, std::byte* pixels);

} // namespace slabcast
