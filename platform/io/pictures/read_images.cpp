#include <algorithm>
#include <array>
#include <map>
#include <memory>

#include <fmt/format.h>

#include "platform/io/base/parse_text.h"
#include "platform/io/base/readers.h"
#include "platform/io/pictures/image_order.h"
#include "platform/io/pictures/image_source.h"

namespace slabcast {

namespace {

struct StackFile {
    std::filesystem::path path;
    std::unique_ptr<ImageSource> source;
};

Result<std::vector<StackFile>> lookAt(const std::vector<std::filesystem::path>& paths,
                                      const LoadOptions& options) {
    std::vector<StackFile> files;
    for (const std::filesystem::path& path : paths) {
        Result<std::unique_ptr<ImageSource>> source =
            going(options, path, 0.0).and_then([&] { return openImage(path, options); });
        if (!source) {
            return tl::unexpected(source.error());
        }
        (*source)->rest(); // there may be more than can be open, or kept, at once
        files.push_back({path, std::move(*source)});
    }
    return files;
}

struct Kind {
    glm::ivec2 size;
    VoxelType type;

    bool operator==(const Kind& other) const { return size == other.size && type == other.type; }
};

/// Of all slices; of equally many, that of the first.
Kind mostCommonKind(const std::vector<StackFile>& files) {
    std::vector<std::pair<Kind, std::size_t>> kinds;
    for (const StackFile& file : files) {
        for (const ImageSlice& slice : file.source->facts().slices) {
            const Kind kind{slice.size, slice.type};
            const auto found = std::find_if(kinds.begin(), kinds.end(),
                                            [&](const auto& entry) { return entry.first == kind; });
            if (found == kinds.end()) {
                kinds.emplace_back(kind, 1);
            } else {
                ++found->second;
            }
        }
    }
    return std::max_element(kinds.begin(), kinds.end(),
                            [](const auto& a, const auto& b) { return a.second < b.second; })
        ->first;
}

/// Fails: InvalidGeometry, naming the one that differs.
Result<void> checkKind(const std::vector<StackFile>& files, const Kind& kind) {
    for (const StackFile& file : files) {
        const ImageFacts& facts = file.source->facts();
        for (const ImageSlice& slice : facts.slices) {
            if (!(Kind{slice.size, slice.type} == kind)) {
                const std::string page =
                    facts.slices.size() > 1 ? fmt::format("page {} has ", slice.page) : "";
                return fail(
                    ErrorCode::InvalidGeometry,
                    fmt::format("{}: {}{} x {} pixels of {}, where the other slices have "
                                "{} x {} of {}; take away what does not belong to the stack",
                                file.path.string(), page, slice.size.x, slice.size.y,
                                name(slice.type), kind.size.x, kind.size.y, name(kind.type)));
            }
        }
        const ImageFacts& first = files.front().source->facts();
        if (facts.slope != first.slope || facts.intercept != first.intercept) {
            return fail(ErrorCode::InvalidGeometry,
                        fmt::format("{}: its calibration of values differs from that of {}; save "
                                    "the stack as one file",
                                    file.path.string(), files.front().path.filename().string()));
        }
    }
    return {};
}

/// Each note once, with the file it is about where there are several.
std::vector<std::string> gatherNotes(const std::vector<StackFile>& files,
                                     const LoadOptions& options) {
    std::vector<std::string> notes;
    std::map<std::string, std::size_t> counts;
    for (const StackFile& file : files) {
        for (const std::string& note : file.source->facts().notes) {
            ++counts[note];
        }
    }
    for (const StackFile& file : files) {
        for (const std::string& note : file.source->facts().notes) {
            const auto found = counts.find(note);
            if (found == counts.end()) {
                continue;
            }
            const std::string others =
                found->second > 1 ? fmt::format(" (so in {} files)", found->second) : "";
            notes.push_back(
                files.size() == 1
                    ? note
                    : fmt::format("{}: {}{}", file.path.filename().string(), note, others));
            counts.erase(found);
        }
    }
    const std::string& spacing = files.front().source->facts().spacingNote;
    if (!spacing.empty() && !options.spacingMm) {
        notes.push_back(spacing);
    }
    return notes;
}

Result<Volume> readSlices(std::vector<StackFile> files, const LoadOptions& options) {
    std::size_t slices = 0;
    for (const StackFile& file : files) {
        slices += file.source->facts().slices.size();
    }
    const Kind kind = mostCommonKind(files);
    if (const Result<void> alike = checkKind(files, kind); !alike) {
        return tl::unexpected(alike.error());
    }
    const glm::i64vec3 dims{kind.size, slices};
    const Result<std::int64_t> bytes = checkedByteCount(dims, kind.type);
    if (!bytes) {
        return tl::unexpected(bytes.error());
    }
    const ImageFacts& facts = files.front().source->facts();
    Volume volume;
    volume.name = files.front().path.filename().string();
    volume.type = kind.type;
    volume.unit = facts.unit;
    volume.rescaleSlope = facts.slope;
    volume.rescaleIntercept = facts.intercept;
    volume.geometry.dims = dims;
    volume.geometry.spacingMm = facts.spacingMm;
    volume.notes = gatherNotes(files, options);
    if (const Result<void> wanted = admitted(options, volume); !wanted) {
        return tl::unexpected(wanted.error());
    }
    volume.voxels = makeVoxels(options, static_cast<std::size_t>(*bytes));
    const std::size_t sliceBytes = volume.voxels.size() / slices;
    std::size_t done = 0;
    for (StackFile& file : files) {
        for (std::size_t i = 0; i < file.source->facts().slices.size(); ++i) {
            const double share = static_cast<double>(done) / static_cast<double>(slices);
            const Result<void> read = going(options, file.path, share).and_then([&] {
                return file.source->read(i, volume.voxels.data() + done * sliceBytes);
            });
            if (!read) {
                return tl::unexpected(read.error());
            }
            ++done;
        }
        file.source->rest();
    }
    return volume;
}

tl::unexpected<Error> flat(const std::filesystem::path& path, const std::string& severalOf) {
    if (!severalOf.empty()) {
        return fail(ErrorCode::UnsupportedDims,
                    fmt::format("{}: says that it has {} of one slice each, and a volume has "
                                "several slices; where they are slices, say so in ImageJ (Image > "
                                "Properties) and save it again",
                                path.string(), severalOf));
    }
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

Result<Volume> readImagePages(const std::filesystem::path& path, const LoadOptions& options) {
    Result<std::vector<StackFile>> files = lookAt({path}, options);
    if (!files) {
        return tl::unexpected(files.error());
    }
    const ImageFacts& facts = files->front().source->facts();
    return facts.slices.size() == 1 ? Result<Volume>(flat(path, facts.severalOf))
                                    : readSlices(std::move(*files), options);
}

Result<Volume> readImageStack(const std::filesystem::path& folder,
                              std::vector<std::filesystem::path> paths,
                              const LoadOptions& options) {
    if (paths.size() == 1) {
        return readImagePages(paths.front(), options);
    }
    sortByNames(paths);
    if (const Result<void> alike = checkOneSeries(folder, paths); !alike) {
        return tl::unexpected(alike.error());
    }
    Result<std::vector<StackFile>> files = lookAt(paths, options);
    if (!files) {
        return tl::unexpected(files.error());
    }
    Result<Volume> volume = readSlices(std::move(*files), options);
    if (volume) {
        volume->name = folder.filename().string();
    }
    return volume;
}

} // namespace slabcast
