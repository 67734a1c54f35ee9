#include "platform/json/preset_texts.h"
#include "platform/json/transfer_json.h"

namespace slabcast {

Result<TransferFunction> presetTransferFunction(std::string_view name,
                                                const VolumeStatistics& statistics) {
    const auto found = presetTexts().find(std::string(name));
    if (found == presetTexts().end()) {
        std::string known;
        for (const std::string& preset : presetNames()) {
            known += preset + ", ";
        }
        return fail(ErrorCode::InvalidArgument, "no preset '" + std::string(name) +
                                                    "'; choose one of " + known +
                                                    "or name a .json file");
    }
    return parseTransferFunction(found->second, found->first + ".json", {statistics, ""});
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
    const ValueRange range = statistics.shown();
    if (modality == Modality::Mr) {
        return "mr";
    }
    if (modality == Modality::Ct && range.max >= kBoneHu) {
        return "ct-bone";
    }
    return modality == Modality::Ct && range.min <= kAirHu ? "ct-lung" : "linear";
}

} // namespace slabcast
