#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/volume/volume.h"

namespace slabcast {

std::string_view trimmed(std::string_view text);
std::string lowerCase(std::string_view text);

/// Between the separators, none left out; an empty text is one empty part.
std::vector<std::string_view> split(std::string_view text, char separator);
/// Between blanks, as many as there are.
std::vector<std::string_view> words(std::string_view text);

/// Words with one blank between them: what other libraries say over several lines.
std::string oneLine(std::string_view text);

/// The whole text as a number, or nothing. Integers beyond 64 bits become the nearest that
/// fits, so that size checks report them as what they are.
std::optional<std::int64_t> parseInteger(std::string_view text);
/// Also "nan" and "inf".
std::optional<double> parseReal(std::string_view text);

/// "uint8", "int16", "float", "double", ...: the names that `name(VoxelType)` gives.
std::optional<VoxelType> parseVoxelType(std::string_view text);

/// Whether 'slice2.png' comes before 'slice10.png': runs of digits compare as numbers.
bool naturallyBefore(std::string_view a, std::string_view b);

} // namespace slabcast
