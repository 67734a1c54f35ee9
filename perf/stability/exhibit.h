#pragma once

#include "perf/stability/expected.h"

namespace slabcast::stability {

/// The method's settings with the exhibit's lattice.
Settings settingsFor(const Exhibit& exhibit, const Method& method);

/// Every method against float64 evaluation of its own samples; and one case for all of them: that
/// no component is NaN or infinite.
void recordAgainstSamples(Bench& bench, const Exhibit& exhibit);

/// Every method against the closed form of one material; `adjust` takes out what it does not hold
/// for.
void recordUniform(Bench& bench, const Exhibit& exhibit, double extinctionPerMm, glm::dvec3 color,
                   const std::function<void(ExpectedPicture&)>& adjust = {});

/// Every method against pixels that are known, each with its own bound but for blending.
void recordAgainst(Bench& bench, const Exhibit& exhibit, const std::string& reason,
                   ExpectedPicture expected);

/// Every method against the integral without any sampling. Of a view without scale, every column.
void recordAgainstIntegral(Bench& bench, const Exhibit& exhibit);

/// That tight planes and skipped space change no bit, by any method.
void recordSkippingChangesNothing(Bench& bench, const Exhibit& exhibit);

/// That two scenes show the same picture bit for bit, by every method. Both are seen in the
/// exhibit's way, the second by `otherView`.
void recordSamePicture(Bench& bench, const Exhibit& exhibit, const Scene& other,
                       const View& otherView, const std::string& reason);

} // namespace slabcast::stability
