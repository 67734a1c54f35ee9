#pragma once

#include "platform/io/volumes/nrrd_header_axes.h"

namespace slabcast::nrrd {

/// Of three axes of space in a file of `rank` axes: by `space directions`, or by `spacings` and
/// `axis mins`. What was assumed is in the header's notes. Fails: FileUnreadable (a field of other
/// length than there are axes).
Result<Placement> placementOfAxes(const std::filesystem::path& path, FileHeader& header,
                                  const TextHeader& text, const std::vector<Axis>& axes,
                                  std::size_t rank);

} // namespace slabcast::nrrd
