#include "platform/io/file_header.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <optional>
#include <set>
#include <string_view>

#include <fmt/format.h>

#include "platform/io/parse_text.h"

namespace slabcast {

namespace {

constexpr std::size_t kMaxHeaderBytes = 1 << 20; // a binary file may hold no line end at all

tl::unexpected<Error> unreadable(const std::filesystem::path& path, std::string_view why) {
    return fail(
        ErrorCode::FileUnreadable,
        fmt::format("{}: {}; check that the file is whole and of the format that its name says",
                    path.string(), why));
}

struct Field {
    std::string name; // lower case
    std::string value;
};

/// The two formats differ in little: how the first line looks, how a field is written and what
/// ends the header.
struct TextFormat {
    std::string_view magic;     // how the file begins; empty: with a field
    std::string_view lastField; // after whose line the voxels begin; empty: after an empty line
    std::optional<Field> (*parseField)(std::string_view line);
};

std::optional<Field> parseNrrdField(std::string_view line) {
    const std::size_t colon = line.find(':');
    if (colon == std::string_view::npos || line.starts_with('#')) {
        return std::nullopt;
    }
    const bool isKey = line.substr(colon).starts_with(":=");
    return Field{lowerCase(trimmed(line.substr(0, colon))),
                 std::string(trimmed(line.substr(colon + (isKey ? 2 : 1))))};
}

std::optional<Field> parseMetaField(std::string_view line) {
    const std::size_t equals = line.find('=');
    if (equals == std::string_view::npos) {
        return std::nullopt;
    }
    return Field{lowerCase(trimmed(line.substr(0, equals))),
                 std::string(trimmed(line.substr(equals + 1)))};
}

constexpr TextFormat kNrrd = {"NRRD000", "", parseNrrdField};
constexpr TextFormat kMeta = {"", "elementdatafile", parseMetaField};

/// Fills `fields` and sets fileOffset to where the header ends.
Result<FileHeader> readFields(const std::filesystem::path& path, const TextFormat& format) {
    std::ifstream file(path, std::ios::binary);
    std::string line;
    if (!std::getline(file, line) || !line.starts_with(format.magic)) {
        return unreadable(path, fmt::format("does not begin with {}",
                                            format.magic.empty() ? "a header" : format.magic));
    }
    FileHeader header;
    std::size_t headerBytes = 0;
    bool ended = false;
    do {
        headerBytes += line.size() + 1;
        const std::string_view text = trimmed(line);
        const std::optional<Field> field = format.parseField(text);
        if (field) {
            header.fields.emplace(field->name, field->value);
        }
        ended = format.lastField.empty() ? text.empty() : field && field->name == format.lastField;
    } while (!ended && headerBytes < kMaxHeaderBytes && std::getline(file, line));
    header.fileOffset = static_cast<std::int64_t>(headerBytes);
    return header;
}

std::string_view fieldOr(const FileHeader& header, std::initializer_list<const char*> names,
                         std::string_view otherwise) {
    for (const char* name : names) {
        const auto found = header.fields.find(name);
        if (found != header.fields.end()) {
            return found->second;
        }
    }
    return otherwise;
}

Result<std::vector<std::int64_t>> integers(const std::filesystem::path& path, std::string_view name,
                                           std::string_view text) {
    std::vector<std::int64_t> values;
    for (const std::string_view word : words(text)) {
        const std::optional<std::int64_t> value = parseInteger(word);
        if (!value) {
            return unreadable(path, fmt::format("'{}' in field '{}' is no integer", word, name));
        }
        values.push_back(*value);
    }
    return values;
}

/// What is no number reads as NaN, for the check of spacings to name.
double realOrNan(std::string_view text) {
    return parseReal(text).value_or(std::nan(""));
}

/// Lengths of the vectors in "(1,0,0) none (0,0,2)"; `none` and all that is no vector: NaN.
std::vector<double> vectorLengths(std::string_view text) {
    std::vector<double> lengths;
    for (text = trimmed(text); !text.empty(); text = trimmed(text)) {
        const bool isVector = text.front() == '(';
        const std::size_t end = text.find_first_of(isVector ? ")" : " \t");
        const std::string_view item = text.substr(isVector ? 1 : 0, end - (isVector ? 1 : 0));
        double squared = isVector ? 0.0 : std::nan("");
        for (const std::string_view part : split(item, ',')) {
            squared += isVector ? realOrNan(part) * realOrNan(part) : 0.0;
        }
        lengths.push_back(std::sqrt(squared));
        text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    }
    return lengths;
}

/// Sorts the axes into spatial ones and those that hold several numbers per voxel.
void sortNrrdAxes(FileHeader& header, const std::vector<std::int64_t>& sizes) {
    static const std::set<std::string_view> kSpatial = {"domain", "space", "time", "???", "none"};
    const std::vector<std::string_view> kinds = words(fieldOr(header, {"kinds"}, ""));
    const std::string_view directions = fieldOr(header, {"space directions"}, "");
    std::vector<double> spacings = vectorLengths(directions);
    if (directions.empty()) {
        for (const std::string_view word : words(fieldOr(header, {"spacings"}, ""))) {
            spacings.push_back(realOrNan(word));
        }
    }
    for (std::size_t axis = 0; axis < sizes.size(); ++axis) {
        if (axis < kinds.size() && !kSpatial.contains(lowerCase(kinds[axis]))) {
            header.components *= sizes[axis];
            continue;
        }
        header.sizes.push_back(sizes[axis]);
        if (axis < spacings.size()) {
            header.spacings.push_back(spacings[axis]);
        }
    }
}

using TypeNames = std::map<std::string_view, VoxelType>;

void setType(FileHeader& header, std::string_view written, const TypeNames& names) {
    header.typeName = written;
    const auto found = names.find(written);
    header.typeKnown = found != names.end();
    header.type = header.typeKnown ? found->second : VoxelType::U8;
}

const TypeNames& nrrdTypes() {
    static const TypeNames names = {
        {"signed char", VoxelType::I8},
        {"int8", VoxelType::I8},
        {"int8_t", VoxelType::I8},
        {"uchar", VoxelType::U8},
        {"unsigned char", VoxelType::U8},
        {"uint8", VoxelType::U8},
        {"uint8_t", VoxelType::U8},
        {"short", VoxelType::I16},
        {"short int", VoxelType::I16},
        {"signed short", VoxelType::I16},
        {"signed short int", VoxelType::I16},
        {"int16", VoxelType::I16},
        {"int16_t", VoxelType::I16},
        {"ushort", VoxelType::U16},
        {"unsigned short", VoxelType::U16},
        {"unsigned short int", VoxelType::U16},
        {"uint16", VoxelType::U16},
        {"uint16_t", VoxelType::U16},
        {"int", VoxelType::I32},
        {"signed int", VoxelType::I32},
        {"int32", VoxelType::I32},
        {"int32_t", VoxelType::I32},
        {"uint", VoxelType::U32},
        {"unsigned int", VoxelType::U32},
        {"uint32", VoxelType::U32},
        {"uint32_t", VoxelType::U32},
        {"float", VoxelType::F32},
        {"double", VoxelType::F64},
    };
    return names;
}

const TypeNames& metaTypes() {
    static const TypeNames names = {
        {"met_char", VoxelType::I8},   {"met_uchar", VoxelType::U8},
        {"met_short", VoxelType::I16}, {"met_ushort", VoxelType::U16},
        {"met_int", VoxelType::I32},   {"met_uint", VoxelType::U32},
        {"met_long", VoxelType::I32},  {"met_ulong", VoxelType::U32},
        {"met_float", VoxelType::F32}, {"met_double", VoxelType::F64},
    };
    return names;
}

DataEncoding nrrdEncoding(std::string_view written) {
    const std::string encoding = lowerCase(written);
    if (encoding == "raw") {
        return DataEncoding::Raw;
    }
    return encoding == "gzip" || encoding == "gz" ? DataEncoding::Deflate : DataEncoding::Other;
}

/// A name of one file beside the header, or nothing where the field lists several.
std::filesystem::path besideHeader(const std::filesystem::path& path, std::string_view name) {
    const bool several = name.starts_with("LIST") || name.find('%') != std::string_view::npos;
    return several ? std::filesystem::path() : path.parent_path() / name;
}

/// How many bytes to leave out before the voxels; -1, as both formats have it: the voxels end
/// where the file does.
std::int64_t parseSkip(std::string_view written) {
    constexpr std::int64_t kFarBeyondAnyFile = std::int64_t{1} << 60;
    return std::min(parseInteger(written).value_or(0), kFarBeyondAnyFile);
}

} // namespace

Result<FileHeader> readNrrdHeader(const std::filesystem::path& path) {
    Result<FileHeader> read = readFields(path, kNrrd);
    if (!read) {
        return read;
    }
    FileHeader& header = *read;
    const Result<std::vector<std::int64_t>> sizes =
        integers(path, "sizes", fieldOr(header, {"sizes"}, ""));
    if (!sizes) {
        return tl::unexpected(sizes.error());
    }
    if (parseInteger(fieldOr(header, {"dimension"}, "")) !=
        static_cast<std::int64_t>(sizes->size())) {
        return unreadable(path, "'dimension' and the number of 'sizes' differ");
    }
    sortNrrdAxes(header, *sizes);
    setType(header, lowerCase(fieldOr(header, {"type"}, "none")), nrrdTypes());
    header.encoding = nrrdEncoding(fieldOr(header, {"encoding"}, "none"));

    const std::string_view dataFile = fieldOr(header, {"data file", "datafile"}, "");
    header.dataFile = dataFile.empty() ? path : besideHeader(path, dataFile);
    header.fileOffset = dataFile.empty() ? header.fileOffset : 0;
    const std::int64_t skip = parseSkip(fieldOr(header, {"byte skip", "byteskip"}, "0"));
    if (header.encoding == DataEncoding::Deflate) {
        header.inflatedOffset = std::max<std::int64_t>(skip, 0);
    } else {
        header.fileOffset = skip < 0 ? 0 : header.fileOffset + skip;
    }
    return read;
}

Result<FileHeader> readMetaHeader(const std::filesystem::path& path) {
    Result<FileHeader> read = readFields(path, kMeta);
    if (!read) {
        return read;
    }
    FileHeader& header = *read;
    const Result<std::vector<std::int64_t>> sizes =
        integers(path, "DimSize", fieldOr(header, {"dimsize"}, ""));
    if (!sizes) {
        return tl::unexpected(sizes.error());
    }
    if (parseInteger(fieldOr(header, {"ndims"}, "")) != static_cast<std::int64_t>(sizes->size())) {
        return unreadable(path, "'NDims' and the number of values in 'DimSize' differ");
    }
    header.sizes = *sizes;
    for (const std::string_view word :
         words(fieldOr(header, {"elementspacing", "elementsize"}, ""))) {
        header.spacings.push_back(realOrNan(word));
    }
    header.components = parseInteger(fieldOr(header, {"elementnumberofchannels"}, "1")).value_or(1);
    setType(header, lowerCase(fieldOr(header, {"elementtype"}, "none")), metaTypes());
    const bool compressed =
        lowerCase(fieldOr(header, {"compresseddata"}, "false")).starts_with('t');
    const bool binary = lowerCase(fieldOr(header, {"binarydata"}, "true")).starts_with('t');
    header.encoding = !binary      ? DataEncoding::Other
                      : compressed ? DataEncoding::Deflate
                                   : DataEncoding::Raw;

    header.deflatedBytes = parseInteger(fieldOr(header, {"compresseddatasize"}, "0")).value_or(0);
    if (compressed && header.deflatedBytes <= 0) {
        return unreadable(path, "is compressed, but there is no field 'CompressedDataSize'");
    }

    const std::string_view dataFile = fieldOr(header, {"elementdatafile"}, "");
    if (dataFile.empty()) {
        return unreadable(path, "there is no field 'ElementDataFile'");
    }
    const bool local = lowerCase(dataFile) == "local";
    header.dataFile = local ? path : besideHeader(path, dataFile);
    header.fileOffset = local ? header.fileOffset : 0;
    const std::int64_t skip = parseSkip(fieldOr(header, {"headersize"}, "0"));
    header.fileOffset = skip < 0 ? 0 : header.fileOffset + skip;
    return read;
}

} // namespace slabcast
