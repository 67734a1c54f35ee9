#include "platform/io/dicom/dicom_file.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "platform/io/base/parse_text.h"
#include "platform/io/dicom/dicom_dataset.h"
#include "platform/io/dicom/dicom_header.h"
#include "platform/io/dicom/dicom_places.h"
#include "platform/io/dicom/dicom_properties.h"

namespace slabcast {

namespace {

constexpr int kMostFrames = 1 << 20;

void setRescaling(DicomFile& file, DicomFrame& frame, const DicomHeader& header, int index) {
    if (const auto slope = take(file, "RescaleSlope", header.text(DCM_RescaleSlope, index), 1)) {
        frame.slope = slope->front();
    }
    if (const auto intercept =
            take(file, "RescaleIntercept", header.text(DCM_RescaleIntercept, index), 1)) {
        frame.intercept = intercept->front();
    }
    if (const auto scaling = take(file, "DoseGridScaling", header.text(DCM_DoseGridScaling), 1)) {
        frame.slope = scaling->front();
        frame.intercept = 0.0;
    }
    if (frame.slope == 0.0) {
        setFault(file, ErrorCode::InvalidArgument,
                 "its slope of values is 0, so that all would be alike; correct RescaleSlope or "
                 "DoseGridScaling, or export the file again");
    }
}

bool isOverTime(const DicomFile& file, const DicomHeader& header) {
    const std::string pointers = lowerCase(header.text(DCM_FrameIncrementPointer));
    constexpr std::array kTimePointers = {
        "0018,1063", "0018,1065", "0018,1060", // frame times
        "0054,0070", "0054,0060", "0054,0050", // time, beats, turns
        "0054,0090"};
    const auto isIn = [&](const char* tag) { return pointers.find(tag) != std::string::npos; };
    constexpr std::array kFilms = {"1.2.840.10008.5.1.4.1.1.3.1",   // ultrasound
                                   "1.2.840.10008.5.1.4.1.1.12.1",  // angiography
                                   "1.2.840.10008.5.1.4.1.1.12.2"}; // fluoroscopy
    return std::any_of(kTimePointers.begin(), kTimePointers.end(), isIn) ||
           header.has(DCM_FrameTime) || header.has(DCM_FrameTimeVector) ||
           header.has(DCM_CineRate) ||
           std::find(kFilms.begin(), kFilms.end(), file.sopClass) != kFilms.end();
}

std::string unitOf(const DicomFile& file, const DicomHeader& header) {
    const std::string type = header.text(DCM_RescaleType, 0);
    if (file.modality == "CT" || type == "HU") {
        return "HU";
    }
    if (header.has(DCM_DoseGridScaling)) {
        return header.text(DCM_DoseUnits) == "GY" ? "Gy" : "";
    }
    const std::string units = header.text(DCM_Units);
    return units == "BQML" ? "Bq/ml" : units == "GML" ? "g/ml" : units == "CNTS" ? "counts" : "";
}

/// A padding value comes as a number of either sign, whatever the sign of the pixels.
std::int64_t asStored(const DicomFile& file, std::int64_t value) {
    const std::int64_t whole = std::int64_t{1} << file.bitsAllocated;
    const std::int64_t used = std::int64_t{1} << file.bitsStored;
    if (!file.isSigned) {
        return value < 0 ? value + whole : value;
    }
    return value >= used ? value - whole : value >= used / 2 ? value - used : value;
}

void setPadding(DicomFile& file, const DicomHeader& header) {
    const std::optional<std::int64_t> value = header.integer(DCM_PixelPaddingValue);
    if (!value || file.cell != DicomCell::Integer) {
        return;
    }
    const std::optional<std::int64_t> limit = header.integer(DCM_PixelPaddingRangeLimit);
    const std::int64_t a = asStored(file, *value);
    const std::int64_t b = asStored(file, limit.value_or(*value));
    file.padding =
        DicomPadding{std::min(a, b), std::max(a, b),
                     limit ? fmt::format("{} to {}", *value, *limit) : fmt::format("{}", *value)};
}

void setTable(DicomFile& file, const DicomHeader& header) {
    DcmItem* item = nullptr;
    if (header.data().findAndGetSequenceItem(DCM_ModalityLUTSequence, item).bad() || !item) {
        return;
    }
    DcmElement* element = nullptr;
    const Uint16* values = nullptr;
    unsigned long count = 0;
    std::array<double, 3> descriptor{};
    if (item->findAndGetElement(DCM_LUTDescriptor, element).good() && element) {
        const auto three = numbersIn(dicomText(*element));
        if (three && three->size() == 3) {
            std::copy(three->begin(), three->end(), descriptor.begin());
        }
    }
    const bool read = item->findAndGetUint16Array(DCM_LUTData, values, &count).good() && values;
    std::int64_t first = static_cast<std::int64_t>(descriptor[1]);
    first = file.isSigned && first >= 1 << 15 ? first - (1 << 16) : first;
    const auto entries = static_cast<std::size_t>(descriptor[0] == 0 ? 1 << 16 : descriptor[0]);
    DicomTable table{first, {}};
    if (read && count >= entries) {
        table.values.assign(values, values + entries);
    } else if (read && descriptor[2] <= 8 && 2 * count >= entries) { // two entries a word
        for (std::size_t i = 0; i < entries; ++i) {
            table.values.push_back(
                static_cast<std::uint16_t>((values[i / 2] >> (8 * (i % 2))) & 255));
        }
    }
    if (table.values.empty()) {
        setFault(file, ErrorCode::UnsupportedType,
                 "its table of values (ModalityLUTSequence) is damaged; export the file again");
        return;
    }
    file.table = std::move(table);
}

void checkSpeaksOfPixels(DicomFile& file, const DicomHeader& header) {
    const std::int64_t samples = header.integer(DCM_SamplesPerPixel).value_or(1);
    const std::string photometric = header.text(DCM_PhotometricInterpretation);
    if (samples != 1 || photometric.starts_with("PALETTE")) {
        setFault(file, ErrorCode::UnsupportedType,
                 fmt::format("its pixels are colours ({}), and a volume has one number per voxel; "
                             "leave it out or convert to grey",
                             photometric.empty() ? fmt::format("{} numbers each", samples)
                                                 : photometric));
    }
    const bool known = file.bitsAllocated == 1 || file.bitsAllocated == 8 ||
                       file.bitsAllocated == 16 || file.bitsAllocated == 32;
    if (file.cell == DicomCell::Integer &&
        (!known || file.bitsStored < 1 || file.bitsStored > file.bitsAllocated)) {
        setFault(file, ErrorCode::UnsupportedType,
                 fmt::format("its pixels have {} bits of {}, and read are those of 1, 8, 16 or 32 "
                             "bits; convert them",
                             file.bitsStored, file.bitsAllocated));
    }
    if (file.rows < 1 || file.columns < 1) {
        setFault(file, ErrorCode::EmptyVolume,
                 "says nothing of Rows and Columns; export the file again");
    }
}

void setCells(DicomFile& file, const DicomHeader& header) {
    constexpr std::int64_t kMost = 1 << 16;
    const DcmElement* pixels = pixelElement(header.data());
    file.hasPixels = pixels != nullptr;
    file.rows =
        static_cast<int>(std::clamp<std::int64_t>(header.integer(DCM_Rows).value_or(0), 0, kMost));
    file.columns = static_cast<int>(
        std::clamp<std::int64_t>(header.integer(DCM_Columns).value_or(0), 0, kMost));
    const auto bits = [&](const DcmTagKey& tag, int otherwise) {
        return static_cast<int>(
            std::clamp<std::int64_t>(header.integer(tag).value_or(otherwise), -1, 1 << 10));
    };
    file.bitsAllocated = bits(DCM_BitsAllocated, 16);
    file.bitsStored = bits(DCM_BitsStored, file.bitsAllocated);
    file.highBit = bits(DCM_HighBit, file.bitsStored - 1);
    if (file.highBit < file.bitsStored - 1 || file.highBit >= file.bitsAllocated) {
        file.highBit = file.bitsStored - 1;
    }
    file.isSigned = header.integer(DCM_PixelRepresentation).value_or(0) == 1;
    if (pixels && pixels->getTag() == DCM_FloatPixelData) {
        file.cell = DicomCell::Float32;
        file.bitsAllocated = 32;
    } else if (pixels && pixels->getTag() == DCM_DoubleFloatPixelData) {
        file.cell = DicomCell::Float64;
        file.bitsAllocated = 64;
    }
    checkSpeaksOfPixels(file, header);
}

/// Of pixels that are compressed; 0 of plain ones.
unsigned long fragmentsOf(DcmElement& element, E_TransferSyntax syntax) {
    auto* pixels = dynamic_cast<DcmPixelData*>(&element);
    DcmPixelSequence* sequence = nullptr;
    if (!pixels || !DcmXfer(syntax).isEncapsulated() ||
        pixels->getEncapsulatedRepresentation(syntax, nullptr, sequence).bad() || !sequence) {
        return 0;
    }
    return sequence->card() > 0 ? sequence->card() - 1 : 0; // the first is a table of offsets
}

/// Whether all pixels that the header speaks of are there.
void checkPixelsThere(DicomFile& file, const DicomDataset& dataset, std::int64_t frames) {
    DcmElement& element = *pixelElement(dataset.data());
    const E_TransferSyntax syntax = dataset.data().getOriginalXfer();
    if (DcmXfer(syntax).isEncapsulated()) {
        const auto fragments = static_cast<std::int64_t>(fragmentsOf(element, syntax));
        if (fragments < frames || !dataset.isWhole) {
            setFault(file, ErrorCode::FileTruncated,
                     fmt::format("ends before its pixels do: {} compressed pieces for {} frames; "
                                 "fetch the file again",
                                 fragments, frames));
        }
        return;
    }
    const auto length = static_cast<std::int64_t>(element.getLengthField());
    const std::int64_t needed = (file.frameCells() * file.bitsAllocated * frames + 7) / 8;
    if (length < needed) {
        setFault(file, ErrorCode::FileTruncated,
                 fmt::format("holds {} bytes of pixels, and {} x {} pixels of {} bits{} take {}; "
                             "fetch the file again",
                             length, file.columns, file.rows, file.bitsAllocated,
                             frames > 1 ? fmt::format(" in {} frames", frames) : "", needed));
    }
    std::error_code ignored;
    const auto size = static_cast<std::int64_t>(std::filesystem::file_size(file.path, ignored));
    const bool deflated = syntax == EXS_DeflatedLittleEndianExplicit;
    if (!dataset.isWhole || (!deflated && size < length)) {
        setFault(file, ErrorCode::FileTruncated, "ends before its pixels do; fetch the file again");
    }
}

Result<DicomFile> fileOf(const std::filesystem::path& path, DicomDataset&& opened,
                         const std::vector<std::string>& moreKeys) try {
    const auto dataset = std::make_shared<DicomDataset>(std::move(opened));
    const DicomHeader header(dataset->data());
    DicomFile file;
    file.path = path;
    OFString sopClass;
    dataset->format->getMetaInfo()->findAndGetOFString(DCM_MediaStorageSOPClassUID, sopClass);
    file.sopClass = header.text(DCM_SOPClassUID);
    file.sopClass = file.sopClass.empty() ? sopClass.c_str() : file.sopClass;
    file.sopInstance = header.text(DCM_SOPInstanceUID);
    file.series = header.text(DCM_SeriesInstanceUID);
    file.description = oneLine(header.text(DCM_SeriesDescription));
    file.modality = header.text(DCM_Modality);
    if (!dataset->hasMark && file.sopClass.empty() && !pixelElement(dataset->data())) {
        return fail(ErrorCode::FileUnreadable,
                    fmt::format("{}: is not DICOM; check that the file is whole and of the format "
                                "that its name says",
                                path.string()));
    }
    setCells(file, header);
    if (!file.hasPixels) {
        return file;
    }
    const std::int64_t frames =
        std::max<std::int64_t>(header.integer(DCM_NumberOfFrames).value_or(1), 1);
    checkPixelsThere(file, *dataset, frames);
    if (frames > kMostFrames) {
        setFault(file, ErrorCode::SizeOverflow,
                 fmt::format("says that it holds {} frames; export the file again", frames));
    }
    file.frames.resize(file.fault ? 1 : static_cast<std::size_t>(frames));
    file.isOverTime = isOverTime(file, header);
    file.unit = unitOf(file, header);
    setPlaces(file, header);
    for (int i = 0; i < static_cast<int>(file.frames.size()); ++i) {
        setRescaling(file, file.frames[i], header, i);
    }
    if (file.cell == DicomCell::Integer && !file.fault) {
        setPadding(file, header);
        setTable(file, header);
    }
    setProperties(file, header, moreKeys);
    file.dataset = dataset;
    return file;
} catch (const std::exception& exception) {
    return fail(ErrorCode::FileUnreadable,
                fmt::format("{}: cannot be read as DICOM ({}); fetch the file again", path.string(),
                            exception.what()));
}

} // namespace

Result<DicomFile> openDicomFile(const std::filesystem::path& path,
                                const std::vector<std::string>& moreKeys) {
    return openDicomDataset(path).and_then(
        [&](DicomDataset&& dataset) { return fileOf(path, std::move(dataset), moreKeys); });
}

Result<std::optional<DicomFile>> openMarkedDicomFile(const std::filesystem::path& path,
                                                     const std::vector<std::string>& moreKeys) {
    return openMarkedDicomDataset(path).and_then(
        [&](std::optional<DicomDataset>&& dataset) -> Result<std::optional<DicomFile>> {
            if (!dataset) {
                return std::optional<DicomFile>();
            }
            return fileOf(path, *std::move(dataset), moreKeys).map([](DicomFile&& file) {
                return std::optional(std::move(file));
            });
        });
}

std::string describeWithoutPixels(const DicomFile& file) {
    const std::string prefix = "1.2.840.10008.5.1.4.1.1.";
    const auto is = [&](std::string_view end) {
        return file.sopClass.starts_with(prefix + std::string(end));
    };
    if (file.sopClass == "1.2.840.10008.1.3.10") {
        return "is an index of other files (DICOMDIR) and holds no image; name the folder that it "
               "lies in";
    }
    const char* what = is("88.")    ? "a structured report"
                       : is("11.")  ? "a description of how to show images"
                       : is("481.") ? "part of a radiotherapy plan"
                       : is("104.") ? "a document"
                       : is("9.")   ? "a recording of signals"
                       : is("66")   ? "raw or registration data"
                                    : nullptr;
    return what ? fmt::format("is {} and holds no image; name a file or folder with images", what)
                : "holds no image: it has no pixels; fetch the file again, or name one with images";
}

} // namespace slabcast
