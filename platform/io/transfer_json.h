#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/error.h"
#include "core/transfer/transfer_function.h"
#include "core/volume/statistics.h"

namespace slabcast {

/// {"name": "CT bone", "unit": "HU", "opacityUnitMm": 1.0,
///  "points": [{"value": 150, "color": [0.75, 0.45, 0.30], "opacity": 0.0}, ...]}
/// `unit` and `opacityUnitMm` may be left out.
/// Fails: InvalidTransferFunction, with `sourceName` and the entry's
/// path, as "bone.json: points[2].color[1]: 1.4 is outside 0..1"; keys that are not known fail too.
/// Tested by: transfer_json_test.cpp
Result<TransferFunction> parseTransferFunction(std::string_view json, std::string_view sourceName);

/// Fails: FileNotFound, FileUnreadable, and as parseTransferFunction().
Result<TransferFunction> loadTransferFunction(const std::filesystem::path& path);

/// Built in: ct-bone, ct-bone-skin and ct-lung in HU; angio, linear and mr relative to the
/// data. The files of the latter have the unit "range" and values from 0 to 1, which are laid
/// over [min, max] of the data; for mr, over [min, the value that 99.9 % of the voxels do not
/// exceed], as a few bright vessels would darken the rest.
/// Fails: InvalidArgument (no such preset).
Result<TransferFunction> presetTransferFunction(std::string_view name,
                                                const VolumeStatistics& statistics);

/// In alphabetical order.
std::vector<std::string> presetNames();

/// A preset in which something of the data is visible.
std::string defaultPresetName(Modality modality, const VolumeStatistics& statistics);

} // namespace slabcast
