#pragma once

#include <filesystem>
#include <vector>

#include "core/base/error.h"

namespace slabcast {

/// In natural order of their names: numbers as numbers, small letters as capitals. Where some name
/// has a '+' before a number, or only some have a '-' there, the sign counts: z-02, z-01, z+00.
/// Tested by: io_image_text_test.cpp
void sortByNames(std::vector<std::filesystem::path>& files);

/// Whether the names are those of one series: alike but for their numbers. Names that are all
/// different otherwise count as one, too. Fails: AmbiguousSeries, naming the odd one out or the
/// kinds of names. Tested by: io_image_text_test.cpp
Result<void> checkOneSeries(const std::filesystem::path& folder,
                            const std::vector<std::filesystem::path>& files);

} // namespace slabcast
