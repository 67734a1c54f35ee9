#include <algorithm>
#include <array>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "platform/io/base/parse_text.h"
#include "platform/io/volumes/file_header.h"
#include "platform/io/volumes/nrrd_header_place.h"
#include "platform/io/volumes/text_header.h"

namespace slabcast {

namespace {

using Path = std::filesystem::path;
using Sizes = std::vector<std::int64_t>;

struct NamedType {
    std::string_view name;
    StoredType type;
};

constexpr StoredType kI64 = {VoxelType::F64, Wide::Signed};
constexpr StoredType kU64 = {VoxelType::F64, Wide::Unsigned};

constexpr std::array<NamedType, 42> kTypes = {{{"signed char", {VoxelType::I8}},
                                               {"char", {VoxelType::I8}},
                                               {"int8", {VoxelType::I8}},
                                               {"int8_t", {VoxelType::I8}},
                                               {"uchar", {VoxelType::U8}},
                                               {"unsigned char", {VoxelType::U8}},
                                               {"uint8", {VoxelType::U8}},
                                               {"uint8_t", {VoxelType::U8}},
                                               {"short", {VoxelType::I16}},
                                               {"short int", {VoxelType::I16}},
                                               {"signed short", {VoxelType::I16}},
                                               {"signed short int", {VoxelType::I16}},
                                               {"int16", {VoxelType::I16}},
                                               {"int16_t", {VoxelType::I16}},
                                               {"ushort", {VoxelType::U16}},
                                               {"unsigned short", {VoxelType::U16}},
                                               {"unsigned short int", {VoxelType::U16}},
                                               {"uint16", {VoxelType::U16}},
                                               {"uint16_t", {VoxelType::U16}},
                                               {"int", {VoxelType::I32}},
                                               {"signed int", {VoxelType::I32}},
                                               {"int32", {VoxelType::I32}},
                                               {"int32_t", {VoxelType::I32}},
                                               {"uint", {VoxelType::U32}},
                                               {"unsigned int", {VoxelType::U32}},
                                               {"uint32", {VoxelType::U32}},
                                               {"uint32_t", {VoxelType::U32}},
                                               {"float", {VoxelType::F32}},
                                               {"double", {VoxelType::F64}},
                                               {"longlong", kI64},
                                               {"long long", kI64},
                                               {"long long int", kI64},
                                               {"signed long long", kI64},
                                               {"signed long long int", kI64},
                                               {"int64", kI64},
                                               {"int64_t", kI64},
                                               {"ulonglong", kU64},
                                               {"unsigned long long", kU64},
                                               {"unsigned long long int", kU64},
                                               {"uint64", kU64},
                                               {"uint64_t", kU64},
                                               {"unsigned long long integer", kU64}}};

std::optional<StoredType> typeOf(std::string_view written) {
    const std::string name = lowerCase(written);
    const auto found = std::find_if(kTypes.begin(), kTypes.end(),
                                    [&](const NamedType& entry) { return entry.name == name; });
    return found == kTypes.end() ? std::nullopt : std::optional(found->type);
}

DataEncoding encodingOf(std::string_view written) {
    static const std::map<std::string, DataEncoding> kNames = {
        {"raw", DataEncoding::Raw},    {"gzip", DataEncoding::Deflate},
        {"gz", DataEncoding::Deflate}, {"ascii", DataEncoding::Text},
        {"text", DataEncoding::Text},  {"txt", DataEncoding::Text},
        {"hex", DataEncoding::Hex}};
    const auto found = kNames.find(lowerCase(written));
    return found == kNames.end() ? DataEncoding::Other : found->second;
}

/// A misspelt field must not pass for one that is left out.
Result<void> checkNames(const Path& path, const TextHeader& text) {
    static const std::set<std::string_view> kKnown = {"content",
                                                      "number",
                                                      "type",
                                                      "dimension",
                                                      "space",
                                                      "space dimension",
                                                      "space units",
                                                      "space origin",
                                                      "space directions",
                                                      "measurement frame",
                                                      "sizes",
                                                      "spacings",
                                                      "thicknesses",
                                                      "axis mins",
                                                      "axismins",
                                                      "axis maxs",
                                                      "axismaxs",
                                                      "centers",
                                                      "centerings",
                                                      "kinds",
                                                      "labels",
                                                      "units",
                                                      "min",
                                                      "max",
                                                      "old min",
                                                      "oldmin",
                                                      "old max",
                                                      "oldmax",
                                                      "block size",
                                                      "blocksize",
                                                      "endian",
                                                      "encoding",
                                                      "line skip",
                                                      "lineskip",
                                                      "byte skip",
                                                      "byteskip",
                                                      "data file",
                                                      "datafile",
                                                      "sample units",
                                                      "sampleunits"};
    for (const auto& [name, value] : text.fields) {
        if (!kKnown.contains(name)) {
            return unreadable(path, fmt::format("'{}' is no field of NRRD", printable(name)));
        }
    }
    return {};
}

Result<void> setSource(const Path& path, FileHeader& header, const TextHeader& text,
                       const Sizes& sizes) {
    header.encodingName = printable(text.findOr({"encoding"}, ""));
    header.source.encoding = encodingOf(text.findOr({"encoding"}, ""));
    const std::string endian = lowerCase(text.findOr({"endian"}, ""));
    if (endian == "little" || endian == "big") {
        header.bigEndian = endian == "big";
    }
    const std::string_view written = text.findOr({"data file", "datafile"}, "");
    if (written.empty()) {
        header.source.files = {path};
        header.source.headerBytes = text.bytes;
    } else {
        Result<std::vector<Path>> files = dataFiles(path, text, written, sizes);
        if (!files) {
            return tl::unexpected(files.error());
        }
        header.source.files = std::move(*files);
    }
    constexpr std::int64_t kLeastByteSkip = -(std::int64_t{1} << 60);
    const Result<std::int64_t> lines = parseSkip(path, text, {"line skip", "lineskip"}, 0);
    const Result<std::int64_t> bytes =
        parseSkip(path, text, {"byte skip", "byteskip"}, kLeastByteSkip);
    if (!lines || !bytes) {
        return tl::unexpected(lines ? bytes.error() : lines.error());
    }
    header.source.lineSkip = *lines;
    header.source.byteSkip = *bytes;
    return {};
}

std::string keyOr(const TextHeader& text, const char* name) {
    const auto found = text.keys.find(name);
    return found == text.keys.end() ? "" : found->second;
}

} // namespace

Result<FileHeader> parseNrrdHeader(std::string_view start, const Path& path) {
    const Result<TextHeader> text = parseNrrdText(path, start);
    if (!text) {
        return tl::unexpected(text.error());
    }
    const Result<Sizes> sizes = parseSizes(path, *text, "sizes", "dimension");
    if (!sizes) {
        return tl::unexpected(sizes.error());
    }
    FileHeader header;
    header.typeName = printable(text->findOr({"type"}, "none"));
    header.type = typeOf(text->findOr({"type"}, ""));
    header.unit = keyOr(*text, "unit");
    header.modality = parseModality(keyOr(*text, "modality"));
    std::vector<nrrd::Axis> axes = nrrd::axesOf(*text, *sizes);
    const Result<void> sound =
        checkNames(path, *text)
            .and_then([&]() { return nrrd::setAxes(path, header, axes); })
            .and_then([&]() { return setSource(path, header, *text, *sizes); });
    if (!sound) {
        return tl::unexpected(sound.error());
    }
    if (axes.size() == 3) {
        header.placement = nrrd::placementOfAxes(path, header, *text, axes, sizes->size());
    }
    return header;
}

Result<FileHeader> readNrrdHeader(const Path& path) {
    return parseNrrdHeader(textStart(path), path);
}

} // namespace slabcast
