#include "platform/io/dicom/dicom_series.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <map>
#include <optional>

#include <fmt/format.h>

#include "platform/io/base/parse_text.h"
#include "platform/io/base/readers.h"
#include "platform/io/dicom/dicom_dataset.h"

namespace slabcast {

namespace {

constexpr int kDeepest = 12;
constexpr std::size_t kMostFiles = 100000;

using Paths = std::vector<std::filesystem::path>;

struct Broken {
    Error error;
    std::string series; // empty: not known
};

struct Content {
    std::map<std::string, std::vector<DicomFile>> series;
    std::vector<DicomFile> withoutPixels;
    std::vector<Broken> broken;
    Paths suspects; // neither DICOM nor plainly something else
};

bool isHidden(const std::filesystem::path& path) {
    return path.filename().string().starts_with('.');
}

Paths filesIn(const std::filesystem::path& folder) {
    std::error_code error;
    Paths files;
    for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
        if (entry.is_regular_file(error) && !isHidden(entry.path())) {
            files.push_back(entry.path());
        }
    }
    return files;
}

Paths filesBelow(const std::filesystem::path& folder) {
    std::error_code error;
    Paths files;
    auto entry = std::filesystem::recursive_directory_iterator(
        folder, std::filesystem::directory_options::skip_permission_denied, error);
    for (; !error && entry != std::filesystem::end(entry); entry.increment(error)) {
        if (isHidden(entry->path()) || entry.depth() >= kDeepest) {
            entry.disable_recursion_pending();
        } else if (entry.depth() > 0 && entry->is_regular_file(error)) {
            files.push_back(entry->path());
        }
        if (files.size() >= kMostFiles) {
            break;
        }
    }
    return files;
}

void sortNaturally(Paths& files) {
    std::sort(files.begin(), files.end(),
              [](const auto& a, const auto& b) { return naturallyBefore(a.string(), b.string()); });
}

std::string endingOf(const std::filesystem::path& path) {
    const std::string ending = lowerCase(path.extension().string());
    const bool isNumber = std::all_of(ending.begin(), ending.end(),
                                      [](char c) { return c == '.' || (c >= '0' && c <= '9'); });
    return isNumber ? "" : ending; // the end of a UID
}

bool hasDicomEnding(const std::filesystem::path& path) {
    const std::string ending = endingOf(path);
    return ending == ".dcm" || ending == ".dicom" || ending == ".ima";
}

/// What lies beside slices and is none, by its name.
bool isPlainlyOther(const std::filesystem::path& path) {
    constexpr std::array kEndings = {".txt", ".xml",  ".json", ".csv", ".pdf", ".htm", ".html",
                                     ".md",  ".png",  ".jpg",  ".gif", ".bmp", ".tif", ".tiff",
                                     ".zip", ".gz",   ".exe",  ".dll", ".inf", ".ini", ".db",
                                     ".log", ".jpeg", ".nii",  ".bat", ".sh",  ".py",  ".js"};
    const std::string ending = endingOf(path);
    return std::find(kEndings.begin(), kEndings.end(), ending) != kEndings.end();
}

/// Empty, or so short that no mark fits and nothing but zeros: what is left of a DICOM file.
bool isRemnant(const std::filesystem::path& path) {
    constexpr std::uintmax_t kPreambleBytes = 128;
    std::error_code error;
    if (std::filesystem::file_size(path, error) > kPreambleBytes + 4 || error) {
        return false;
    }
    std::ifstream file(path, std::ios::binary);
    const std::string bytes((std::istreambuf_iterator<char>(file)), {});
    return std::all_of(bytes.begin(), bytes.end(), [](char c) { return c == '\0'; });
}

void add(Content& content, DicomFile file) {
    constexpr const char* kIndex = "1.2.840.10008.1.3.10";
    if (file.hasPixels) {
        content.series[file.series].push_back(std::move(file));
    } else if (file.series.empty() && file.sopClass != kIndex) {
        content.broken.push_back(
            {{ErrorCode::FileTruncated,
              fmt::format("{}: is cut off within its header, or has neither series nor pixels; "
                          "fetch the file again, or move it away",
                          file.path.string())},
             ""});
    } else {
        content.withoutPixels.push_back(std::move(file));
    }
}

/// `everyFile`: also those that neither mark nor name gives away.
Result<Content> contentOf(Paths files, const LoadOptions& options, bool everyFile) {
    sortNaturally(files);
    double done = 0.0; // headers are a part of all work, pixels the rest
    std::vector<std::string> keys;
    for (const Selection& selection : options.select) {
        keys.push_back(selection.key);
    }
    Content content;
    for (const std::filesystem::path& path : files) {
        if (const Result<void> goes = going(options, path, done); !goes) {
            return tl::unexpected(goes.error());
        }
        done += kHeadersShare / static_cast<double>(files.size());
        const bool unmarkedToo =
            !isPlainlyOther(path) && !isRemnant(path) && (everyFile || hasDicomEnding(path));
        Result<std::optional<DicomFile>> file =
            unmarkedToo ? openDicomFile(path, keys).map([](DicomFile&& any) {
                return std::optional(std::move(any));
            })
                        : openMarkedDicomFile(path, keys);
        if (file && *file) {
            add(content, **std::move(file));
        } else if (file && !isPlainlyOther(path)) {
            content.suspects.push_back(path);
        } else if (!file && (hasDicomEnding(path) || hasDicomMark(path))) {
            content.broken.push_back({file.error(), ""});
        }
    }
    return content;
}

/// Remnants among images are slices that were lost in copying, if they are named like one.
void judgeSuspects(Content& content) {
    for (const std::filesystem::path& path : content.suspects) {
        const bool isNamedAlike =
            std::any_of(content.series.begin(), content.series.end(), [&](const auto& entry) {
                const std::filesystem::path& other = entry.second.front().path;
                return other.parent_path() == path.parent_path() &&
                       endingOf(other) == endingOf(path);
            });
        if (isRemnant(path) && (hasDicomEnding(path) || isNamedAlike)) {
            std::error_code error;
            const bool isEmpty = std::filesystem::file_size(path, error) == 0;
            content.broken.push_back(
                {{ErrorCode::FileTruncated,
                  fmt::format("{}: {}; fetch the file again, or move it away", path.string(),
                              isEmpty ? "is empty" : "is cut off before its header")},
                 ""});
        }
    }
}

std::string listOfSeries(const Content& content, const std::filesystem::path& folder) {
    std::string list;
    for (const auto& [uid, files] : content.series) {
        const std::string& description = files.front().description;
        const std::filesystem::path parent = files.front().path.parent_path();
        list += fmt::format(
            "{}{} ({}, {} {}{})", list.empty() ? "" : ", ", uid.empty() ? "without UID" : uid,
            description.empty() ? "no description" : "'" + description + "'", files.size(),
            files.size() == 1 ? "file" : "files",
            parent == folder ? "" : ", in " + parent.lexically_relative(folder).string());
    }
    return list;
}

/// A file without pixels is passed over, unless it belongs to the series.
std::optional<Error> damageTo(const Content& content, const std::string& series) {
    for (const Broken& broken : content.broken) {
        if (broken.series.empty() || broken.series == series) {
            return broken.error;
        }
    }
    for (const DicomFile& file : content.withoutPixels) {
        if (file.series == series) {
            return Error{ErrorCode::FileUnreadable,
                         fmt::format("{}: belongs to the series and has no pixels; fetch the file "
                                     "again, or move it away",
                                     file.path.string())};
        }
    }
    return std::nullopt;
}

Error withoutImages(const std::filesystem::path& folder, const Content& content) {
    if (!content.broken.empty()) {
        return content.broken.front().error;
    }
    const std::string others =
        content.withoutPixels.empty()
            ? ""
            : fmt::format(" ({} {})", content.withoutPixels.front().path.filename().string(),
                          describeWithoutPixels(content.withoutPixels.front()));
    return {ErrorCode::EmptyFolder,
            fmt::format("{}: holds no DICOM images{}; name a folder with the slices of one series",
                        folder.string(), others)};
}

} // namespace

Result<DicomSeries> findDicomSeries(const std::filesystem::path& folder,
                                    const LoadOptions& options) {
    Result<Content> found = contentOf(filesIn(folder), options, true);
    if (!found) {
        return tl::unexpected(found.error());
    }
    Content content = std::move(*found);
    bool isBelow = false;
    if (content.series.empty() && content.broken.empty()) {
        Result<Content> below = contentOf(filesBelow(folder), options, false);
        if (!below) {
            return tl::unexpected(below.error());
        }
        isBelow = !below->series.empty() || !below->broken.empty();
        if (isBelow) {
            content = std::move(*below);
        }
    }
    judgeSuspects(content);
    if (content.series.empty()) {
        return tl::unexpected(withoutImages(folder, content));
    }
    if (options.series.empty() && content.series.size() > 1) {
        return fail(ErrorCode::AmbiguousSeries,
                    fmt::format("{}: holds {} DICOM series: {}; choose one with --series UID",
                                folder.string(), content.series.size(),
                                listOfSeries(content, folder)));
    }
    const auto chosen =
        options.series.empty() ? content.series.begin() : content.series.find(options.series);
    if (chosen == content.series.end()) {
        return fail(ErrorCode::InvalidArgument,
                    fmt::format("{}: holds no series {}; --series may be one of: {}",
                                folder.string(), options.series, listOfSeries(content, folder)));
    }
    if (const std::optional<Error> damage = damageTo(content, chosen->first)) {
        return tl::unexpected(*damage);
    }
    DicomSeries series{std::move(chosen->second), {}};
    if (isBelow) {
        series.notes.push_back(fmt::format(
            "read from the sub-folder {}",
            series.files.front().path.parent_path().lexically_relative(folder).string()));
    }
    return series;
}

bool hasSiblings(const DicomFile& file) {
    Paths files = filesIn(file.path.parent_path().empty() ? "." : file.path.parent_path());
    return std::any_of(files.begin(), files.end(), [&](const std::filesystem::path& path) {
        if (path.filename() == file.path.filename()) {
            return false;
        }
        const Result<std::optional<DicomFile>> other = openMarkedDicomFile(path, {});
        return other && *other && (*other)->hasPixels && (*other)->series == file.series;
    });
}

} // namespace slabcast
