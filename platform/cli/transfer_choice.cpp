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

Result<TransferFunction> named(const std::string& name, const TransferSubject& subject) {
    return name.ends_with(".json") ? loadTransferFunction(name, subject)
                                   : presetTransferFunction(name, subject.statistics);
}

std::string nameOf(const std::string& tf, const TransferSubject& subject, Modality modality) {
    return tf.empty() ? defaultPresetName(modality, subject.statistics) : tf;
}

} // namespace

bool isLaidOverBulk(const std::string& tf, const TransferSubject& subject, Modality modality) {
    if (!subject.statistics.bulk) {
        return false;
    }
    VolumeStatistics withOutliers = subject.statistics;
    withOutliers.bulk.reset();
    const std::string name = nameOf(tf, subject, modality);
    const Result<TransferFunction> chosen = named(name, subject);
    const Result<TransferFunction> other = named(name, {withOutliers, subject.unit});
    const auto ends = [](const TransferFunction& one) {
        return std::pair(one.points.front().value, one.points.back().value);
    };
    return chosen && other && ends(*chosen) != ends(*other);
}

Result<TransferFunction> chooseTransferFunction(const std::string& tf,
                                                const TransferSubject& subject, Modality modality) {
    const std::string name = nameOf(tf, subject, modality);
    Result<TransferFunction> chosen = named(name, subject);
    if (chosen) {
        sayWhereUnitsDiffer(name, chosen->unit, subject, modality);
    }
    return chosen;
}

} // namespace slabcast
