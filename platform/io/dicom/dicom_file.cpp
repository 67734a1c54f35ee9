#include "platform/io/dicom/dicom_file.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "platform/io/base/parse_text.h"
#include "platform/io/base/readers.h"
#include "platform/io/dicom/dicom_dataset.h"

namespace slabcast {

namespace {

constexpr int kMostFrames = 1 << 20;

struct Key {
    DicomKey key;
    DcmTagKey tag;
};

const std::array kKeys = {
    Key{{"EchoTime", false}, {0x0018, 0x0081}},
    Key{{"EffectiveEchoTime", false}, {0x0018, 0x9082}},
    Key{{"EchoNumbers", false}, {0x0018, 0x0086}},
    Key{{"DiffusionBValue", false}, {0x0018, 0x9087}},
    Key{{"DiffusionGradientOrientation", false}, {0x0018, 0x9089}},
    Key{{"DiffusionDirectionality", false}, {0x0018, 0x9075}},
    Key{{"InversionTime", false}, {0x0018, 0x0082}},
    Key{{"InversionTimes", false}, {0x0018, 0x9079}},
    Key{{"FlipAngle", false}, {0x0018, 0x1314}},
    Key{{"RepetitionTime", false}, {0x0018, 0x0080}},
    Key{{"KVP", false}, {0x0018, 0x0060}},
    Key{{"ConvolutionKernel", false}, {0x0018, 0x1210}},
    Key{{"ComplexImageComponent", false}, {0x0008, 0x9208}},
    Key{{"FrameType", false}, {0x0008, 0x9007}},
    Key{{"ImageType", false}, {0x0008, 0x0008}},
    Key{{"StackID", false}, {0x0020, 0x9056}},
    Key{{"ReferencedSegmentNumber", false}, {0x0062, 0x000b}},
    Key{{"SeriesDescription", false}, {0x0008, 0x103e}},
    Key{{"TemporalPositionIndex", true}, {0x0020, 0x9128}},
    Key{{"TemporalPositionIdentifier", true}, {0x0020, 0x0100}},
    Key{{"TriggerTime", true}, {0x0018, 0x1060}},
    Key{{"NominalCardiacTriggerDelayTime", true}, {0x0020, 0x9153}},
    Key{{"NominalPercentageOfCardiacPhase", true}, {0x0020, 0x9241}},
    Key{{"FrameReferenceTime", true}, {0x0054, 0x1300}},
    Key{{"FrameReferenceDateTime", true}, {0x0018, 0x9151}},
    Key{{"FrameAcquisitionDateTime", true}, {0x0018, 0x9074}},
    Key{{"AcquisitionDateTime", true}, {0x0008, 0x002a}},
    Key{{"AcquisitionTime", true}, {0x0008, 0x0032}},
    Key{{"ContentTime", true}, {0x0008, 0x0033}},
    Key{{"AcquisitionNumber", true}, {0x0020, 0x0012}},
    Key{{"InstanceNumber", true}, {0x0020, 0x0013}},
};

/// Looks elements up as DICOM layers them: for this frame, for all frames, for the whole file.
class Header {
public:
    explicit Header(DcmDataset& data) : data_(data) {
        data_.findAndGetSequenceItem(DCM_SharedFunctionalGroupsSequence, shared_);
        data_.findAndGetSequence(DCM_PerFrameFunctionalGroupsSequence, perFrame_);
        data_.findAndGetSequenceItem(DCM_DetectorInformationSequence, detector_);
    }

    std::string text(const DcmTagKey& tag) const { return textIn(&data_, tag, false).value_or(""); }

    std::string text(const DcmTagKey& tag, int frame) const {
        if (std::optional<std::string> own = ofFrame(tag, frame)) {
            return *own;
        }
        if (std::optional<std::string> common = textIn(shared_, tag, true)) {
            return *common;
        }
        return text(tag);
    }

    /// That of the whole file, or of the detector of nuclear medicine.
    std::string placeText(const DcmTagKey& tag) const {
        const std::string own = text(tag);
        return own.empty() ? textIn(detector_, tag, false).value_or("") : own;
    }

    std::optional<std::string> ofFrame(const DcmTagKey& tag, int frame) const {
        const auto index = static_cast<unsigned long>(frame);
        return perFrame_ && index < perFrame_->card() ? textIn(perFrame_->getItem(index), tag, true)
                                                      : std::nullopt;
    }

    std::optional<std::int64_t> integer(const DcmTagKey& tag) const {
        const std::optional<double> real = parseReal(text(tag));
        return real ? std::optional(static_cast<std::int64_t>(std::clamp(*real, -1e15, 1e15)))
                    : std::nullopt;
    }

    bool has(const DcmTagKey& tag) const { return data_.tagExists(tag); }
    DcmDataset& data() const { return data_; }

private:
    static std::optional<std::string> textIn(DcmItem* item, const DcmTagKey& tag, bool within) {
        DcmElement* element = nullptr;
        if (!item || item->findAndGetElement(tag, element, within).bad() || !element ||
            !element->isLeaf()) {
            return std::nullopt;
        }
        const std::string text = dicomText(*element);
        return text.empty() ? std::nullopt : std::optional(text);
    }

    DcmDataset& data_;
    DcmItem* shared_ = nullptr;
    DcmItem* detector_ = nullptr;
    DcmSequenceOfItems* perFrame_ = nullptr;
};

std::optional<std::vector<double>> numbers(const std::string& text) {
    std::vector<double> all;
    for (const std::string_view part : split(text, '\\')) {
        const std::optional<double> number = parseReal(trimmed(part));
        if (!number || !std::isfinite(*number)) {
            return std::nullopt;
        }
        all.push_back(*number);
    }
    return all;
}

Error notNumbers(const DicomFile& file, const char* keyword, const std::string& text,
                 std::size_t count) {
    return {
        ErrorCode::InvalidGeometry,
        fmt::format("{}: {} is '{}' and should be {}; correct the element or export the file again",
                    file.path.string(), keyword, oneLine(text),
                    count == 1 ? "a number" : fmt::format("{} numbers", count))};
}

void setFault(DicomFile& file, ErrorCode code, const std::string& why) {
    if (!file.fault) {
        file.fault = Error{code, fmt::format("{}: {}", file.path.string(), why)};
    }
}

/// So many numbers, or nothing where the text is empty; a fault where it is something else.
std::optional<std::vector<double>> take(DicomFile& file, const char* keyword,
                                        const std::string& text, std::size_t count) {
    if (text.empty()) {
        return std::nullopt;
    }
    std::optional<std::vector<double>> all = numbers(text);
    if (!all || all->size() != count) {
        if (!file.fault) {
            file.fault = notNumbers(file, keyword, text, count);
        }
        return std::nullopt;
    }
    return all;
}

std::optional<glm::dmat2x3> axesOf(DicomFile& file, const std::string& text) {
    constexpr double kTolerance = 1e-2; // files round cosines to a few digits
    const auto six = take(file, "ImageOrientationPatient", text, 6);
    if (!six) {
        return std::nullopt;
    }
    const std::vector<double>& c = *six;
    const glm::dmat2x3 axes(c[0], c[1], c[2], c[3], c[4], c[5]);
    const double row = glm::length(axes[0]);
    const double column = glm::length(axes[1]);
    if (!(std::abs(row - 1) < kTolerance && std::abs(column - 1) < kTolerance &&
          std::abs(glm::dot(axes[0], axes[1])) < kTolerance)) {
        if (!file.fault) {
            file.fault = Error{
                ErrorCode::InvalidGeometry,
                fmt::format("{}: ImageOrientationPatient is '{}', which are not two directions at "
                            "right angles; correct the element or export the file again",
                            file.path.string(), oneLine(text))};
        }
        return std::nullopt;
    }
    return glm::dmat2x3(axes[0] / row, axes[1] / column);
}

std::optional<glm::dvec3> positionOf(DicomFile& file, const std::string& text) {
    const auto three = take(file, "ImagePositionPatient", text, 3);
    return three ? std::optional(glm::dvec3((*three)[0], (*three)[1], (*three)[2])) : std::nullopt;
}

/// Distances between pixels, from the element that classes agree on or from those that stand for
/// it.
void setSpacing(DicomFile& file, DicomFrame& frame, const Header& header, int index) {
    const std::array<std::pair<const char*, DcmTagKey>, 3> elements = {
        {{"PixelSpacing", DCM_PixelSpacing},
         {"ImagerPixelSpacing", DCM_ImagerPixelSpacing},
         {"NominalScannedPixelSpacing", DCM_NominalScannedPixelSpacing}}};
    for (const auto& [keyword, tag] : elements) {
        const std::string text = header.text(tag, index);
        if (text.empty()) {
            continue;
        }
        const std::optional<std::vector<double>> two = numbers(text);
        if (!two || two->size() != 2 || !((*two)[0] > 0 && (*two)[1] > 0)) {
            file.spacingFault = fmt::format("{} is '{}', which are not two positive numbers",
                                            keyword, oneLine(text));
            return;
        }
        frame.spacingMm = glm::dvec2((*two)[1], (*two)[0]); // DICOM's first is between rows
        const std::string note = fmt::format(
            "PixelSpacing is missing; {} was taken, which may hold at the detector only", keyword);
        if (tag != DCM_PixelSpacing &&
            std::find(file.notes.begin(), file.notes.end(), note) == file.notes.end()) {
            file.notes.push_back(note);
        }
        return;
    }
}

void setRescaling(DicomFile& file, DicomFrame& frame, const Header& header, int index) {
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

bool isOverTime(const DicomFile& file, const Header& header) {
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

/// Planes of a dose: DICOM PS3.3, C.8.8.3.2.
void placeByOffsets(DicomFile& file, const std::string& text, const glm::dvec3& first,
                    const glm::dmat2x3& axes) {
    const auto offsets = take(file, "GridFrameOffsetVector", text, file.frames.size());
    if (!offsets) {
        return;
    }
    const glm::dvec3 normal = glm::cross(axes[0], axes[1]);
    const double start = offsets->front();
    const bool isAbsolute = start != 0.0; // then along z of the patient
    for (std::size_t i = 0; i < file.frames.size(); ++i) {
        const double along = ((*offsets)[i] - start) * (isAbsolute && normal.z < 0 ? -1.0 : 1.0);
        file.frames[i].positionMm = first + along * normal;
        file.frames[i].axes = axes;
    }
}

/// Frames whose places are not given one by one, if a distance between them is.
void placeByDistance(DicomFile& file, const Header& header, std::optional<glm::dvec3> first,
                     std::optional<glm::dmat2x3> axes) {
    const bool spaced = !header.text(DCM_SpacingBetweenSlices, 0).empty();
    const char* keyword = spaced ? "SpacingBetweenSlices" : "SliceThickness";
    const std::string text = header.text(spaced ? DCM_SpacingBetweenSlices : DCM_SliceThickness, 0);
    const auto distance = take(file, keyword, text, 1);
    if (!distance || distance->front() == 0.0 || file.isOverTime) {
        return;
    }
    file.notes.push_back(
        fmt::format("the places of single frames are missing; in the file's order they were laid "
                    "{} mm apart, as {} says{}",
                    std::abs(distance->front()), keyword,
                    first && axes ? "" : ", at an assumed place (no ImagePositionPatient)"));
    const glm::dmat2x3 assumed = axes.value_or(glm::dmat2x3(1, 0, 0, 0, 1, 0));
    const glm::dvec3 step = distance->front() * glm::cross(assumed[0], assumed[1]);
    for (std::size_t i = 0; i < file.frames.size(); ++i) {
        file.frames[i].positionMm = first.value_or(glm::dvec3(0.0)) + static_cast<double>(i) * step;
        file.frames[i].axes = assumed;
    }
}

void setPlaces(DicomFile& file, const Header& header) {
    const int count = static_cast<int>(file.frames.size());
    for (int i = 0; i < count; ++i) {
        DicomFrame& frame = file.frames[i];
        setSpacing(file, frame, header, i);
        frame.axes = axesOf(file, header.text(DCM_ImageOrientationPatient, i));
        const std::optional<std::string> own = header.ofFrame(DCM_ImagePositionPatient, i);
        if (own || count == 1) {
            frame.positionMm =
                positionOf(file, own ? *own : header.text(DCM_ImagePositionPatient, i));
        }
    }
    const bool placed = std::any_of(file.frames.begin(), file.frames.end(),
                                    [](const DicomFrame& frame) { return frame.positionMm; });
    if (placed || count == 1) {
        return;
    }
    std::string place = header.placeText(DCM_ImagePositionPatient);
    place = place.empty() ? header.text(DCM_ImagePositionPatient, 0) : place;
    const std::optional<glm::dvec3> first = positionOf(file, place);
    const std::optional<glm::dmat2x3> axes =
        file.frames.front().axes ? file.frames.front().axes
                                 : axesOf(file, header.placeText(DCM_ImageOrientationPatient));
    const std::string offsets = header.text(DCM_GridFrameOffsetVector);
    if (!offsets.empty() && first && axes) {
        placeByOffsets(file, offsets, *first, *axes);
    } else {
        placeByDistance(file, header, first, axes);
    }
}

void setProperties(DicomFile& file, const Header& header,
                   const std::vector<std::string>& moreKeys) {
    std::vector<std::pair<std::string, DcmTagKey>> wanted;
    for (const Key& key : kKeys) {
        wanted.emplace_back(key.key.keyword, key.tag);
    }
    for (const std::string& keyword : moreKeys) {
        readDictionary();
        DcmTag tag;
        if (DcmTag::findTagFromName(keyword.c_str(), tag).good()) {
            wanted.emplace_back(keyword, tag);
        }
    }
    for (std::size_t i = 0; i < file.frames.size(); ++i) {
        for (const auto& [keyword, tag] : wanted) {
            const std::string text = header.text(tag, static_cast<int>(i));
            if (!text.empty()) {
                file.frames[i].properties[keyword] = text;
            }
        }
    }
}

std::string unitOf(const DicomFile& file, const Header& header) {
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

void setPadding(DicomFile& file, const Header& header) {
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

void setTable(DicomFile& file, const Header& header) {
    DcmItem* item = nullptr;
    if (header.data().findAndGetSequenceItem(DCM_ModalityLUTSequence, item).bad() || !item) {
        return;
    }
    DcmElement* element = nullptr;
    const Uint16* values = nullptr;
    unsigned long count = 0;
    std::array<double, 3> descriptor{};
    if (item->findAndGetElement(DCM_LUTDescriptor, element).good() && element) {
        const auto three = numbers(dicomText(*element));
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

void checkSpeaksOfPixels(DicomFile& file, const Header& header) {
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

void setCells(DicomFile& file, const Header& header) {
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

} // namespace

std::span<const DicomKey> dicomKeys() {
    static const std::vector<DicomKey> keys = [] {
        std::vector<DicomKey> all;
        for (const Key& key : kKeys) {
            all.push_back(key.key);
        }
        return all;
    }();
    return keys;
}

Result<DicomFile> openDicomFile(const std::filesystem::path& path,
                                const std::vector<std::string>& moreKeys) try {
    const Result<DicomDataset> dataset = openDicomDataset(path);
    if (!dataset) {
        return tl::unexpected(dataset.error());
    }
    const Header header(dataset->data());
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
    if (!hasDicomMark(path) && file.sopClass.empty() && !pixelElement(dataset->data())) {
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
    return file;
} catch (const std::exception& exception) {
    return fail(ErrorCode::FileUnreadable,
                fmt::format("{}: cannot be read as DICOM ({}); fetch the file again", path.string(),
                            exception.what()));
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
