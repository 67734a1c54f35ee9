#pragma once

#include <cstddef>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/volume/volume.h"
#include "platform/io/base/load_options.h"

namespace slabcast {

struct ImageSlice {
    int page = 1; // within its file, from 1
    glm::ivec2 size{0};
    VoxelType type = VoxelType::U8;
};

/// What a file of images says about itself. `slices` are those that were asked for, in order.
struct ImageFacts {
    std::vector<ImageSlice> slices;
    glm::dvec3 spacingMm{1.0};
    std::string spacingNote; // what was assumed of it; empty: nothing
    double slope = 1.0;
    double intercept = 0.0;
    std::string unit;
    std::string severalOf; // what there are several of beside slices, as "2 channels"; else empty
    std::vector<std::string> notes;
};

/// A file of one or more images.
class ImageSource {
public:
    virtual ~ImageSource() = default;
    virtual const ImageFacts& facts() const = 0;
    /// Pixels of slice `index` of facts(), upright. Fails: FileUnreadable, FileTruncated.
    virtual Result<void> read(std::size_t index, std::byte* target) = 0;
    /// Closes the file, or lets its bytes go, until the next read(): it is opened twice in all.
    virtual void rest() = 0;
};

/// TIFF through libtiff, all else through the module. Fails as loadVolume() does; no sizes are
/// believed that the file's own size cannot hold.
Result<std::unique_ptr<ImageSource>> openImage(const std::filesystem::path& path,
                                               const LoadOptions& options);

/// What openImage() asks of `options`: one channel and one time.
struct ImageChoice {
    std::optional<std::int64_t> channel; // from 0
    std::optional<std::int64_t> time;    // likewise
};

/// Fails: InvalidArgument (a selection by something other than the channel).
Result<ImageChoice> choiceIn(const std::filesystem::path& path, const LoadOptions& options);

/// Which of `count` channels. Fails: UnsupportedType where there are several and none is chosen;
/// InvalidArgument where there is no such one.
Result<std::int64_t> chosenChannel(const std::filesystem::path& path, const ImageChoice& choice,
                                   std::int64_t count, bool isColour);

/// One for each family of formats. `file` is open, at its beginning; it is closed again.
Result<std::unique_ptr<ImageSource>> openTiff(const std::filesystem::path& path, std::ifstream file,
                                              const ImageChoice& choice);
Result<std::unique_ptr<ImageSource>> openOtherImage(const std::filesystem::path& path,
                                                    std::ifstream file, const ImageChoice& choice);

/// Millimetres from what an image states, with a note of what was assumed.
struct ImageLengths {
    glm::dvec3 mm{1.0};
    std::string note;
};

/// Resolutions in pixels per unit: 1 none, 2 inch, 3 centimetre. Those in inches and those usual in
/// print are not believed. Tested by: io_images_test.cpp
ImageLengths lengthsFrom(const double (&resolution)[2], int unit);

} // namespace slabcast
