// TIFF as a source of slices: which pages are slices, and what they mean.
#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "platform/io/pictures/image_source.h"
#include "platform/io/pictures/image_statement.h"
#include "platform/io/pictures/tiff_directory.h"
#include "platform/io/pictures/tiff_pages.h"

namespace slabcast {

namespace {

/// "page 1 is a reduced copy: left out"
std::string leftOut(const std::vector<int>& pages, const char* one, const char* several) {
    if (pages.size() == 1) {
        return fmt::format("page {} is {}: left out", pages.front(), one);
    }
    std::string list;
    for (std::size_t i = 0; i < std::min<std::size_t>(pages.size(), 4); ++i) {
        list += fmt::format("{}{}", i == 0 ? "" : ", ", pages[i]);
    }
    return fmt::format("pages {}{} are {}: left out", list,
                       pages.size() > 4 ? fmt::format(" and {} more", pages.size() - 4) : "",
                       several);
}

/// Pages of the file in the order of their channel, slice and time.
struct PageOrder {
    std::int64_t channels = 1;
    std::int64_t slices = 1;
    std::int64_t frames = 1;
    std::string order = "CZT";
    std::vector<std::int64_t> pages; // by place, where the file says so page by page

    std::int64_t pageOf(std::int64_t channel, std::int64_t slice, std::int64_t frame) const {
        std::int64_t place = 0;
        std::int64_t step = 1;
        for (const char axis : order) {
            place += step * (axis == 'C' ? channel : axis == 'Z' ? slice : frame);
            step *= axis == 'C' ? channels : axis == 'Z' ? slices : frames;
        }
        return pages.empty() ? place : pages[place];
    }
};

/// Empty where the list says nothing, or nothing that holds.
std::vector<std::int64_t> listedPages(const ImageStatement& statement, PageOrder order) {
    const std::int64_t count = order.channels * order.slices * order.frames;
    std::vector<std::int64_t> pages(count, -1);
    order.pages.clear();
    for (const ImageStatement::Place& place : statement.places) {
        if (place.channel >= order.channels || place.slice >= order.slices ||
            place.frame >= order.frames) {
            return {};
        }
        const std::int64_t first = order.pageOf(place.channel, place.slice, place.frame);
        const std::int64_t last = place.count == 0 ? count : std::min(count, first + place.count);
        for (std::int64_t i = first; i < last; ++i) {
            pages[i] = place.page + i - first;
        }
    }
    const bool isWhole = std::all_of(pages.begin(), pages.end(),
                                     [&](std::int64_t page) { return page >= 0 && page < count; });
    return isWhole ? pages : std::vector<std::int64_t>();
}

class TiffSource : public ImageSource {
public:
    explicit TiffSource(std::filesystem::path path) : path_(std::move(path)) {}

    /// Once, before anything else.
    Result<void> open(std::ifstream stream, const ImageChoice& choice) {
        Result<TiffFile> file = readTiffDirectories(path_, std::move(stream));
        if (!file) {
            return tl::unexpected(file.error());
        }
        file_ = std::move(*file);
        keepSlices();
        statement_ = parseStatement(file_.description, file_.pages.front().resolution);
        return checkBytes()
            .and_then([&] { return orderPages(); })
            .and_then([&](const PageOrder& order) { return chooseSlices(order, choice); })
            .map([&] { takeMeaning(); });
    }

    const ImageFacts& facts() const override { return facts_; }

    Result<void> read(std::size_t index, std::byte* target) override {
        if (!pages_) {
            Result<TiffPages> pages = TiffPages::open(path_, file_);
            if (!pages) {
                return tl::unexpected(pages.error());
            }
            pages_ = std::move(*pages);
        }
        return pages_->read(file_.pages[picks_[index].directory], picks_[index].pick, target);
    }

    void rest() override { pages_.reset(); }

private:
    struct Pick {
        std::size_t directory;
        TiffPick pick;
    };

    const TiffDirectory& first() const { return file_.pages.front(); }

    /// Takes reduced copies and masks out, unless there is nothing else.
    void keepSlices() {
        const auto isSlice = [](const TiffDirectory& page) {
            return !page.isReduced && !page.isMask;
        };
        if (std::none_of(file_.pages.begin(), file_.pages.end(), isSlice)) {
            return;
        }
        std::vector<int> reduced;
        std::vector<int> masks;
        for (const TiffDirectory& page : file_.pages) {
            if (page.isMask) {
                masks.push_back(page.page);
            } else if (page.isReduced) {
                reduced.push_back(page.page);
            }
        }
        std::erase_if(file_.pages, [&](const TiffDirectory& page) { return !isSlice(page); });
        if (!reduced.empty()) {
            facts_.notes.push_back(leftOut(reduced, "a reduced copy", "reduced copies"));
        }
        if (!masks.empty()) {
            facts_.notes.push_back(leftOut(masks, "a mask", "masks"));
        }
    }

    /// Pages that share their bytes could ask for any number of pixels.
    Result<void> checkBytes() const {
        double all = 0.0;
        for (const TiffDirectory& page : file_.pages) {
            const double pixels = static_cast<double>(page.rowBytes()) * page.height;
            const auto stored = static_cast<double>(page.storedBytes);
            all += page.compression == 1 ? std::min(pixels, stored) : stored;
        }
        if (all > static_cast<double>(file_.byteCount)) {
            return fail(ErrorCode::FileUnreadable,
                        fmt::format("{}: its {} pages lie over one another: the file is damaged; "
                                    "fetch it again",
                                    path_.string(), file_.pages.size()));
        }
        return {};
    }

    /// How many images lie behind the only directory, as ImageJ writes files beyond 4 GiB.
    std::int64_t imagesBehindOne() const {
        const bool isImageJ = statement_.program == ImageStatement::Program::ImageJ;
        return isImageJ && file_.pages.size() == 1 ? std::max<std::int64_t>(statement_.images, 1)
                                                   : 1;
    }

    Result<PageOrder> orderPages() const {
        const std::int64_t behindOne = imagesBehindOne();
        if (behindOne > 1) {
            const double bytes = static_cast<double>(first().rowBytes()) * first().height;
            if (!first().isOnePiece || first().compression != 1 || first().isReversed) {
                return fail(ErrorCode::UnsupportedDims,
                            fmt::format("{}: ImageJ says that it has {} images, and it holds one; "
                                        "save it again from ImageJ",
                                        path_.string(), behindOne));
            }
            if (bytes * static_cast<double>(behindOne) >
                static_cast<double>(file_.byteCount - first().pixelsAt)) {
                return fail(ErrorCode::FileTruncated,
                            fmt::format("{}: the file ends before the last of its {} images does; "
                                        "fetch it again",
                                        path_.string(), behindOne));
            }
        }
        const auto pages = std::max(static_cast<std::int64_t>(file_.pages.size()), behindOne);
        PageOrder order;
        order.slices = pages;
        if (statement_.program == ImageStatement::Program::Unknown) {
            return order;
        }
        if (statement_.volumes > 1) {
            return fail(ErrorCode::UnsupportedDims,
                        fmt::format("{}: holds {} images of OME, each a volume of its own; save "
                                    "the one that is meant to a file of its own",
                                    path_.string(), statement_.volumes));
        }
        order.channels = statement_.channels;
        const bool isSampled = statement_.program == ImageStatement::Program::Ome &&
                               order.channels % first().samples == 0;
        order.channels /= isSampled ? first().samples : 1;
        order.frames = statement_.frames;
        order.order = statement_.order;
        const std::int64_t perSlice = order.channels * order.frames;
        order.slices = statement_.slices > 0 ? statement_.slices : pages / perSlice;
        if (perSlice > 1 && order.slices * perSlice != pages) {
            return fail(ErrorCode::UnsupportedDims,
                        fmt::format("{}: says that it has {} channels x {} slices x {} times, and "
                                    "holds {} pages; save each channel to a file of its own",
                                    path_.string(), order.channels, order.slices, order.frames,
                                    pages));
        }
        order.slices = perSlice > 1 ? order.slices : pages;
        if (facts_.notes.empty() && order.slices * perSlice == pages) {
            order.pages = listedPages(statement_, order);
        }
        return order;
    }

    Result<void> chooseSlices(const PageOrder& order, const ImageChoice& choice) {
        const int samples = first().samples;
        const std::int64_t channels = order.channels * samples;
        if (order.slices == 1 && order.channels * order.frames > 1) {
            facts_.severalOf = order.channels > 1 ? fmt::format("{} channels", order.channels)
                                                  : fmt::format("{} times", order.frames);
        }
        const Result<std::int64_t> channel =
            chosenChannel(path_, choice, channels, samples > 1 && order.channels == 1);
        if (!channel) {
            // Slices that were marked as channels would form no volume either way.
            return facts_.severalOf.empty() || samples > 1
                       ? Result<void>(tl::unexpected(channel.error()))
                       : chooseAll(order);
        }
        if (choice.time && (*choice.time < 0 || *choice.time >= order.frames)) {
            return fail(ErrorCode::InvalidArgument,
                        fmt::format("{}: has no volume at time {}; --time takes 0 to {}",
                                    path_.string(), *choice.time, order.frames - 1));
        }
        if (order.frames > 1 && !choice.time) {
            return !facts_.severalOf.empty()
                       ? chooseAll(order)
                       : fail(ErrorCode::AmbiguousSeries,
                              fmt::format("{}: holds {} volumes over time; take one with --time N, "
                                          "from 0 to {}",
                                          path_.string(), order.frames, order.frames - 1));
        }
        for (std::int64_t slice = 0; slice < order.slices; ++slice) {
            const std::int64_t page =
                order.pageOf(*channel / samples, slice, choice.time.value_or(0));
            if (const Result<void> taken = take(page, static_cast<int>(*channel % samples));
                !taken) {
                return taken;
            }
        }
        return {};
    }

    /// The caller refuses them in words, with `severalOf`.
    Result<void> chooseAll(const PageOrder& order) { return take(order.pageOf(0, 0, 0), 0); }

    Result<void> take(std::int64_t page, int sample) {
        const bool isBehindOne = file_.pages.size() == 1 && page > 0;
        const std::size_t index = isBehindOne ? 0 : static_cast<std::size_t>(page);
        const TiffDirectory& directory = file_.pages[index];
        const Result<VoxelType> type = voxelTypeOf(path_, directory);
        if (!type) {
            return tl::unexpected(type.error());
        }
        if (directory.samples != first().samples) {
            return fail(ErrorCode::UnsupportedType,
                        fmt::format("{}: page {} has {} channels, where the first slice has {}; "
                                    "take away what does not belong to the stack",
                                    path_.string(), directory.page, directory.samples,
                                    first().samples));
        }
        TiffPick pick{.sample = sample, .image = isBehindOne ? page : 0};
        pick.becomesSigned = *type == VoxelType::U16 && directory.bits == 16 &&
                             statement_.slope == 1.0 && statement_.intercept == -32768.0;
        picks_.push_back({index, pick});
        facts_.slices.push_back({.page = isBehindOne ? static_cast<int>(page) + 1 : directory.page,
                                 .size = turnedSize(directory),
                                 .type = pick.becomesSigned ? VoxelType::I16 : *type});
        return {};
    }

    void takeMeaning() {
        const bool isExact = !picks_.empty() && picks_.front().pick.becomesSigned;
        facts_.slope = isExact ? 1.0 : statement_.slope;
        facts_.intercept = isExact ? 0.0 : statement_.intercept;
        facts_.unit = statement_.unit;
        facts_.notes.insert(facts_.notes.end(), statement_.notes.begin(), statement_.notes.end());
        if (first().photometric == 3) {
            facts_.notes.emplace_back(
                "its table of colours is left out: values are the numbers of colours");
        }
        if (first().photometric == 0 && (first().format == 2 || first().format == 3)) {
            facts_.notes.emplace_back("says that the lowest value is white, which is left aside: "
                                      "values are as stored");
        }
        takeLengths();
    }

    void takeLengths() {
        const double resolution[2] = {first().resolution[0], first().resolution[1]};
        const std::array<double, 3>& stated = statement_.lengthsMm;
        ImageLengths lengths;
        if (stated[0] <= 0.0 || stated[1] <= 0.0) {
            const bool isImageJ = statement_.program == ImageStatement::Program::ImageJ;
            // ImageJ's resolutions count in its own unit, and without one in pixels.
            lengths = lengthsFrom(resolution, isImageJ && first().resolutionUnit != 3
                                                  ? std::min(first().resolutionUnit, 2)
                                                  : first().resolutionUnit);
        } else if (statement_.isWithoutUnit) {
            lengths = {.mm = {stated[0], stated[1], stated[2]},
                       .note = fmt::format("states voxels of 1 x 1 x {:.6g} pixels without a unit: "
                                           "mm are assumed; --spacing X,Y,Z gives their size",
                                           stated[2])};
        } else {
            lengths.mm = {stated[0], stated[1], stated[2] > 0.0 ? stated[2] : stated[0]};
            if (stated[2] <= 0.0) {
                lengths.note = fmt::format("states no distance of slices: {:.6g} mm is assumed, as "
                                           "within them; --spacing X,Y,Z gives it",
                                           stated[0]);
            }
        }
        if (first().orientation >= 5) {
            std::swap(lengths.mm.x, lengths.mm.y);
        }
        facts_.spacingMm = lengths.mm;
        facts_.spacingNote = lengths.note;
    }

    std::filesystem::path path_;
    TiffFile file_; // without what is left out
    ImageStatement statement_;
    std::vector<Pick> picks_; // as facts_.slices
    ImageFacts facts_;
    std::optional<TiffPages> pages_;
};

} // namespace

Result<std::unique_ptr<ImageSource>> openTiff(const std::filesystem::path& path, std::ifstream file,
                                              const ImageChoice& choice) {
    auto source = std::make_unique<TiffSource>(path);
    return source->open(std::move(file), choice).map([&] {
        return std::unique_ptr<ImageSource>(std::move(source));
    });
}

} // namespace slabcast
