// OpenImageIO behind the table of platform/io/pictures/image_module.h. It decides nothing: what is
// refused, and in which words, is platform/io's.
#include <algorithm>
#include <array>
#include <exception>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include "platform/io/pictures/image_module.h"

namespace slabcast {

struct ImageFile {
    std::unique_ptr<OIIO::Filesystem::IOMemReader> bytes; // outlives what reads from it
    std::unique_ptr<OIIO::ImageInput> input;
};

namespace {

struct PixelType {
    OIIO::TypeDesc::BASETYPE stored;
    VoxelType type;
    OIIO::TypeDesc::BASETYPE read;
};

/// Every type as it is, but half, which float holds exactly.
constexpr std::array<PixelType, 9> kTypes = {{
    {OIIO::TypeDesc::UINT8, VoxelType::U8, OIIO::TypeDesc::UINT8},
    {OIIO::TypeDesc::INT8, VoxelType::I8, OIIO::TypeDesc::INT8},
    {OIIO::TypeDesc::UINT16, VoxelType::U16, OIIO::TypeDesc::UINT16},
    {OIIO::TypeDesc::INT16, VoxelType::I16, OIIO::TypeDesc::INT16},
    {OIIO::TypeDesc::UINT32, VoxelType::U32, OIIO::TypeDesc::UINT32},
    {OIIO::TypeDesc::INT32, VoxelType::I32, OIIO::TypeDesc::INT32},
    {OIIO::TypeDesc::HALF, VoxelType::F32, OIIO::TypeDesc::FLOAT},
    {OIIO::TypeDesc::FLOAT, VoxelType::F32, OIIO::TypeDesc::FLOAT},
    {OIIO::TypeDesc::DOUBLE, VoxelType::F64, OIIO::TypeDesc::DOUBLE},
}};

thread_local std::string error;

const char* lastError() noexcept {
    return error.c_str();
}

/// OpenImageIO reports by value, but the standard library below it may still run out of memory.
template <class Body>
auto withoutExceptions(const Body& body) noexcept -> decltype(body()) {
    try {
        return body();
    } catch (const std::exception& exception) {
        error = exception.what();
        return {};
    }
}

/// The library's name of a format by its first bytes, else by the ending of the name, which is the
/// name of the format too where it has no first bytes of its own.
std::string formatOf(const std::string& path, std::string_view bytes) {
    constexpr std::array<std::pair<std::string_view, const char*>, 6> kMarks = {
        {{"\x89PNG", "png"},
         {"\xFF\xD8\xFF", "jpeg"},
         {"BM", "bmp"},
         {"P5", "pnm"},
         {"P2", "pnm"},
         {"\x76\x2F\x31\x01", "openexr"}}};
    for (const auto& [mark, format] : kMarks) {
        if (bytes.starts_with(mark)) {
            return format;
        }
    }
    return OIIO::Filesystem::extension(path, false);
}

/// Without the library's own look at the file, which opens it by its name, twice.
std::unique_ptr<OIIO::ImageInput> openBytes(const char* path, const OIIO::ImageSpec& wishes,
                                            OIIO::Filesystem::IOMemReader& bytes) {
    const auto all = bytes.buffer();
    auto input = OIIO::ImageInput::create(
        formatOf(path, {reinterpret_cast<const char*>(all.data()), std::size_t(all.size())}));
    OIIO::ImageSpec spec;
    const bool isOpen = input && input->supports("ioproxy") && input->set_ioproxy(&bytes) &&
                        input->open(path, spec, wishes);
    return isOpen ? std::move(input) : nullptr;
}

ImageFile* open(const char* path, const void* bytes, std::size_t count) noexcept {
    return withoutExceptions([&]() -> ImageFile* {
        OIIO::ImageSpec wishes;
        wishes.attribute("oiio:UnassociatedAlpha", 1); // channels as they are stored
        auto memory = std::make_unique<OIIO::Filesystem::IOMemReader>(bytes, count);
        auto input = openBytes(path, wishes, *memory);
        if (!input) { // of another format than it seems to be, or read from a file alone
            input = OIIO::ImageInput::open(path, &wishes);
        }
        if (!input) {
            error = OIIO::geterror();
            return nullptr;
        }
        return new ImageFile{std::move(memory), std::move(input)};
    });
}

void close(ImageFile* file) noexcept {
    delete file;
}

/// PNG counts pixels per metre, which the library turns into inches.
void takeResolution(const OIIO::ImageSpec& spec, bool isPng, ImagePage& page) {
    const std::string unit(spec.get_string_attribute("ResolutionUnit"));
    const bool isInch = unit == "in" || unit == "inch";
    page.resolutionUnit = isInch && !isPng ? 2 : isInch || unit == "cm" || unit == "m" ? 3 : 1;
    const double share = isInch && isPng ? 1.0 / 2.54 : unit == "m" ? 0.01 : 1.0;
    page.resolution[0] = spec.get_float_attribute("XResolution") * share;
    page.resolution[1] = spec.get_float_attribute("YResolution") * share;
}

/// None where the type is not read.
const PixelType* pixelType(const OIIO::ImageSpec& spec) {
    const auto found = std::find_if(kTypes.begin(), kTypes.end(), [&](const PixelType& entry) {
        return entry.stored == spec.format.basetype;
    });
    return found != kTypes.end() ? &*found : nullptr;
}

bool describe(ImageFile* file, int index, ImagePage* page) noexcept {
    return withoutExceptions([&] {
        if (!file->input->seek_subimage(index, 0)) {
            error = file->input->geterror();
            return false;
        }
        const OIIO::ImageSpec& spec = file->input->spec();
        const PixelType* type = pixelType(spec);
        const std::string format = file->input->format_name();
        *page = {.width = spec.width,
                 .height = spec.height,
                 .channels = spec.nchannels,
                 .type = type != nullptr ? type->type : VoxelType::U8,
                 .isReadable = type != nullptr,
                 .typeName = spec.format.c_str()};
        takeResolution(spec, format == "png", *page);
        if (format == "jpeg" || format == "png") { // with other formats, it is the library's matter
            page->orientation = spec.get_int_attribute("Orientation", 1);
        }
        return true;
    });
}

bool read(ImageFile* file, int index, int channel, void* pixels) noexcept {
    return withoutExceptions([&] {
        const PixelType* type = pixelType(file->input->spec(index));
        const bool isRead =
            type != nullptr &&
            file->input->read_image(index, 0, channel, channel + 1, type->read, pixels);
        error = isRead ? "" : file->input->geterror();
        return isRead;
    });
}

/// Into memory, so that platform/io's way of writing files holds for pictures too.
bool encodeExr(int width, int height, const float* rgba, ImageModule::TakeBytes take,
               void* taker) noexcept {
    return withoutExceptions([&] {
        OIIO::ImageSpec spec(width, height, 4, OIIO::TypeDesc::FLOAT);
        spec.attribute("compression", "zip");
        std::vector<unsigned char> bytes;
        OIIO::Filesystem::IOVecOutput memory(bytes);
        const auto output = OIIO::ImageOutput::create("openexr"); // no file name need end so
        const bool isEncoded = output && output->set_ioproxy(&memory) &&
                               output->open("exr", spec) &&
                               output->write_image(spec.format, rgba) && output->close();
        if (isEncoded) {
            take(taker, reinterpret_cast<const char*>(bytes.data()), bytes.size());
        } else {
            error = output ? output->geterror() : OIIO::geterror();
        }
        return isEncoded;
    });
}

constexpr ImageModule kModule = {.version = ImageModule::kVersion,
                                 .lastError = lastError,
                                 .open = open,
                                 .close = close,
                                 .describe = describe,
                                 .read = read,
                                 .encodeExr = encodeExr};

} // namespace
} // namespace slabcast

extern "C" __attribute__((visibility("default"))) const slabcast::ImageModule*
slabcastImageModule() {
    return &slabcast::kModule;
}
