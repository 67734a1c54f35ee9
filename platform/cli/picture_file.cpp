#include "platform/cli/picture_file.h"

#include <cmath>

#include "platform/io/atomic_file.h"
#include "platform/io/save_image.h"

namespace slabcast {

bool isPictureName(const std::filesystem::path& path) {
    return path.extension() == ".png" || path.extension() == ".exr";
}

Result<bool> pictureIsEncoded(const std::filesystem::path& path) {
    if (!isPictureName(path)) {
        return fail(ErrorCode::InvalidArgument,
                    path.string() +
                        ": pictures are written as .png or .exr: give a name that ends so");
    }
    return checkWritable(path).map([&] { return path.extension() == ".png"; });
}

Result<void> savePicture(const std::filesystem::path& path, glm::ivec2 size,
                         const std::vector<glm::vec4>& pixels, bool opaque) {
    const Result<bool> encoded = pictureIsEncoded(path);
    if (!encoded) {
        return tl::unexpected(encoded.error());
    }
    if (!*encoded) {
        return saveExr(path, size.x, size.y, &pixels.front().x);
    }
    const int channels = opaque ? 3 : 4;
    std::vector<std::uint8_t> bytes;
    bytes.reserve(pixels.size() * channels);
    for (const glm::vec4& pixel : pixels) {
        for (int c = 0; c < channels; ++c) {
            bytes.push_back(
                static_cast<std::uint8_t>(std::lround(glm::clamp(pixel[c], 0.0F, 1.0F) * 255.0F)));
        }
    }
    return savePng(path, size.x, size.y, bytes.data(),
                   opaque ? PngChannels::Rgb : PngChannels::Rgba);
}

} // namespace slabcast
