#include "platform/io/load_volume.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <functional>
#include <new>
#include <vector>

#include <fmt/format.h>
#include <unistd.h>

#include "platform/io/apart/read_apart.h"
#include "platform/io/base/parse_text.h"
#include "platform/io/base/readers.h"

namespace slabcast {

namespace {

struct Format {
    std::string_view ending;
    Result<Volume> (*read)(const std::filesystem::path& path, const LoadOptions& options);
};

constexpr std::array<Format, 15> kFormats = {{{".nrrd", readNrrd},
                                              {".nhdr", readNrrd},
                                              {".nii", readNifti},
                                              {".nii.gz", readNifti},
                                              {".hdr", readNifti},
                                              {".img", readNifti},
                                              {".hdr.gz", readNifti},
                                              {".img.gz", readNifti},
                                              {".mha", readMetaImage},
                                              {".mhd", readMetaImage},
                                              {".dcm", readDicomFile},
                                              {".dicom", readDicomFile},
                                              {".ima", readDicomFile},
                                              {".tif", readImagePages},
                                              {".tiff", readImagePages}}};

Result<Volume> loadFolder(const std::filesystem::path& folder, const LoadOptions& options) {
    std::error_code error;
    bool hasFolders = false;
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
        const bool isHidden = entry.path().filename().string().starts_with('.');
        if (entry.is_regular_file(error) && !isHidden) {
            files.push_back(entry.path());
        }
        hasFolders = hasFolders || (entry.is_directory(error) && !isHidden);
    }
    std::vector<std::filesystem::path> images;
    std::copy_if(files.begin(), files.end(), std::back_inserter(images), isImage);
    if (files.empty() && !hasFolders) {
        return fail(ErrorCode::EmptyFolder,
                    fmt::format("{}: holds no files; name a folder with the slices of one volume",
                                folder.string()));
    }
    std::vector<std::filesystem::path> others;
    std::copy_if(files.begin(), files.end(), std::back_inserter(others), std::not_fn(isImage));
    if (images.empty() || holdDicom(others)) { // DICOM may come without its mark
        return readDicomSeries(folder, options);
    }
    Result<Volume> stack = readImageStack(folder, images, options);
    // Looked into only now, for a stack of images needs no look at each for that.
    const bool mayBeDicom = !stack && stack.error().code != ErrorCode::Cancelled;
    return mayBeDicom && holdDicom(images) ? readDicomSeries(folder, options) : stack;
}

Result<Volume> loadFile(const std::filesystem::path& path, const LoadOptions& options) {
    const std::string name = lowerCase(path.filename().string());
    const auto format = std::find_if(kFormats.begin(), kFormats.end(), [&](const Format& entry) {
        return name.ends_with(entry.ending);
    });
    if (format != kFormats.end()) {
        return format->read(path, options);
    }
    if (holdDicom({path})) {
        return readDicomFile(path, options);
    }
    if (isImage(path)) {
        return readImagePages(path, options);
    }
    return fail(
        ErrorCode::UnsupportedType,
        fmt::format("{}: is of no known format; read are .nrrd, .nhdr, .nii, .nii.gz, .hdr, .mha, "
                    ".mhd, .tif, folders of DICOM or images, and plain voxels with --raw",
                    path.string()));
}

Result<void> checkOpens(const std::filesystem::path& path) {
    std::error_code error;
    if (!std::filesystem::exists(path, error)) {
        return fail(ErrorCode::FileNotFound,
                    fmt::format("{}: no such file or folder; check the path", path.string()));
    }
    const bool isFolder = std::filesystem::is_directory(path, error);
    if (!isFolder && !std::filesystem::is_regular_file(path, error)) { // a pipe would be waited for
        return fail(ErrorCode::FileUnreadable,
                    fmt::format("{}: is no regular file; write what it gives into one, and name "
                                "that",
                                path.string()));
    }
    if (access(path.c_str(), isFolder ? R_OK | X_OK : R_OK) != 0) { // without opening it
        return fail(ErrorCode::FileUnreadable,
                    fmt::format("{}: cannot be opened; check its permissions", path.string()));
    }
    return {};
}

Result<Volume> readHere(const std::filesystem::path& path, const LoadOptions& options) try {
    const std::filesystem::path clean =
        path.has_filename() ? path : path.parent_path(); // "folder/" has no name to give
    Result<Volume> volume = options.raw                            ? readRaw(clean, options)
                            : std::filesystem::is_directory(clean) ? loadFolder(clean, options)
                                                                   : loadFile(clean, options);
    if (volume && options.spacingMm) {
        volume->geometry.spacingMm = *options.spacingMm;
    }
    if (volume && !options.unit.empty()) {
        volume->unit = options.unit;
    }
    return std::move(volume).and_then(validated).map_error([&](Error error) {
        const bool named = error.detail.find(clean.string()) != std::string::npos;
        return named ? error
                     : Error{error.code, fmt::format("{}: {}", path.string(), error.detail)};
    });
} catch (const std::bad_alloc&) {
    return fail(ErrorCode::FileUnreadable,
                fmt::format("{}: there is not enough memory for it; close other programs or take a "
                            "smaller volume",
                            path.string()));
} catch (const std::exception& exception) { // the readers catch their libraries'
    return fail(ErrorCode::FileUnreadable,
                fmt::format("{}: {}; fetch it again, or convert it to another format",
                            path.string(), oneLine(exception.what())));
}

/// Debuggers want everything in one process, whatever the program asks for.
bool readsHere(const LoadOptions& options) {
    const char* where = std::getenv("SLABCAST_READ_IN");
    return options.process == ReadIn::ThisProcess ||
           (where != nullptr && std::string_view(where) == "this-process");
}

} // namespace

Result<Volume> loadVolume(const std::filesystem::path& path, const LoadOptions& options) {
    return checkOpens(path).and_then([&]() {
        return readsHere(options) ? readHere(path, options) : apart::readApart(path, options);
    });
}

} // namespace slabcast
