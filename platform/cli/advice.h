#pragma once

#include <string>
#include <vector>

#include "core/transfer/transfer_function.h"
#include "core/volume/statistics.h"
#include "core/volume/volume.h"

namespace slabcast {

/// What a picture's look depends on.
struct PictureSubject {
    glm::ivec3 dims{1};
    glm::dvec3 spacingMm{1.0};
    VolumeStatistics statistics;
    TransferFunction tf;
    bool laidOverBulk = false;   // the TF has no values of its own, and outliers were left out
    double texelStep = 0.0;      // between neighbouring values of texels; 0 where they are exact
    double filteredStep = 0.0;   // that of the format that the device would filter
    bool anythingVisible = true; // of what lies between voxels, as the scene found
    bool mayBeConstant = false;  // one value everywhere is what was asked for
};

/// Why a picture of it is not what a person would expect, each with a remedy: one line a cause, the
/// most telling first. Nothing of ordinary scenes. Cost: O(points). Tested by: cli_pictures_test.py
std::vector<std::string> adviceOn(const PictureSubject& subject);

/// A data value with the fewest digits, 6 or more, that tell it from others at a distance of
/// `resolution`; 0: that are read as the same number again. Whole numbers have all their digits.
std::string valueText(double value, double resolution);

} // namespace slabcast
