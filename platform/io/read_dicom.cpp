#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>

#include <fmt/format.h>
#include <gdcmTrace.h>
#include <itkGDCMImageIO.h>
#include <itkGDCMSeriesFileNames.h>

#include "platform/io/itk_volume.h"
#include "platform/io/parse_text.h"
#include "platform/io/readers.h"

namespace slabcast {

namespace {

constexpr double kSpacingTolerance = 0.1; // of the usual distance: scanners round positions

const char* const kSeriesDescription = "0008|103e";
const char* const kModality = "0008|0060";
const char* const kBitsAllocated = "0028|0100";

/// What matters is in the error that is returned.
void silenceLibraries() {
    gdcm::Trace::WarningOff();
    gdcm::Trace::ErrorOff();
    itk::Object::GlobalWarningDisplayOff();
}

std::string tagOf(itk::GDCMImageIO& io, const char* tag) {
    std::string value;
    io.GetValueFromTag(tag, value);
    value.erase(std::find(value.begin(), value.end(), '\0'), value.end()); // padded to even length
    return std::string(trimmed(value));
}

void setModality(Volume& volume, itk::GDCMImageIO& io) {
    const std::string modality = tagOf(io, kModality);
    volume.modality = modality == "CT"   ? Modality::Ct
                      : modality == "MR" ? Modality::Mr
                                         : Modality::Unknown;
    volume.unit = modality == "CT" ? "HU" : "";
}

/// Whether the file ends before its pixels do, which GDCM passes over in silence. Pixels that
/// lie plainly in the file are found by their tag and length; of compressed ones the decoder
/// must tell.
bool endsEarly(const std::filesystem::path& path, itk::GDCMImageIO& io) {
    constexpr std::size_t kSearchedBytes = 1 << 22; // other elements come first and are small
    const std::int64_t bits = parseInteger(tagOf(io, kBitsAllocated)).value_or(0);
    const auto length = static_cast<std::uint32_t>(io.GetDimensions(0) * io.GetDimensions(1) *
                                                   io.GetDimensions(2) * bits / 8);
    const std::uint32_t even = length + length % 2;
    const std::string lengthBytes = {static_cast<char>(even), static_cast<char>(even >> 8),
                                     static_cast<char>(even >> 16), static_cast<char>(even >> 24)};
    std::ifstream file(path, std::ios::binary);
    std::string head(kSearchedBytes, '\0');
    file.read(head.data(), kSearchedBytes);
    head.resize(static_cast<std::size_t>(file.gcount()));
    const std::string tag = "\xE0\x7F\x10" + std::string(1, '\0'); // (7FE0,0010)
    for (const std::string& representation : {std::string(), std::string("OW\0\0", 4),
                                              std::string("OB\0\0", 4)}) { // implicit, explicit
        const std::string element = tag + representation + lengthBytes;
        const std::size_t found = head.find(element);
        if (found != std::string::npos) {
            return std::filesystem::file_size(path) < found + element.size() + length;
        }
    }
    return false;
}

/// readVoxels() of a DICOM file.
Result<void> readPixels(const std::filesystem::path& path, itk::GDCMImageIO& io,
                        std::byte* voxels) {
    if (endsEarly(path, io)) {
        return fail(
            ErrorCode::FileTruncated,
            fmt::format("{}: ends before its pixels do; fetch the file again", path.string()));
    }
    return readVoxels(path, io, voxels);
}

Result<Volume> openDicom(const std::filesystem::path& path, itk::GDCMImageIO& io) {
    silenceLibraries();
    return openWithItk(path, io);
}

struct Slice {
    std::filesystem::path path;
    Volume header; // without voxels
    double alongNormalMm = 0.0;
};

std::string listOfSeries(itk::GDCMSeriesFileNames& names, const std::vector<std::string>& uids) {
    std::string list;
    for (const std::string& uid : uids) {
        const std::vector<std::string> files = names.GetFileNames(uid);
        const auto io = itk::GDCMImageIO::New();
        const bool opened = openDicom(files.front(), *io).has_value();
        const std::string description = opened ? tagOf(*io, kSeriesDescription) : "";
        list += fmt::format("{}{} ({}, {} files)", list.empty() ? "" : ", ", uid,
                            description.empty() ? "no description" : "'" + description + "'",
                            files.size());
    }
    return list;
}

/// The files of the series asked for, or of the only one.
Result<std::vector<std::string>> filesOfSeries(const std::filesystem::path& folder,
                                               const std::string& series) try {
    silenceLibraries();
    const auto names = itk::GDCMSeriesFileNames::New();
    names->SetUseSeriesDetails(false); // a series is what shares a UID, nothing finer
    names->SetInputDirectory(folder.string());
    std::vector<std::string> uids = names->GetSeriesUIDs();
    std::sort(uids.begin(), uids.end());
    if (uids.empty()) {
        return fail(ErrorCode::EmptyFolder,
                    fmt::format("{}: holds no DICOM images; name a folder with the slices of one "
                                "series",
                                folder.string()));
    }
    if (series.empty() && uids.size() > 1) {
        return fail(ErrorCode::AmbiguousSeries,
                    fmt::format("{}: holds {} DICOM series: {}; choose one with --series UID",
                                folder.string(), uids.size(), listOfSeries(*names, uids)));
    }
    const std::string wanted = series.empty() ? uids.front() : series;
    if (std::find(uids.begin(), uids.end(), wanted) == uids.end()) {
        return fail(ErrorCode::InvalidArgument,
                    fmt::format("{}: holds no series {}; --series may be one of: {}",
                                folder.string(), wanted, listOfSeries(*names, uids)));
    }
    return names->GetFileNames(wanted);
} catch (const std::exception& exception) {
    return tl::unexpected(itkError(ErrorCode::FileUnreadable, folder, exception,
                                   "check that the folder holds whole DICOM files"));
}

Result<std::vector<Slice>> openSlices(const std::vector<std::string>& files) {
    std::vector<Slice> slices;
    for (const std::string& file : files) {
        Result<Volume> header = openDicom(file, *itk::GDCMImageIO::New());
        if (!header) {
            return tl::unexpected(header.error());
        }
        slices.push_back({file, std::move(*header), 0.0});
    }
    const glm::dmat3 direction = slices.front().header.geometry.direction;
    const glm::dvec3 normal = glm::cross(direction[0], direction[1]);
    for (Slice& slice : slices) {
        slice.alongNormalMm = glm::dot(normal, slice.header.geometry.originMm);
    }
    std::stable_sort(slices.begin(), slices.end(), [](const Slice& a, const Slice& b) {
        return a.alongNormalMm < b.alongNormalMm;
    });
    return slices;
}

/// Why two slices cannot lie in one volume, or an empty text.
std::string difference(const Slice& a, const Slice& b) {
    constexpr double kSameCosine = 1e-4;
    const VolumeGeometry& ga = a.header.geometry;
    const VolumeGeometry& gb = b.header.geometry;
    if (ga.dims != gb.dims) {
        return fmt::format("{} x {} voxels beside {} x {}", gb.dims.x, gb.dims.y, ga.dims.x,
                           ga.dims.y);
    }
    if (a.header.type != b.header.type) {
        return fmt::format("voxels of {} beside {}", name(b.header.type), name(a.header.type));
    }
    const glm::dvec2 spacing(ga.spacingMm - gb.spacingMm);
    const double turned = glm::length(ga.direction[0] - gb.direction[0]) +
                          glm::length(ga.direction[1] - gb.direction[1]);
    if (glm::length(spacing) > 1e-4 || turned > kSameCosine) {
        return "another orientation or spacing";
    }
    return "";
}

Result<void> checkAlike(const std::filesystem::path& folder, const std::vector<Slice>& slices) {
    for (const Slice& slice : slices) {
        const std::string why = slice.header.geometry.dims.z != 1
                                    ? "several frames"
                                    : difference(slices.front(), slice);
        if (!why.empty()) {
            return fail(ErrorCode::InvalidGeometry,
                        fmt::format("{}: the slices of the series do not form one volume: {} has "
                                    "{}; move what does not belong to it away",
                                    folder.string(), slice.path.filename().string(), why));
        }
    }
    return {};
}

double medianStep(const std::vector<Slice>& slices) {
    std::vector<double> steps;
    for (std::size_t i = 1; i < slices.size(); ++i) {
        steps.push_back(slices[i].alongNormalMm - slices[i - 1].alongNormalMm);
    }
    const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
    std::nth_element(steps.begin(), middle, steps.end());
    return *middle;
}

/// The third axis from the first slice to the last: right for a tilted gantry too, whose box is
/// sheared.
Result<VolumeGeometry> stackedGeometry(const std::filesystem::path& folder,
                                       const std::vector<Slice>& slices) {
    const double usual = medianStep(slices);
    for (std::size_t i = 1; i < slices.size(); ++i) {
        const double step = slices[i].alongNormalMm - slices[i - 1].alongNormalMm;
        if (!(std::abs(step - usual) <= kSpacingTolerance * usual) || usual <= 0.0) {
            return fail(
                ErrorCode::InvalidGeometry,
                fmt::format("{}: {} lies {:g} mm behind {}, where {:g} mm are usual; a slice "
                            "is missing or there twice: export the series again",
                            folder.string(), slices[i].path.filename().string(), step,
                            slices[i - 1].path.filename().string(), usual));
        }
    }
    VolumeGeometry geometry = slices.front().header.geometry;
    const glm::dvec3 path = slices.back().header.geometry.originMm - geometry.originMm;
    geometry.dims.z = static_cast<int>(slices.size());
    geometry.spacingMm.z = glm::length(path) / static_cast<double>(slices.size() - 1);
    geometry.direction[2] = glm::normalize(path);
    return geometry;
}

Result<Volume> readSlices(const std::vector<Slice>& slices, const VolumeGeometry& geometry) {
    Volume volume = slices.front().header;
    volume.geometry = geometry;
    const Result<std::int64_t> bytes = checkedByteCount(geometry.dims, volume.type);
    if (!bytes) {
        return tl::unexpected(bytes.error());
    }
    volume.voxels.resize(*bytes);
    const std::size_t sliceBytes = volume.voxels.size() / slices.size();
    std::byte* target = volume.voxels.data();
    for (const Slice& slice : slices) {
        const auto io = itk::GDCMImageIO::New();
        const Result<Volume> opened = openDicom(slice.path, *io);
        if (!opened) {
            return tl::unexpected(opened.error());
        }
        if (const Result<void> read = readPixels(slice.path, *io, target); !read) {
            return tl::unexpected(read.error());
        }
        setModality(volume, *io);
        target += sliceBytes;
    }
    return volume;
}

} // namespace

Result<Volume> readDicomFile(const std::filesystem::path& path, const LoadOptions&) {
    const auto io = itk::GDCMImageIO::New();
    Result<Volume> volume = openDicom(path, *io);
    if (!volume) {
        return volume;
    }
    if (volume->geometry.dims.z == 1) {
        return fail(ErrorCode::UnsupportedDims,
                    fmt::format("{}: is a single slice; name the folder that holds the series",
                                path.string()));
    }
    volume->voxels.resize(volume->geometry.voxelCount() * bytesPerVoxel(volume->type));
    setModality(*volume, *io);
    const Result<void> read = readPixels(path, *io, volume->voxels.data());
    return read ? std::move(volume) : tl::unexpected(read.error());
}

Result<Volume> readDicomSeries(const std::filesystem::path& folder, const LoadOptions& options) {
    const Result<std::vector<std::string>> files = filesOfSeries(folder, options.series);
    if (!files) {
        return tl::unexpected(files.error());
    }
    if (files->size() == 1) {
        return readDicomFile(files->front(), options);
    }
    const Result<std::vector<Slice>> slices = openSlices(*files);
    if (!slices) {
        return tl::unexpected(slices.error());
    }
    Result<Volume> volume = checkAlike(folder, *slices)
                                .and_then([&]() { return stackedGeometry(folder, *slices); })
                                .and_then([&](const VolumeGeometry& geometry) {
                                    return readSlices(*slices, geometry);
                                });
    if (volume) {
        volume->name = folder.filename().string();
    }
    return volume;
}

bool holdDicom(const std::vector<std::filesystem::path>& files) {
    return std::any_of(files.begin(), files.end(), [](const std::filesystem::path& path) {
        constexpr std::streamoff kPreambleBytes = 128; // DICOM PS3.10, section 7.1
        std::ifstream file(path, std::ios::binary);
        std::array<char, 4> mark{};
        file.seekg(kPreambleBytes).read(mark.data(), mark.size());
        return file && std::string_view(mark.data(), mark.size()) == "DICM";
    });
}

} // namespace slabcast
