#pragma once

#include <string>

#include "core/volume/volume.h"
#include "platform/json/transfer_json.h"

namespace slabcast {

/// `tf`: a preset's name, a JSON file, or empty for the default of the volume's modality and range.
/// A line on stderr says where its unit is not the volume's: the picture may be right all the same.
/// Fails: as presetTransferFunction() and loadTransferFunction().
Result<TransferFunction> chooseTransferFunction(const std::string& tf,
                                                const TransferSubject& subject, Modality modality);

/// Whether what chooseTransferFunction() gives lies elsewhere for outliers of the data
/// (VolumeStatistics::bulk): it has no values of its own.
bool isLaidOverBulk(const std::string& tf, const TransferSubject& subject, Modality modality);

} // namespace slabcast
