#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "platform/io/preset_texts.h"
#include "platform/io/transfer_json.h"

namespace slabcast {

namespace {

constexpr double kRobustShare = 0.999;

/// The upper edge of the histogram's bin up to which `share` of the voxels lie.
double percentile(const VolumeStatistics& statistics, double share) {
    std::int64_t total = 0;
    for (const std::int64_t count : statistics.histogram) {
        total += count;
    }
    const auto wanted = static_cast<std::int64_t>(std::ceil(share * static_cast<double>(total)));
    std::int64_t below = 0;
    std::size_t bin = 0;
    while (bin < statistics.histogram.size() && below < wanted) {
        below += statistics.histogram[bin++];
    }
    const double position =
        static_cast<double>(bin) / static_cast<double>(statistics.histogram.size());
    return statistics.min + position * (statistics.max - statistics.min);
}

/// Lays values of 0 to 1 over the data. Where all voxels are alike, any span keeps the points
/// in order.
void layOver(TransferFunction& tf, double low, double high) {
    const double span = high > low ? high - low : 1.0;
    for (TransferPoint& point : tf.points) {
        point.value = low + point.value * span;
    }
    tf.unit.clear();
}

} // namespace

Result<TransferFunction> presetTransferFunction(std::string_view name,
                                                const VolumeStatistics& statistics) {
    const auto found = presetTexts().find(std::string(name));
    if (found == presetTexts().end()) {
        return fail(ErrorCode::InvalidArgument,
                    fmt::format("no preset '{}'; choose one of {}, or name a .json file", name,
                                fmt::join(presetNames(), ", ")));
    }
    Result<TransferFunction> tf = parseTransferFunction(found->second, found->first + ".json");
    if (tf && tf->unit == "range") {
        layOver(*tf, statistics.min,
                name == "mr" ? percentile(statistics, kRobustShare) : statistics.max);
    }
    return tf;
}

std::vector<std::string> presetNames() {
    std::vector<std::string> names;
    for (const auto& [name, text] : presetTexts()) {
        names.push_back(name);
    }
    return names;
}

std::string defaultPresetName(Modality modality, const VolumeStatistics& statistics) {
    constexpr double kBoneHu = 300.0;
    constexpr double kAirHu = -900.0;
    if (modality == Modality::Mr) {
        return "mr";
    }
    if (modality == Modality::Ct && statistics.max >= kBoneHu) {
        return "ct-bone";
    }
    return modality == Modality::Ct && statistics.min <= kAirHu ? "ct-lung" : "linear";
}

} // namespace slabcast
