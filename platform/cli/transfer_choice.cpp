#include "platform/cli/transfer_choice.h"

#include <fmt/core.h>

namespace slabcast {

namespace {

/// Values of a CT are taken for HU where the file does not say.
void sayWhereUnitsDiffer(const std::string& tf, const std::string& unit,
                         const TransferSubject& subject, Modality modality) {
    const bool isCt = modality == Modality::Ct && subject.unit.empty();
    const std::string_view ofVolume = isCt ? "HU" : subject.unit;
    if (unit.empty() || unit == ofVolume) {
        return;
    }
    fmt::print(stderr, "slabcast: {}: its values are in {}, the volume's in {}\n", tf, unit,
               ofVolume.empty() ? "no unit that the file names" : ofVolume);
}

} // namespace

Result<TransferFunction> chooseTransferFunction(const std::string& tf,
                                                const TransferSubject& subject, Modality modality) {
    const std::string name = tf.empty() ? defaultPresetName(modality, subject.statistics) : tf;
    Result<TransferFunction> chosen = name.ends_with(".json")
                                          ? loadTransferFunction(name, subject)
                                          : presetTransferFunction(name, subject.statistics);
    if (chosen) {
        sayWhereUnitsDiffer(name, chosen->unit, subject, modality);
    }
    return chosen;
}

} // namespace slabcast
