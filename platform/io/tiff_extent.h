#pragma once

#include <filesystem>

namespace slabcast {

/// Whether every directory of a TIFF or BigTIFF file, and every strip and tile that they list,
/// lies within the file. libtiff reads what is there of a cut file and calls it whole. True for
/// what is no TIFF. Cost: the directories.
bool isWholeTiff(const std::filesystem::path& path);

} // namespace slabcast
