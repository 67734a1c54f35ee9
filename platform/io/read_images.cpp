#include <algorithm>
#include <array>
#include <memory>

#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include "platform/io/parse_text.h"
#include "platform/io/readers.h"
#include "platform/io/tiff_extent.h"

namespace slabcast {

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

struct Page {
    std::filesystem::path path;
    int index = 0; // within the file
};

tl::unexpected<Error> unreadable(const std::filesystem::path& path, const std::string& why) {
    return fail(ErrorCode::FileUnreadable,
                fmt::format("{}: {}; check that the file is a whole image", path.string(),
                            why.empty() ? "no image format is recognised" : oneLine(why)));
}

Result<std::unique_ptr<OIIO::ImageInput>> open(const std::filesystem::path& path) {
    if (!isWholeTiff(path)) {
        return fail(
            ErrorCode::FileTruncated,
            fmt::format("{}: the file ends before its pages do; fetch it again", path.string()));
    }
    std::unique_ptr<OIIO::ImageInput> file = OIIO::ImageInput::open(path.string());
    if (!file) {
        return unreadable(path, OIIO::geterror());
    }
    return file;
}

/// Millimetres per pixel along one axis, where the file says so, else 1.
double pixelSpacingMm(const OIIO::ImageSpec& spec, const char* resolutionTag) {
    const std::string unit(spec.get_string_attribute("ResolutionUnit"));
    const double unitMm = unit == "in" || unit == "inch" ? 25.4 : unit == "cm" ? 10.0 : 0.0;
    const double resolution = spec.get_float_attribute(resolutionTag);
    return unitMm > 0.0 && resolution > 0.0 ? unitMm / resolution : 1.0;
}

Result<PixelType> greyType(const std::filesystem::path& path, const OIIO::ImageSpec& spec) {
    if (spec.nchannels != 1) {
        return fail(ErrorCode::UnsupportedType,
                    fmt::format("{}: has {} channels, and a volume has one; convert the images to "
                                "grey without alpha",
                                path.string(), spec.nchannels));
    }
    const auto found = std::find_if(kTypes.begin(), kTypes.end(), [&](const PixelType& entry) {
        return entry.stored == spec.format.basetype;
    });
    if (found == kTypes.end()) {
        return fail(ErrorCode::UnsupportedType,
                    fmt::format("{}: pixels of type '{}' are not read; convert them to an integer "
                                "of 8 to 32 bits, float or double",
                                path.string(), spec.format.c_str()));
    }
    return *found;
}

/// What all pages must share, from the first; voxels are made room for.
Result<Volume> emptyVolume(const Page& first, std::size_t pageCount) {
    const auto file = open(first.path);
    if (!file) {
        return tl::unexpected(file.error());
    }
    const OIIO::ImageSpec& spec = (*file)->spec();
    const Result<PixelType> type = greyType(first.path, spec);
    if (!type) {
        return tl::unexpected(type.error());
    }
    const Result<std::int64_t> bytes = checkedByteCount(
        {spec.width, spec.height, static_cast<std::int64_t>(pageCount)}, type->type);
    if (!bytes) {
        return tl::unexpected(bytes.error());
    }
    Volume volume;
    volume.name = first.path.filename().string();
    volume.type = type->type;
    volume.geometry.dims = {spec.width, spec.height, static_cast<int>(pageCount)};
    volume.geometry.spacingMm = {pixelSpacingMm(spec, "XResolution"),
                                 pixelSpacingMm(spec, "YResolution"), 1.0};
    volume.voxels.resize(*bytes);
    return volume;
}

Result<void> readPage(const Page& page, const Volume& volume, OIIO::ImageInput& file,
                      std::byte* target) {
    const OIIO::ImageSpec spec = file.spec(page.index);
    const glm::ivec3 dims = volume.geometry.dims;
    const Result<PixelType> type = greyType(page.path, spec);
    if (!type) {
        return tl::unexpected(type.error());
    }
    if (spec.width != dims.x || spec.height != dims.y || type->type != volume.type) {
        return fail(
            ErrorCode::InvalidGeometry,
            fmt::format("{}: {} x {} pixels of {}, where the first slice has {} x {} of {}; "
                        "take away what does not belong to the stack",
                        page.path.string(), spec.width, spec.height, name(type->type), dims.x,
                        dims.y, name(volume.type)));
    }
    if (!file.read_image(page.index, 0, 0, 1, OIIO::TypeDesc(type->read), target)) {
        return fail(ErrorCode::FileTruncated,
                    fmt::format("{}: {}; the pixels end early or are damaged: fetch the file again",
                                page.path.string(), oneLine(file.geterror())));
    }
    return {};
}

Result<Volume> readPages(const std::vector<Page>& pages) {
    Result<Volume> volume = emptyVolume(pages.front(), pages.size());
    if (!volume) {
        return volume;
    }
    const std::size_t pageBytes = volume->voxels.size() / pages.size();
    std::byte* target = volume->voxels.data();
    Result<std::unique_ptr<OIIO::ImageInput>> file;
    for (const Page& page : pages) {
        if (page.index == 0) {
            file = open(page.path);
        }
        if (!file) {
            return tl::unexpected(file.error());
        }
        if (const Result<void> read = readPage(page, *volume, **file, target); !read) {
            return tl::unexpected(read.error());
        }
        target += pageBytes;
    }
    return volume;
}

Result<int> countPages(const std::filesystem::path& path) {
    const auto file = open(path);
    if (!file) {
        return tl::unexpected(file.error());
    }
    int count = 1;
    while ((*file)->seek_subimage(count, 0)) {
        ++count;
    }
    return count;
}

/// OpenImageIO reports by value, but the standard library below it may still run out of memory.
template <class Body>
auto withoutExceptions(const std::filesystem::path& path, const Body& body) -> decltype(body()) {
    try {
        return body();
    } catch (const std::exception& exception) {
        return unreadable(path, exception.what());
    }
}

tl::unexpected<Error> flat(const std::filesystem::path& path) {
    return fail(ErrorCode::UnsupportedDims,
                fmt::format("{}: holds one image of two dimensions, and a volume has three; name a "
                            "folder of slices or a file of several pages",
                            path.string()));
}

} // namespace

bool isImage(const std::filesystem::path& path) {
    constexpr std::array<std::string_view, 9> kEndings = {".tif",  ".tiff", ".png", ".bmp", ".jpg",
                                                          ".jpeg", ".exr",  ".tga", ".pgm"};
    const std::string ending = lowerCase(path.extension().string());
    return std::find(kEndings.begin(), kEndings.end(), ending) != kEndings.end();
}

Result<Volume> readImagePages(const std::filesystem::path& path) {
    return withoutExceptions(path, [&]() -> Result<Volume> {
        const Result<int> count = countPages(path);
        if (!count) {
            return tl::unexpected(count.error());
        }
        if (*count == 1) {
            return flat(path);
        }
        std::vector<Page> pages;
        for (int index = 0; index < *count; ++index) {
            pages.push_back({path, index});
        }
        return readPages(pages);
    });
}

Result<Volume> readImageStack(const std::filesystem::path& folder,
                              std::vector<std::filesystem::path> files) {
    if (files.size() == 1) {
        return readImagePages(files.front());
    }
    std::sort(files.begin(), files.end(), [](const auto& a, const auto& b) {
        return naturallyBefore(a.filename().string(), b.filename().string());
    });
    std::vector<Page> pages;
    for (const std::filesystem::path& file : files) {
        pages.push_back({file, 0});
    }
    Result<Volume> volume = withoutExceptions(folder, [&] { return readPages(pages); });
    if (volume) {
        volume->name = folder.filename().string();
    }
    return volume;
}

} // namespace slabcast
