#pragma once

#include <cstddef>
#include <filesystem>

namespace slabcast {

/// The grey pixels of a JPEG of 8 bits, row by row as they are stored. False where the file cannot
/// be read, has other sizes, or is damaged: its library fills in grey and goes on, and only counts
/// what it missed. Tested by: io_images_test.cpp
bool readGreyJpeg(const std::filesystem::path& path, int width, int height, std::byte* pixels);

} // namespace slabcast
