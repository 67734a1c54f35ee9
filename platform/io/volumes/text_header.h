#pragma once

#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/error.h"
#include "core/volume/volume.h"

namespace slabcast {

/// The lines of text that an NRRD or MetaImage file begins with.
struct TextHeader {
    std::map<std::string, std::string> fields; // names in lower case
    std::map<std::string, std::string> keys;   // NRRD's "key:=value", likewise
    std::vector<std::string> listed;           // the lines behind a field of "LIST"
    std::int64_t bytes = 0;                    // in the file, end of the last line included
    bool ended = false;                        // as the format says, rather than with the text

    /// The value under the first of the names, in either case, that is there.
    std::optional<std::string_view> find(std::initializer_list<const char*> names) const;
    std::string_view findOr(std::initializer_list<const char*> names,
                            std::string_view otherwise) const;
};

/// From the start of a file. Fails: FileUnreadable (another format, a line that is no field, a
/// field with two values). Tested by: io_header_test.cpp
Result<TextHeader> parseNrrdText(const std::filesystem::path& path, std::string_view start);
Result<TextHeader> parseMetaText(const std::filesystem::path& path, std::string_view start);

/// As much of a file as a header of text may take.
std::string textStart(const std::filesystem::path& path);

/// FileUnreadable: the file, why, and to check it.
tl::unexpected<Error> unreadable(const std::filesystem::path& path, std::string_view why);

/// What a header says, fit for a message: cut to a line's part and without control characters.
std::string printable(std::string_view text);

/// Fails: FileUnreadable (no integer).
Result<std::vector<std::int64_t>> parseIntegers(const std::filesystem::path& path,
                                                std::string_view name, std::string_view text);
/// The sizes that a field holds, as many as another field, `rank`, says, and at most 16.
/// Fails: FileUnreadable.
Result<std::vector<std::int64_t>> parseSizes(const std::filesystem::path& path,
                                             const TextHeader& text, const char* name,
                                             const char* rank);
/// A number between `least` and 2^60, which lies beyond any file; 0 where the field is not there.
/// Fails: FileUnreadable (no integer, too small).
Result<std::int64_t> parseSkip(const std::filesystem::path& path, const TextHeader& text,
                               std::initializer_list<const char*> names, std::int64_t least);
/// What is no number reads as NaN.
std::vector<double> realsOrNan(std::string_view text);

/// "ct", "MET_MOD_MR" and the like; else unknown.
Modality parseModality(std::string_view text);

/// The files of voxels that a field of one name, of "LIST" or of a pattern as "s%03d.raw 1 9 1"
/// stands for. Each holds the first axes of `sizes`, as many as a further number says, or all but
/// the last. Fails: FileUnreadable (not as many as the sizes ask for; more than 100000).
/// Tested by: io_header_test.cpp
Result<std::vector<std::filesystem::path>> dataFiles(const std::filesystem::path& path,
                                                     const TextHeader& text,
                                                     std::string_view written,
                                                     const std::vector<std::int64_t>& sizes);

} // namespace slabcast
