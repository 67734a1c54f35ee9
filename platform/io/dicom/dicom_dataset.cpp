#include "platform/io/dicom/dicom_dataset.h"

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <string_view>

#include <dcmtk/dcmdata/dcrledrg.h>
#include <dcmtk/dcmjpeg/djdecode.h>
#include <dcmtk/dcmjpls/djdecode.h>
#include <dcmtk/oflog/oflog.h>
#include <fmt/format.h>

#include "platform/io/base/parse_text.h"
#include "platform/io/dicom/dicom_stream.h"

namespace slabcast {

namespace {

void setUpLibrary() {
    [[maybe_unused]] static const bool once = [] {
        OFLog::configure(OFLogger::OFF_LOG_LEVEL);
        DcmRLEDecoderRegistration::registerCodecs();
        DJDecoderRegistration::registerCodecs();
        DJLSDecoderRegistration::registerCodecs();
        return true;
    }();
}

/// Whether anything was read behind the pixels: then they are whole, whatever follows.
bool endsBehindPixels(DcmDataset& data) {
    const DcmElement* pixels = pixelElement(data);
    return pixels && data.getElement(data.card() - 1) != pixels;
}

/// Whether the file is long enough for its plain pixels, found by their tag, type and length, or
/// ends with the mark that ends compressed ones. What follows is junk, of which files have some.
bool holdsAllPixels(const std::filesystem::path& path, DcmElement& pixels) {
    constexpr std::size_t kSearchedBytes = 1 << 22; // other elements come first and are small
    std::ifstream file(path, std::ios::binary);
    std::string bytes(kSearchedBytes, '\0');
    file.read(bytes.data(), kSearchedBytes);
    bytes.resize(static_cast<std::size_t>(file.gcount()));
    std::error_code ignored;
    const std::uintmax_t size = std::filesystem::file_size(path, ignored);
    const std::uint32_t length = pixels.getLengthField();
    if (length == DCM_UndefinedLength) {
        const std::size_t last = bytes.find_last_not_of('\0');
        return size == bytes.size() && last != std::string::npos && last >= 3 &&
               bytes.compare(last - 3, 4, "\xfe\xff\xdd\xe0") == 0;
    }
    std::string lengthBytes;
    for (int shift = 0; shift < 32; shift += 8) {
        lengthBytes += static_cast<char>(length >> shift);
    }
    const std::string tag = "\xe0\x7f\x10" + std::string(1, '\0'); // (7FE0,0010)
    for (const std::string& type :
         {std::string(), std::string("OW\0\0", 4), std::string("OB\0\0", 4)}) {
        const std::string element = fmt::format("{}{}{}", tag, type, lengthBytes);
        const std::size_t found = bytes.find(element);
        if (found != std::string::npos) {
            return size >= found + element.size() + length;
        }
    }
    return false;
}

bool isText(const std::string& bytes) {
    return std::all_of(bytes.begin(), bytes.end(), [](char c) { return c >= ' ' && c <= '~'; });
}

/// Of an element whose type the file does not give: text or nothing.
std::string unknownText(DcmElement& element) {
    Uint8* bytes = nullptr;
    if (element.getUint8Array(bytes).bad() || !bytes) {
        return "";
    }
    std::string text(reinterpret_cast<const char*>(bytes), element.getLength());
    while (!text.empty() && (text.back() == '\0' || text.back() == ' ')) {
        text.pop_back();
    }
    return isText(text) ? text : "";
}

std::string floatText(DcmElement& element, bool isDouble) {
    std::string text;
    for (unsigned long i = 0; i < element.getVM(); ++i) {
        Float32 single = 0;
        Float64 value = 0;
        const OFCondition read =
            isDouble ? element.getFloat64(value, i) : element.getFloat32(single, i);
        if (read.bad()) {
            return text;
        }
        text += i == 0 ? "" : "\\";
        text += isDouble ? fmt::format("{}", value) : fmt::format("{}", single);
    }
    return text;
}

/// "10.0" as "10": values are shown and compared.
std::string tidyNumbers(const std::string& text) {
    std::string tidy;
    for (const std::string_view part : split(text, '\\')) {
        const std::optional<double> number = parseReal(trimmed(part));
        tidy += tidy.empty() ? "" : "\\";
        tidy += number ? fmt::format("{}", *number) : std::string(part);
    }
    return tidy;
}

bool dictionaryIsThere() {
    const bool there = dcmDataDict.rdlock().numberOfEntries() > 0; // read here, if it was not yet
    dcmDataDict.rdunlock();
    return there;
}

bool sayTheirTypes(DcmDataset& data) {
    return DcmXfer(data.getOriginalXfer()).isExplicitVR();
}

OFCondition load(DicomDataset& dataset, DicomStream& stream) {
    dataset.format = std::make_unique<DcmFileFormat>();
    dataset.hasMark = stream.hasMark();
    if (stream.status().bad()) {
        return stream.status();
    }
    dataset.format->transferInit();
    const OFCondition read = dataset.format->read(stream);
    dataset.format->transferEnd();
    return read;
}

Result<DicomDataset> datasetOf(DicomStream& stream, const std::filesystem::path& path) {
    DicomDataset dataset;
    OFCondition loaded = load(dataset, stream);
    if (!dictionaryIsThere() && (loaded.bad() || !sayTheirTypes(dataset.data()))) {
        readDictionary();
        DicomStream again(path); // once for all files
        loaded = load(dataset, again);
    }
    if (loaded.good()) {
        return dataset;
    }
    if (DcmElement* pixels = pixelElement(dataset.data())) {
        dataset.isWhole = endsBehindPixels(dataset.data()) || holdsAllPixels(path, *pixels);
        return dataset;
    }
    if (dataset.hasMark) {
        return fail(ErrorCode::FileTruncated,
                    fmt::format("{}: is cut off or damaged within its header, before any pixels; "
                                "fetch the file again",
                                path.string()));
    }
    return fail(ErrorCode::FileUnreadable,
                fmt::format("{}: is not DICOM, or is cut off within its header; check that the "
                            "file is whole and of the format that its name says",
                            path.string()));
}

Result<std::optional<DicomDataset>> open(const std::filesystem::path& path, bool markedOnly) try {
    setUpLibrary();
    std::error_code ignored;
    if (std::filesystem::file_size(path, ignored) == 0 && !markedOnly) {
        return fail(ErrorCode::FileTruncated,
                    fmt::format("{}: is empty; fetch the file again", path.string()));
    }
    DicomStream stream(path);
    if (markedOnly && !stream.hasMark()) {
        return std::optional<DicomDataset>();
    }
    return datasetOf(stream, path).map([](DicomDataset&& dataset) {
        return std::optional(std::move(dataset));
    });
} catch (const std::exception& exception) {
    return fail(ErrorCode::FileUnreadable,
                fmt::format("{}: cannot be read as DICOM ({}); fetch the file again", path.string(),
                            exception.what()));
}

} // namespace

void readDictionary() {
    if (dictionaryIsThere()) {
        return;
    }
    unsetenv(DCM_DICT_ENVIRONMENT_VARIABLE);
    dcmDataDict.wrlock().reloadDictionaries(OFTrue, OFTrue);
    dcmDataDict.wrunlock();
}

Result<DicomDataset> openDicomDataset(const std::filesystem::path& path) {
    return open(path, false).map([](std::optional<DicomDataset>&& dataset) {
        return *std::move(dataset);
    });
}

Result<std::optional<DicomDataset>> openMarkedDicomDataset(const std::filesystem::path& path) {
    return open(path, true);
}

DcmElement* pixelElement(DcmDataset& data) {
    for (const DcmTagKey& tag : {DCM_PixelData, DCM_FloatPixelData, DCM_DoubleFloatPixelData}) {
        DcmElement* element = nullptr;
        if (data.findAndGetElement(tag, element).good() && element) {
            return element;
        }
    }
    return nullptr;
}

std::string dicomText(DcmElement& element) {
    switch (element.ident()) {
    case EVR_UN:
    case EVR_OB:
    case EVR_UNKNOWN:
    case EVR_UNKNOWN2B:
        return unknownText(element);
    case EVR_FL:
        return floatText(element, false);
    case EVR_FD:
        return floatText(element, true);
    default:
        break;
    }
    OFString text;
    if (element.getOFStringArray(text).bad()) {
        return "";
    }
    std::string all(trimmed(std::string_view(text.c_str()))); // up to a NUL: padded to even length
    return element.ident() == EVR_DS || element.ident() == EVR_IS ? tidyNumbers(all) : all;
}

} // namespace slabcast
