#include <algorithm>
#include <set>

#include <fmt/format.h>

#include "platform/io/base/readers.h"
#include "platform/io/dicom/dicom_choice.h"
#include "platform/io/dicom/dicom_dataset.h"
#include "platform/io/dicom/dicom_file.h"
#include "platform/io/dicom/dicom_pixels.h"
#include "platform/io/dicom/dicom_series.h"
#include "platform/io/dicom/dicom_stack.h"
#include "platform/io/dicom/dicom_values.h"

namespace slabcast {

namespace {

DicomImages imagesOf(const std::vector<DicomFile>& files) {
    DicomImages images;
    for (const DicomFile& file : files) {
        for (std::size_t i = 0; i < file.frames.size(); ++i) {
            images.push_back({.file = &file, .index = static_cast<int>(i)});
        }
    }
    return images;
}

Result<void> checkFaults(const DicomImages& images) {
    for (const DicomImage& image : images) {
        if (image.file->fault) {
            return tl::unexpected(*image.file->fault);
        }
    }
    return {};
}

Result<void> checkSeveral(const std::filesystem::path& where, const DicomImages& images) {
    return images.size() > 1 ? Result<void>{}
                             : fail(ErrorCode::UnsupportedDims,
                                    fmt::format("{}: one image is left ({}), and a volume needs "
                                                "several; name a folder with the whole series, or "
                                                "select less narrowly",
                                                where.string(), images.front().name(where)));
}

/// Reads image by image, each file once: those of one file follow each other in its own order.
Result<void> readPixels(const DicomImages& images, DicomVoxels& voxels,
                        const LoadOptions& options) {
    std::vector<std::size_t> order(images.size());
    for (std::size_t i = 0; i < order.size(); ++i) {
        order[i] = i;
    }
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return images[a].file != images[b].file ? images[a].file < images[b].file
                                                : images[a].index < images[b].index;
    });
    std::optional<DicomPixels> opened;
    const DicomFile* file = nullptr;
    std::vector<std::byte> cells;
    double done = kHeadersShare;
    for (const std::size_t slice : order) {
        const DicomImage& image = images[slice];
        if (const Result<void> goes = going(options, image.file->path, done); !goes) {
            return goes;
        }
        done += (1.0 - kHeadersShare) / static_cast<double>(images.size());
        if (image.file != file) {
            Result<DicomPixels> pixels = DicomPixels::open(*image.file);
            if (!pixels) {
                return tl::unexpected(pixels.error());
            }
            opened = std::move(*pixels);
            file = image.file;
        }
        if (const Result<void> read = opened->read(image.index, cells); !read) {
            return read;
        }
        voxels.put(slice, image, cells);
    }
    voxels.fillPadding();
    return {};
}

void addNotes(Volume& volume, const DicomImages& images) {
    for (const DicomImage& image : images) {
        for (const std::string& note : image.file->notes) {
            if (std::find(volume.notes.begin(), volume.notes.end(), note) == volume.notes.end()) {
                volume.notes.push_back(note);
            }
        }
    }
}

/// One volume from all images of these files. Messages name `where`, or the file at fault.
Result<Volume> readImages(const std::filesystem::path& where, const std::vector<DicomFile>& files,
                          const LoadOptions& options) {
    Volume volume;
    volume.name = where.filename().string();
    Result<DicomImages> images = selectImages(where, imagesOf(files), options);
    if (!images) {
        return tl::unexpected(images.error());
    }
    const Result<void> alike =
        checkFaults(*images)
            .and_then([&] { return checkSeveral(where, *images); })
            .and_then([&] { return checkSameSize(where, *images); })
            .and_then([&] { return placeImages(where, *images, options, volume.notes); })
            .and_then([&] { return checkSamePlane(where, *images); });
    if (!alike) {
        return tl::unexpected(alike.error());
    }
    setAlongNormal(*images);
    images = onePerPlace(where, std::move(*images), options);
    if (!images) {
        return tl::unexpected(images.error());
    }
    const Result<DicomStack> stack =
        checkSeveral(where, *images).and_then([&] { return stackImages(where, *images, options); });
    if (!stack) {
        return tl::unexpected(stack.error());
    }
    volume.geometry = stack->geometry;
    const DicomFile& first = *images->front().file;
    volume.unit = first.unit;
    volume.modality = first.modality == "CT"   ? Modality::Ct
                      : first.modality == "MR" ? Modality::Mr
                                               : Modality::Unknown;
    addNotes(volume, *images);
    const Result<void> read =
        DicomVoxels::inside(volume, *images, options).and_then([&](DicomVoxels voxels) {
            return readPixels(*images, voxels, options);
        });
    if (!read) {
        return tl::unexpected(read.error());
    }
    return stack->isEven ? std::move(volume)
                         : resampledEvenly(where, std::move(volume), *stack, options);
}

std::vector<std::string> keysOf(const LoadOptions& options) {
    std::vector<std::string> keys;
    for (const Selection& selection : options.select) {
        keys.push_back(selection.key);
    }
    return keys;
}

Error unreadable(const std::filesystem::path& path, const std::exception& exception) {
    return {ErrorCode::FileUnreadable,
            fmt::format("{}: {}; close other programs or take a smaller volume", path.string(),
                        exception.what())};
}

} // namespace

Result<Volume> readDicomFile(const std::filesystem::path& path, const LoadOptions& options) try {
    if (const Result<void> goes = going(options, path, 0.0); !goes) {
        return tl::unexpected(goes.error());
    }
    Result<DicomFile> file = openDicomFile(path, keysOf(options));
    if (!file) {
        return tl::unexpected(file.error());
    }
    if (!file->hasPixels) {
        return fail(ErrorCode::FileUnreadable,
                    fmt::format("{}: {}", path.string(), describeWithoutPixels(*file)));
    }
    if (!file->fault && file->frames.size() == 1) {
        const std::string why =
            hasSiblings(*file) ? "; name the folder that holds the series"
                               : ", and its folder holds no other of its series; export the whole "
                                 "series into one folder and name that";
        return fail(ErrorCode::UnsupportedDims,
                    fmt::format("{}: is a single slice{}", path.string(), why));
    }
    std::vector<DicomFile> files;
    files.push_back(std::move(*file));
    return readImages(path, files, options);
} catch (const std::exception& exception) {
    return tl::unexpected(unreadable(path, exception));
}

Result<Volume> readDicomSeries(const std::filesystem::path& folder,
                               const LoadOptions& options) try {
    Result<DicomSeries> series = findDicomSeries(folder, options);
    if (!series) {
        return tl::unexpected(series.error());
    }
    const std::vector<DicomFile>& files = series->files;
    if (files.size() == 1 && files.front().frames.size() == 1 && !files.front().fault) {
        return fail(ErrorCode::UnsupportedDims,
                    fmt::format("{}: holds a single slice of the series ({}), and a volume needs "
                                "several; export the whole series into this folder",
                                folder.string(), files.front().path.filename().string()));
    }
    Result<Volume> volume =
        readImages(files.size() == 1 ? files.front().path : folder, files, options);
    if (volume) {
        volume->notes.insert(volume->notes.begin(), series->notes.begin(), series->notes.end());
    }
    return volume;
} catch (const std::exception& exception) {
    return tl::unexpected(unreadable(folder, exception));
}

} // namespace slabcast
