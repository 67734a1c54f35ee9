#include <algorithm>
#include <array>
#include <memory>
#include <optional>

#include <fmt/format.h>

#include "platform/io/image_module.h"
#include "platform/io/parse_text.h"
#include "platform/io/readers.h"
#include "platform/io/tiff_extent.h"

namespace slabcast {

namespace {

struct Page {
    std::filesystem::path path;
    int index = 0; // within the file
};

tl::unexpected<Error> unreadable(const std::filesystem::path& path, const std::string& why) {
    return fail(ErrorCode::FileUnreadable,
                fmt::format("{}: {}; check that the file is a whole image", path.string(),
                            why.empty() ? "no image format is recognised" : oneLine(why)));
}

/// A file of one or more pages, open for as long as it lives.
class PagedFile {
public:
    static Result<PagedFile> open(const std::filesystem::path& path) {
        const Result<const ImageModule*> module = imageModule(path, ErrorCode::FileUnreadable);
        if (!module) {
            return tl::unexpected(module.error());
        }
        if (!isWholeTiff(path)) {
            return fail(ErrorCode::FileTruncated,
                        fmt::format("{}: the file ends before its pages do; fetch it again",
                                    path.string()));
        }
        ImageFile* file = (*module)->open(path.c_str());
        if (file == nullptr) {
            return unreadable(path, (*module)->lastError());
        }
        return PagedFile(path, **module, file);
    }

    int countPages() {
        ImagePage page;
        int count = 1;
        while (module_->describe(file_.get(), count, &page)) {
            ++count;
        }
        return count;
    }

    /// Fails: FileUnreadable, UnsupportedType (not grey, or of a type that is not read).
    Result<ImagePage> describe(int index) {
        ImagePage page;
        if (!module_->describe(file_.get(), index, &page)) {
            return unreadable(path_, module_->lastError());
        }
        if (page.channels != 1) {
            return fail(
                ErrorCode::UnsupportedType,
                fmt::format("{}: has {} channels, and a volume has one; convert the images to "
                            "grey without alpha",
                            path_.string(), page.channels));
        }
        if (!page.isReadable) {
            return fail(
                ErrorCode::UnsupportedType,
                fmt::format("{}: pixels of type '{}' are not read; convert them to an integer "
                            "of 8 to 32 bits, float or double",
                            path_.string(), page.typeName));
        }
        return page;
    }

    /// Fails: FileTruncated.
    Result<void> read(int index, std::byte* target) {
        if (!module_->read(file_.get(), index, target)) {
            return fail(
                ErrorCode::FileTruncated,
                fmt::format("{}: {}; the pixels end early or are damaged: fetch the file again",
                            path_.string(), oneLine(module_->lastError())));
        }
        return {};
    }

private:
    PagedFile(std::filesystem::path path, const ImageModule& module, ImageFile* file)
        : path_(std::move(path)), module_(&module), file_(file, module.close) {}

    std::filesystem::path path_;
    const ImageModule* module_;
    std::unique_ptr<ImageFile, void (*)(ImageFile*) noexcept> file_;
};

/// What all pages must share, from the first; voxels are made room for.
Result<Volume> emptyVolume(const Page& first, std::size_t pageCount) {
    const Result<ImagePage> page = PagedFile::open(first.path).and_then([&](PagedFile file) {
        return file.describe(first.index);
    });
    if (!page) {
        return tl::unexpected(page.error());
    }
    const glm::ivec3 dims{page->width, page->height, static_cast<int>(pageCount)};
    const Result<std::int64_t> bytes = checkedByteCount({dims.x, dims.y, dims.z}, page->type);
    if (!bytes) {
        return tl::unexpected(bytes.error());
    }
    Volume volume;
    volume.name = first.path.filename().string();
    volume.type = page->type;
    volume.geometry.dims = dims;
    volume.geometry.spacingMm = {page->spacingMm[0], page->spacingMm[1], 1.0};
    volume.voxels.resize(*bytes);
    return volume;
}

Result<void> readPage(const Page& page, const Volume& volume, PagedFile& file, std::byte* target) {
    const glm::ivec3 dims = volume.geometry.dims;
    const Result<ImagePage> found = file.describe(page.index);
    if (!found) {
        return tl::unexpected(found.error());
    }
    if (found->width != dims.x || found->height != dims.y || found->type != volume.type) {
        return fail(
            ErrorCode::InvalidGeometry,
            fmt::format("{}: {} x {} pixels of {}, where the first slice has {} x {} of {}; "
                        "take away what does not belong to the stack",
                        page.path.string(), found->width, found->height, name(found->type), dims.x,
                        dims.y, name(volume.type)));
    }
    return file.read(page.index, target);
}

Result<Volume> readPages(const std::vector<Page>& pages) {
    Result<Volume> volume = emptyVolume(pages.front(), pages.size());
    if (!volume) {
        return volume;
    }
    const std::size_t pageBytes = volume->voxels.size() / pages.size();
    std::byte* target = volume->voxels.data();
    std::optional<PagedFile> file;
    for (const Page& page : pages) {
        if (page.index == 0) {
            Result<PagedFile> opened = PagedFile::open(page.path);
            if (!opened) {
                return tl::unexpected(opened.error());
            }
            file = std::move(*opened);
        }
        if (const Result<void> read = readPage(page, *volume, *file, target); !read) {
            return tl::unexpected(read.error());
        }
        target += pageBytes;
    }
    return volume;
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

Result<Volume> readImagePages(const std::filesystem::path& path, const LoadOptions&) {
    const Result<int> count =
        PagedFile::open(path).map([](PagedFile file) { return file.countPages(); });
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
}

Result<Volume> readImageStack(const std::filesystem::path& folder,
                              std::vector<std::filesystem::path> files,
                              const LoadOptions& options) {
    if (files.size() == 1) {
        return readImagePages(files.front(), options);
    }
    std::sort(files.begin(), files.end(), [](const auto& a, const auto& b) {
        return naturallyBefore(a.filename().string(), b.filename().string());
    });
    std::vector<Page> pages;
    for (const std::filesystem::path& file : files) {
        pages.push_back({file, 0});
    }
    Result<Volume> volume = readPages(pages);
    if (volume) {
        volume->name = folder.filename().string();
    }
    return volume;
}

} // namespace slabcast
