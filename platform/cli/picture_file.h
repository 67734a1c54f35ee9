#pragma once

#include <filesystem>
#include <vector>

#include <glm/glm.hpp>

#include "core/base/error.h"

namespace slabcast {

/// Whether the name ends as pictures' do: .png or .exr.
bool isPictureName(const std::filesystem::path& path);

/// Whether the ending is one that savePicture() knows, and a file can be written there. To be asked
/// before the work. Fails: InvalidArgument, FileUnwritable.
Result<bool>
pictureIsEncoded(const std::filesystem::path& path); // true: .png, sRGB-encoded; false: .exr, light

/// Top row first. RGB where `opaque`, else RGBA. Atomic.
Result<void> savePicture(const std::filesystem::path& path, glm::ivec2 size,
                         const std::vector<glm::vec4>& pixels, bool opaque);

} // namespace slabcast
