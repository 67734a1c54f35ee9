#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "platform/io/base/parse_text.h"
#include "platform/io/volumes/file_header.h"
#include "platform/io/volumes/length_unit.h"
#include "platform/io/volumes/text_header.h"

namespace slabcast {

namespace {

using Path = std::filesystem::path;

std::optional<StoredType> typeOf(std::string_view written) {
    static const std::map<std::string, StoredType> kTypes = {
        {"met_char", {VoxelType::I8}},
        {"met_uchar", {VoxelType::U8}},
        {"met_short", {VoxelType::I16}},
        {"met_ushort", {VoxelType::U16}},
        {"met_int", {VoxelType::I32}},
        {"met_uint", {VoxelType::U32}},
        {"met_long", {VoxelType::I32}},
        {"met_ulong", {VoxelType::U32}},
        {"met_long_long", {VoxelType::F64, Wide::Signed}},
        {"met_ulong_long", {VoxelType::F64, Wide::Unsigned}},
        {"met_float", {VoxelType::F32}},
        {"met_double", {VoxelType::F64}},
    };
    const auto found = kTypes.find(lowerCase(written));
    return found == kTypes.end() ? std::nullopt : std::optional(found->second);
}

bool isTrue(const TextHeader& text, std::initializer_list<const char*> names, const char* unsaid) {
    const std::string_view value = text.findOr(names, unsaid);
    return value.starts_with('T') || value.starts_with('t') || value.starts_with('1');
}

/// `count` finite numbers, or `unsaid` where no field is there.
Result<std::vector<double>> numbersOf(const Path& path, const TextHeader& text,
                                      std::initializer_list<const char*> names, std::size_t count,
                                      std::vector<double> unsaid) {
    const std::optional<std::string_view> written = text.find(names);
    if (!written) {
        return unsaid;
    }
    std::vector<double> values = realsOrNan(*written);
    const bool finite = std::all_of(values.begin(), values.end(),
                                    [](double value) { return std::isfinite(value); });
    if (values.size() != count || !finite) {
        return unreadable(path, fmt::format("the field '{}' should hold {} numbers, and has '{}'",
                                            *names.begin(), count, printable(*written)));
    }
    return values;
}

double unitOf(FileHeader& header, const TextHeader& text) {
    const std::string_view written = text.findOr({"distanceunits"}, "");
    const std::optional<double> factor = millimetresPer(written);
    if (!factor && !isNoUnit(written)) {
        header.notes.push_back(fmt::format("'{}' in field 'DistanceUnits' is no unit of length "
                                           "that is known; taken as mm",
                                           printable(written)));
    }
    return factor.value_or(1.0);
}

Result<Placement> readPlacement(const Path& path, FileHeader& header, const TextHeader& text,
                                std::size_t rank) {
    std::vector<double> identity(rank * rank);
    for (std::size_t axis = 0; axis < rank; ++axis) {
        identity[axis * rank + axis] = 1.0;
    }
    const Result<std::vector<double>> origin =
        numbersOf(path, text, {"Offset", "position", "origin"}, rank, std::vector<double>(rank));
    const Result<std::vector<double>> matrix = numbersOf(
        path, text, {"TransformMatrix", "rotation", "orientation"}, rank * rank, identity);
    if (!origin || !matrix) {
        return tl::unexpected(origin ? matrix.error() : origin.error());
    }
    if (!header.spacings.empty() && header.spacings.size() != rank) {
        return unreadable(path,
                          fmt::format("the field 'ElementSpacing' should hold {} numbers", rank));
    }
    const double unit = unitOf(header, text);
    Placement placement;
    for (int axis = 0; axis < 3; ++axis) {
        const auto at = static_cast<std::size_t>(axis);
        const double spacing = header.spacings.empty() ? 1.0 : header.spacings[at];
        placement.spacingMm[axis] = unit * std::abs(spacing);
        placement.originMm[axis] = unit * (*origin)[at];
        for (int row = 0; row < 3; ++row) {
            placement.direction[axis][row] =
                std::copysign(1.0, spacing) * (*matrix)[at * rank + static_cast<std::size_t>(row)];
        }
    }
    return placement;
}

Result<void> setSource(const Path& path, FileHeader& header, const TextHeader& text,
                       const std::vector<std::int64_t>& sizes) {
    const bool binary = isTrue(text, {"binarydata"}, "true");
    const bool compressed = binary && isTrue(text, {"compresseddata"}, "false");
    header.source.encoding = !binary      ? DataEncoding::Text
                             : compressed ? DataEncoding::Deflate
                                          : DataEncoding::Raw;
    header.bigEndian = isTrue(text, {"binarydatabyteordermsb", "elementbyteordermsb"}, "false");
    const std::string_view written = text.findOr({"elementdatafile"}, "");
    if (written.empty()) {
        return unreadable(path, "there is no field 'ElementDataFile'");
    }
    const bool local = lowerCase(written) == "local";
    Result<std::vector<Path>> files =
        local ? std::vector<Path>{path} : dataFiles(path, text, written, sizes);
    const Result<std::int64_t> deflated = parseSkip(path, text, {"CompressedDataSize"}, 0);
    const Result<std::int64_t> skip = parseSkip(path, text, {"HeaderSize"}, -1);
    if (!files || !deflated || !skip) {
        return tl::unexpected(!files ? files.error() : !skip ? skip.error() : deflated.error());
    }
    if (compressed && local && *deflated == 0) {
        return unreadable(path, "is compressed, but there is no field 'CompressedDataSize'");
    }
    header.source.files = std::move(*files);
    header.source.headerBytes = local ? text.bytes : 0;
    if (compressed) {
        header.source.headerBytes += std::max<std::int64_t>(*skip, 0);
        header.source.deflatedBytes = header.source.files.size() == 1 ? *deflated : 0;
    } else {
        header.source.byteSkip = *skip;
    }
    return {};
}

Result<void> setRescaling(const Path& path, FileHeader& header, const TextHeader& text) {
    const Result<std::vector<double>> slope =
        numbersOf(path, text, {"ElementToIntensityFunctionSlope"}, 1, {1.0});
    const Result<std::vector<double>> offset =
        numbersOf(path, text, {"ElementToIntensityFunctionOffset"}, 1, {0.0});
    if (!slope || !offset) {
        return tl::unexpected(slope ? offset.error() : slope.error());
    }
    header.slope = slope->front();
    header.intercept = offset->front();
    if (header.slope == 0.0) {
        header.notes.emplace_back(
            "its 'ElementToIntensityFunctionSlope' is 0; values are left as stored");
        header.slope = 1.0;
        header.intercept = 0.0;
    }
    return {};
}

} // namespace

Result<FileHeader> parseMetaHeader(std::string_view start, const Path& path) {
    const Result<TextHeader> text = parseMetaText(path, start);
    if (!text) {
        return tl::unexpected(text.error());
    }
    const Result<std::vector<std::int64_t>> sizes = parseSizes(path, *text, "DimSize", "NDims");
    if (!sizes) {
        return tl::unexpected(sizes.error());
    }
    FileHeader header;
    setAxes(header, *sizes);
    header.spacings = realsOrNan(text->findOr({"elementspacing", "elementsize"}, ""));
    header.components = parseInteger(text->findOr({"elementnumberofchannels"}, "1")).value_or(1);
    header.typeName = printable(text->findOr({"elementtype"}, "none"));
    header.type = typeOf(text->findOr({"elementtype"}, ""));
    header.unit = text->findOr({"unit"}, "");
    header.modality = parseModality(text->findOr({"modality"}, ""));
    const Result<void> sound = setSource(path, header, *text, *sizes).and_then([&]() {
        return setRescaling(path, header, *text);
    });
    if (!sound) {
        return tl::unexpected(sound.error());
    }
    if (header.sizes.size() == 3) {
        header.placement = readPlacement(path, header, *text, sizes->size());
    }
    return header;
}

Result<FileHeader> readMetaHeader(const Path& path) {
    return parseMetaHeader(textStart(path), path);
}

} // namespace slabcast
