#include "platform/io/save_image.h"

#include <vector>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include "platform/io/atomic_file.h"
#include "platform/io/parse_text.h"

namespace slabcast {

namespace {

/// `format` rather than the file's ending decides, so that any name may be given. Encoded in memory first, because
/// OpenImageIO's PNG writer does not notice a full disk.
Result<void> writeImage(const std::filesystem::path& path, const char* format,
                        const OIIO::ImageSpec& spec, const void* pixels) {
    if (spec.width < 1 || spec.height < 1) {
        return fail(ErrorCode::InvalidArgument,
                    fmt::format("{}: an image of {} x {} pixels; choose a size of at least 1 x 1",
                                path.string(), spec.width, spec.height));
    }
    std::vector<unsigned char> bytes;
    OIIO::Filesystem::IOVecOutput memory(bytes);
    const auto file = OIIO::ImageOutput::create(format);
    const bool encoded = file && file->set_ioproxy(&memory) && file->open(path.string(), spec) &&
                         file->write_image(spec.format, pixels) && file->close();
    if (!encoded) {
        return fail(
            ErrorCode::FileUnwritable,
            fmt::format("{}: cannot be encoded ({}); install OpenImageIO with support for {}",
                        path.string(), oneLine(file ? file->geterror() : OIIO::geterror()),
                        format));
    }
    return writeFileAtomically(path, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

} // namespace

Result<void> savePng(const std::filesystem::path& path, int width, int height,
                     const std::uint8_t* pixels, PngChannels channels) {
    OIIO::ImageSpec spec(width, height, static_cast<int>(channels), OIIO::TypeDesc::UINT8);
    spec.attribute("oiio:ColorSpace", "sRGB");
    spec.attribute("oiio:UnassociatedAlpha", 1); // else OpenImageIO divides colour by alpha
    return writeImage(path, "png", spec, pixels);
}

Result<void> saveExr(const std::filesystem::path& path, int width, int height, const float* rgba) {
    OIIO::ImageSpec spec(width, height, 4, OIIO::TypeDesc::FLOAT);
    spec.attribute("compression", "zip");
    return writeImage(path, "openexr", spec, rgba);
}

} // namespace slabcast
