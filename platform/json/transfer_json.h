#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/error.h"
#include "core/transfer/transfer_function.h"
#include "core/volume/statistics.h"

namespace slabcast {

/// Whose values a transfer function is read for.
struct TransferSubject {
    const VolumeStatistics& statistics;
    std::string_view unit; // of the volume's values; empty where none is known
};

/// {"name": "CT bone", "unit": "HU", "opacityUnitMm": 1.0,
///  "points": [{"value": 150, "color": [0.75, 0.45, 0.30], "opacity": 0.0}, ...]}
/// `unit` and `opacityUnitMm` may be left out. Under the unit "range" values of 0 to 1 are laid
/// over VolumeStatistics::shown(), or up to the value that `rangeShare` of the voxels do not
/// exceed: a few bright vessels would darken the rest; fill values are hidden. What comes back then has values of the data and no
/// unit. Other units are "HU" and the volume's; whether they are the same is the caller's to say.
/// Fails: InvalidTransferFunction, with `sourceName` and the entry's path, as
/// "bone.json: points[2].color[1]: 1.4 is outside 0..1"; keys and units that are not known fail
/// too. Tested by: transfer_json_test.cpp
Result<TransferFunction> parseTransferFunction(std::string_view json, std::string_view sourceName,
                                               const TransferSubject& subject);

/// Fails: FileNotFound, FileUnreadable, and as parseTransferFunction().
Result<TransferFunction> loadTransferFunction(const std::filesystem::path& path,
                                              const TransferSubject& subject);

/// Built in, the files of assets/transfer_functions/: ct-bone, ct-bone-skin and ct-lung in HU;
/// angio, linear and mr relative to the data; gap for the phantom of that name.
/// Fails: InvalidArgument (no such preset).
Result<TransferFunction> presetTransferFunction(std::string_view name,
                                                const VolumeStatistics& statistics);

/// In alphabetical order.
std::vector<std::string> presetNames();

/// A preset in which something of the data is visible.
std::string defaultPresetName(Modality modality, const VolumeStatistics& statistics);

} // namespace slabcast
