#include "platform/io/pictures/image_statement.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include <fmt/format.h>

#include "platform/io/base/parse_text.h"

namespace slabcast {

namespace {

/// Millimetres in a unit of length; nothing where it is none, as 'pixel'.
std::optional<double> millimetresIn(std::string_view unit) {
    static const std::map<std::string, double, std::less<>> kUnits = {
        {"pm", 1e-9},          {"angstrom", 1e-7},   {"\xC3\x85", 1e-7},   {"\xE2\x84\xAB", 1e-7},
        {"nm", 1e-6},          {"nanometer", 1e-6},  {"nanometre", 1e-6},  {"um", 1e-3},
        {"micron", 1e-3},      {"microns", 1e-3},    {"micrometer", 1e-3}, {"micrometre", 1e-3},
        {"micrometers", 1e-3}, {"\xC2\xB5m", 1e-3},  {"\xCE\xBCm", 1e-3},  {"\xB5m", 1e-3},
        {"\\u00b5m", 1e-3},    {"\\u03bcm", 1e-3},   {"&#181;m", 1e-3},    {"&#xb5;m", 1e-3},
        {"&micro;m", 1e-3},    {"&#956;m", 1e-3},    {"&#x3bc;m", 1e-3},   {"mm", 1.0},
        {"millimeter", 1.0},   {"millimetre", 1.0},  {"millimeters", 1.0}, {"cm", 10.0},
        {"centimeter", 10.0},  {"centimetre", 10.0}, {"dm", 100.0},        {"m", 1000.0},
        {"meter", 1000.0},     {"metre", 1000.0},    {"in", 25.4},         {"inch", 25.4},
        {"inches", 25.4},      {"\"", 25.4},         {"ft", 304.8}};
    const auto found = kUnits.find(lowerCase(trimmed(unit)));
    return found == kUnits.end() ? std::nullopt : std::optional(found->second);
}

/// At least `least`, and small enough that a product of three fits.
std::int64_t countIn(std::string_view text, std::int64_t least) {
    const std::optional<std::int64_t> value = parseInteger(text);
    return std::clamp<std::int64_t>(value.value_or(least), least, 1 << 20);
}

/// 0 where the text is no positive length.
double lengthIn(std::string_view text) {
    const double value = std::abs(parseReal(text).value_or(0.0));
    return std::isfinite(value) ? value : 0.0;
}

bool isSound(double length) {
    return std::isfinite(length) && length > 0.0;
}

// ImageJ: a line for each KEY=VALUE, see its class FileSaver.

using Lines = std::map<std::string, std::string, std::less<>>;

std::string_view valueOf(const Lines& lines, std::string_view key) {
    const auto found = lines.find(key);
    return found == lines.end() ? std::string_view() : std::string_view(found->second);
}

void takeImageJLengths(const Lines& lines, std::array<double, 2> resolution,
                       ImageStatement& statement) {
    const std::string_view unit = valueOf(lines, "unit");
    const std::optional<double> unitMm = millimetresIn(unit);
    const double depth = lengthIn(valueOf(lines, "spacing"));
    const bool isPixel = unit.empty() || lowerCase(unit).starts_with("pixel");
    if (!unitMm && !isPixel) {
        statement.notes.push_back(
            fmt::format("its unit of length '{}' is not known", oneLine(unit.substr(0, 40))));
    }
    if (unitMm) {
        for (int axis = 0; axis < 2; ++axis) {
            const double length = *unitMm / (resolution[axis] > 0.0 ? resolution[axis] : 1.0);
            statement.lengthsMm[axis] = isSound(length) ? length : 0.0;
        }
        // ImageJ leaves out a distance of one unit.
        statement.lengthsMm[2] = *unitMm * (depth > 0.0 ? depth : 1.0);
    } else if (isPixel && depth > 0.0 && depth != 1.0) {
        statement.lengthsMm = {1.0, 1.0, depth};
        statement.isWithoutUnit = true;
    }
}

/// The value of `function` 0, a straight line, is c0 + c1 * stored; 20 is none.
void takeImageJValues(const Lines& lines, ImageStatement& statement) {
    const std::string_view text = valueOf(lines, "cf");
    const std::optional<std::int64_t> function = parseInteger(text);
    if (text.empty() || function == 20) {
        return;
    }
    const double intercept = parseReal(valueOf(lines, "c0")).value_or(0.0);
    const double slope = parseReal(valueOf(lines, "c1")).value_or(0.0);
    if (function != 0 || !std::isfinite(slope) || slope == 0.0 || !std::isfinite(intercept)) {
        statement.notes.emplace_back(
            "its calibration of values is no straight line and left aside: values are as stored");
        return;
    }
    statement.slope = slope;
    statement.intercept = intercept;
    const std::string_view unit = trimmed(valueOf(lines, "vunit"));
    statement.unit = lowerCase(unit).starts_with("gray") ? "" : oneLine(unit.substr(0, 40));
}

ImageStatement parseImageJ(std::string_view description, std::array<double, 2> resolution) {
    Lines lines;
    for (const std::string_view line : split(description, '\n')) {
        const std::size_t sign = line.find('=');
        if (sign != std::string_view::npos) {
            lines.emplace(lowerCase(trimmed(line.substr(0, sign))), trimmed(line.substr(sign + 1)));
        }
    }
    ImageStatement statement;
    statement.program = ImageStatement::Program::ImageJ;
    statement.images = countIn(valueOf(lines, "images"), 0);
    statement.channels = countIn(valueOf(lines, "channels"), 1);
    statement.slices = countIn(valueOf(lines, "slices"), 0);
    statement.frames = countIn(valueOf(lines, "frames"), 1);
    takeImageJLengths(lines, resolution, statement);
    takeImageJValues(lines, statement);
    return statement;
}

// OME: attributes of the first element 'Pixels' and of its 'TiffData'. Nothing else of XML is
// needed, nor understood.

/// From behind the element's name to its end; moves `text` behind it. Nothing: no such element.
std::optional<std::string_view> nextElement(std::string_view& text, std::string_view element) {
    for (std::size_t at = text.find(element); at != std::string_view::npos;
         at = text.find(element)) {
        const bool begins = at > 0 && (text[at - 1] == '<' || text[at - 1] == ':');
        text.remove_prefix(at + element.size());
        if (begins && text.find_first_of(" \t\r\n/>") == 0) {
            const std::string_view attributes = text.substr(0, text.find('>'));
            text.remove_prefix(attributes.size());
            return attributes;
        }
    }
    return std::nullopt;
}

std::string_view attribute(std::string_view attributes, std::string_view key) {
    for (std::size_t at = attributes.find(key); at != std::string_view::npos;
         at = attributes.find(key, at + 1)) {
        const bool begins = at > 0 && std::string_view(" \t\r\n").find(attributes[at - 1]) !=
                                          std::string_view::npos;
        const std::string_view rest = trimmed(attributes.substr(at + key.size()));
        if (!begins || !rest.starts_with('=')) {
            continue;
        }
        const std::string_view quoted = trimmed(rest.substr(1));
        const char quote = quoted.empty() ? '\0' : quoted.front();
        const std::size_t end =
            quote == '"' || quote == '\'' ? quoted.find(quote, 1) : std::string_view::npos;
        return end == std::string_view::npos ? std::string_view() : quoted.substr(1, end - 1);
    }
    return {};
}

void takeOmeLengths(std::string_view pixels, ImageStatement& statement) {
    constexpr std::array<std::string_view, 3> kKeys = {"PhysicalSizeX", "PhysicalSizeY",
                                                       "PhysicalSizeZ"};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::string_view unit = attribute(pixels, std::string(kKeys[axis]) + "Unit");
        const double length = lengthIn(attribute(pixels, kKeys[axis]));
        const std::optional<double> unitMm = millimetresIn(unit.empty() ? "um" : unit);
        if (length > 0.0 && unitMm) {
            statement.lengthsMm[axis] = length * *unitMm;
        } else if (length > 0.0 && axis == 0 && lowerCase(unit) != "pixel") {
            statement.notes.push_back(
                fmt::format("its unit of length '{}' is not known", oneLine(unit.substr(0, 40))));
        }
    }
}

ImageStatement parseOme(std::string_view description) {
    ImageStatement statement;
    std::string_view text = description;
    const std::optional<std::string_view> pixels = nextElement(text, "Pixels");
    if (!pixels) {
        return statement;
    }
    statement.program = ImageStatement::Program::Ome;
    statement.channels = countIn(attribute(*pixels, "SizeC"), 1);
    statement.slices = countIn(attribute(*pixels, "SizeZ"), 1);
    statement.frames = countIn(attribute(*pixels, "SizeT"), 1);
    const std::string_view order = attribute(*pixels, "DimensionOrder");
    const std::string_view rest = order.starts_with("XY") ? order.substr(2) : std::string_view();
    std::string sorted(rest);
    std::sort(sorted.begin(), sorted.end());
    statement.order = sorted == "CTZ" ? std::string(rest) : statement.order;
    takeOmeLengths(*pixels, statement);
    std::string_view first = text; // the elements of the first image alone
    while (nextElement(text, "Pixels")) {
        ++statement.volumes;
    }
    while (const std::optional<std::string_view> data = nextElement(first, "TiffData")) {
        const std::string_view page = attribute(*data, "IFD");
        const std::string_view count = attribute(*data, "PlaneCount");
        statement.places.push_back({.channel = countIn(attribute(*data, "FirstC"), 0),
                                    .slice = countIn(attribute(*data, "FirstZ"), 0),
                                    .frame = countIn(attribute(*data, "FirstT"), 0),
                                    .page = countIn(page, 0),
                                    .count = countIn(count, page.empty() ? 0 : 1)});
    }
    return statement;
}

} // namespace

ImageStatement parseStatement(std::string_view description, std::array<double, 2> resolution) {
    const std::string_view text = trimmed(description.substr(0, description.find('\0')));
    if (text.starts_with("ImageJ=")) {
        return parseImageJ(text, resolution);
    }
    const bool isXml = text.starts_with("<?xml") || text.starts_with("<");
    return isXml && text.find("OME") != std::string_view::npos ? parseOme(text) : ImageStatement{};
}

} // namespace slabcast
