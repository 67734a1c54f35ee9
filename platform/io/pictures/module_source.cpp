// Images other than TIFF as a source of slices, through the module.
#include <algorithm>
#include <cstring>
#include <optional>

#include <fmt/format.h>

#include "platform/io/base/parse_text.h"
#include "platform/io/pictures/image_extent.h"
#include "platform/io/pictures/image_jpeg.h"
#include "platform/io/pictures/image_module.h"
#include "platform/io/pictures/image_source.h"
#include "platform/io/pictures/tiff_pages.h"

namespace slabcast {

namespace {

template <class T>
void narrow(std::byte* pixels, std::size_t count, std::uint64_t highest) {
    constexpr std::uint64_t kFull = static_cast<T>(~T{0});
    for (std::size_t i = 0; i < count; ++i) {
        T value = 0;
        std::memcpy(&value, pixels + i * sizeof(T), sizeof(T));
        value = static_cast<T>((value * highest + kFull / 2) / kFull);
        std::memcpy(pixels + i * sizeof(T), &value, sizeof(T));
    }
}

class ModuleSource : public ImageSource {
public:
    explicit ModuleSource(std::filesystem::path path)
        : path_(std::move(path)), file_(nullptr, [](ImageFile*) noexcept {}) {}

    /// Once, before anything else.
    Result<void> open(std::ifstream file, const ImageChoice& choice) {
        take(file);
        if (bytes_.empty()) {
            return fail(ErrorCode::FileUnreadable,
                        fmt::format("{}: is empty; check where it comes from, and fetch it again",
                                    path_.string()));
        }
        const ImageExtent extent = extentOf(bytes_);
        if (!extent.isWhole) {
            return fail(ErrorCode::FileTruncated,
                        fmt::format("{}: the file ends before its image does: it was cut off; "
                                    "fetch it again",
                                    path_.string()));
        }
        highest_ = extent.highest;
        isJpeg_ = extent.isJpeg;
        const Result<const ImageModule*> module = imageModule(path_, ErrorCode::FileUnreadable);
        if (!module) {
            return tl::unexpected(module.error());
        }
        module_ = *module;
        return openImage().and_then(
            [&] { return describe(choice, static_cast<double>(bytes_.size())); });
    }

    const ImageFacts& facts() const override { return facts_; }

    Result<void> read(std::size_t index, std::byte* target) override {
        const bool isGreyJpeg = isJpeg_ && channels_ == 1;
        const ImageSlice& slice = facts_.slices[index];
        if (const Result<void> opened = openAgain(isGreyJpeg, index); !opened) {
            return opened;
        }
        const std::size_t voxelBytes = bytesPerVoxel(slice.type);
        const std::size_t count = static_cast<std::size_t>(slice.size.x) * slice.size.y;
        std::vector<std::byte> stored(orientation_ == 1 ? 0 : count * voxelBytes);
        std::byte* pixels = orientation_ == 1 ? target : stored.data();
        const glm::ivec2 size = storedSize(slice.size);
        const bool isRead =
            isGreyJpeg ? readGreyJpeg(bytes_, size.x, size.y, pixels)
                       : module_->read(file_.get(), static_cast<int>(index), channel_, pixels);
        if (!isRead) {
            return fail(ErrorCode::FileTruncated,
                        fmt::format("{}: the pixels end early or are damaged; fetch the file again",
                                    path_.string()));
        }
        if (highest_ > 0 && slice.type == VoxelType::U8) {
            narrow<std::uint8_t>(pixels, count, highest_);
        } else if (highest_ > 0 && slice.type == VoxelType::U16) {
            narrow<std::uint16_t>(pixels, count, highest_);
        }
        if (orientation_ != 1) {
            turn(pixels, slice.size, voxelBytes, target);
        }
        return {};
    }

    void rest() override {
        file_.reset();
        bytes_ = {};
    }

private:
    void take(std::ifstream& file) {
        file.seekg(0, std::ios::end);
        const auto size = static_cast<std::streamoff>(file.tellg());
        file.seekg(0);
        bytes_.resize(static_cast<std::size_t>(std::max<std::streamoff>(size, 0)));
        file.read(bytes_.data(), static_cast<std::streamsize>(bytes_.size()));
        bytes_.resize(static_cast<std::size_t>(file.gcount()));
    }

    /// For the pixels of a slice. The file must not have become another since it was looked at.
    Result<void> openAgain(bool bytesAlone, std::size_t index) {
        if (bytes_.empty()) {
            std::ifstream file(path_, std::ios::binary);
            take(file);
        }
        if (bytesAlone || file_) {
            return {};
        }
        return openImage().and_then([&]() -> Result<void> {
            const ImageSlice& slice = facts_.slices[index];
            const glm::ivec2 size = storedSize(slice.size);
            ImagePage page;
            const bool isSame = module_->describe(file_.get(), static_cast<int>(index), &page) &&
                                glm::ivec2(page.width, page.height) == size &&
                                page.type == slice.type && channel_ < page.channels;
            return isSame ? Result<void>()
                          : fail(ErrorCode::FileUnreadable,
                                 fmt::format("{}: changed while it was read; read it again",
                                             path_.string()));
        });
    }

    Result<void> openImage() {
        file_ = {module_->open(path_.c_str(), bytes_.data(), bytes_.size()), module_->close};
        if (!file_) {
            const std::string ending = lowerCase(path_.extension().string());
            const bool isTiffByName = ending == ".tif" || ending == ".tiff";
            return fail(ErrorCode::FileUnreadable,
                        fmt::format("{}: is {}no image that is read; check what the file holds",
                                    path_.string(), isTiffByName ? "no TIFF and " : ""));
        }
        return {};
    }

    Result<void> describe(const ImageChoice& choice, double fileBytes) {
        if (choice.time && *choice.time != 0) {
            return fail(ErrorCode::InvalidArgument,
                        fmt::format("{}: has no volume at time {}; --time takes 0 alone",
                                    path_.string(), *choice.time));
        }
        ImagePage page;
        double pixelBytes = 0.0;
        for (int index = 0; module_->describe(file_.get(), index, &page); ++index) {
            if (const Result<void> taken = take(index, page, choice); !taken) {
                return taken;
            }
            pixelBytes += static_cast<double>(page.width) * page.height *
                          static_cast<double>(bytesPerVoxel(page.type));
        }
        if (facts_.slices.empty()) {
            return fail(
                ErrorCode::FileUnreadable,
                fmt::format("{}: holds no image; check what the file holds", path_.string()));
        }
        constexpr double kMost = 4096.0; // no compression of these formats makes less of more
        if (pixelBytes > kMost * fileBytes) {
            return fail(
                ErrorCode::FileTruncated,
                fmt::format("{}: has more pixels than its {:.0f} bytes can hold: it was cut "
                            "off or is damaged; fetch it again",
                            path_.string(), fileBytes));
        }
        return {};
    }

    Result<void> take(int index, const ImagePage& page, const ImageChoice& choice) {
        const Result<std::int64_t> channel = chosenChannel(path_, choice, page.channels, true);
        if (!channel) {
            return tl::unexpected(channel.error());
        }
        if (!page.isReadable) {
            return fail(
                ErrorCode::UnsupportedType,
                fmt::format("{}: pixels of type '{}' are not read; convert them to an integer "
                            "of 8 to 32 bits, float or double",
                            path_.string(), page.typeName));
        }
        if (page.width < 1 || page.height < 1) {
            return fail(ErrorCode::EmptyVolume,
                        fmt::format("{}: has no pixels; take it away", path_.string()));
        }
        const bool isTransposed = page.orientation >= 5 && page.orientation <= 8;
        if (index == 0) {
            channel_ = static_cast<int>(*channel);
            channels_ = page.channels;
            orientation_ = page.orientation >= 1 && page.orientation <= 8 ? page.orientation : 1;
            const ImageLengths lengths = lengthsFrom(page.resolution, page.resolutionUnit);
            facts_.spacingMm =
                isTransposed ? glm::dvec3(lengths.mm.y, lengths.mm.x, lengths.mm.z) : lengths.mm;
            facts_.spacingNote = lengths.note;
        }
        facts_.slices.push_back({.page = index + 1,
                                 .size = isTransposed ? glm::ivec2(page.height, page.width)
                                                      : glm::ivec2(page.width, page.height),
                                 .type = page.type});
        return {};
    }

    glm::ivec2 storedSize(glm::ivec2 size) const {
        return orientation_ >= 5 ? glm::ivec2(size.y, size.x) : size;
    }

    void turn(const std::byte* stored, glm::ivec2 size, std::size_t voxelBytes,
              std::byte* target) const {
        const glm::ivec2 from = storedSize(size);
        const Turn turn = turnOf(orientation_, from.x, from.y);
        for (int y = 0; y < from.y; ++y) {
            for (int x = 0; x < from.x; ++x) {
                const std::ptrdiff_t at = turn.at + y * turn.rowStep + x * turn.columnStep;
                std::memcpy(target + at * static_cast<std::ptrdiff_t>(voxelBytes), stored,
                            voxelBytes);
                stored += voxelBytes;
            }
        }
    }

    std::filesystem::path path_;
    const ImageModule* module_ = nullptr;
    std::string bytes_; // of the whole file, outlive file_
    std::unique_ptr<ImageFile, void (*)(ImageFile*) noexcept> file_;
    int highest_ = 0;
    bool isJpeg_ = false;
    int channels_ = 1;
    int channel_ = 0;
    int orientation_ = 1; // the first page's
    ImageFacts facts_;
};

} // namespace

Result<std::unique_ptr<ImageSource>> openOtherImage(const std::filesystem::path& path,
                                                    std::ifstream file, const ImageChoice& choice) {
    auto source = std::make_unique<ModuleSource>(path);
    return source->open(std::move(file), choice).map([&] {
        return std::unique_ptr<ImageSource>(std::move(source));
    });
}

} // namespace slabcast
