#include "platform/io/save_image.h"

#include <string>

#include <fmt/format.h>
#include <png.h>

#include "platform/io/atomic_file.h"
#include "platform/io/base/parse_text.h"
#include "platform/io/pictures/image_module.h"

namespace slabcast {

namespace {

Result<void> checkSize(const std::filesystem::path& path, int width, int height) {
    if (width < 1 || height < 1) {
        return fail(ErrorCode::InvalidArgument,
                    fmt::format("{}: an image of {} x {} pixels; choose a size of at least 1 x 1",
                                path.string(), width, height));
    }
    return {};
}

tl::unexpected<Error> notEncoded(const std::filesystem::path& path, const char* why) {
    return fail(
        ErrorCode::FileUnwritable,
        fmt::format("{}: cannot be encoded ({}); choose a smaller size or close other programs",
                    path.string(), oneLine(why)));
}

} // namespace

Result<void> savePng(const std::filesystem::path& path, int width, int height,
                     const std::uint8_t* pixels, PngChannels channels) {
    if (const Result<void> sound = checkSize(path, width, height); !sound) {
        return sound;
    }
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    image.width = static_cast<png_uint_32>(width);
    image.height = static_cast<png_uint_32>(height);
    image.format =
        channels == PngChannels::Rgb ? PNG_FORMAT_RGB : PNG_FORMAT_RGBA; // both mean sRGB
    std::string bytes(PNG_IMAGE_PNG_SIZE_MAX(image), '\0');
    png_alloc_size_t byteCount = bytes.size();
    if (png_image_write_to_memory(&image, bytes.data(), &byteCount, 0, pixels, 0, nullptr) == 0) {
        return notEncoded(path, image.message);
    }
    bytes.resize(byteCount);
    return writeFileAtomically(path, bytes);
}

Result<void> saveExr(const std::filesystem::path& path, int width, int height, const float* rgba) {
    if (const Result<void> sound = checkSize(path, width, height); !sound) {
        return sound;
    }
    const Result<const ImageModule*> module = imageModule(path, ErrorCode::FileUnwritable);
    if (!module) {
        return tl::unexpected(module.error());
    }
    std::string bytes;
    const auto take = [](void* taker, const char* data, std::size_t count) {
        static_cast<std::string*>(taker)->assign(data, count);
    };
    if (!(*module)->encodeExr(width, height, rgba, take, &bytes)) {
        return notEncoded(path, (*module)->lastError());
    }
    return writeFileAtomically(path, bytes);
}

} // namespace slabcast
