#include "perf/error/error_table.h"

#include <algorithm>
#include <cstdio>
#include <vector>

namespace slabcast {

namespace {

std::string number(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.4g", value);
    return text;
}

struct Expectation {
    ErrorChoice choice;
    std::vector<SceneLabel> scenes; // each once

    void add(const MeasuredError& row) {
        choice.expectedRmse = std::max(choice.expectedRmse, row.rmse);
        choice.expectedMsPerMegapixel = std::max(choice.expectedMsPerMegapixel, row.msPerMegapixel);
        ++choice.measurements;
        if (std::find(scenes.begin(), scenes.end(), row.scene) == scenes.end()) {
            scenes.push_back(row.scene);
        }
    }
};

/// One per sampling that most scenes were measured with: the worst of its measurements.
std::vector<ErrorChoice> expectations(std::span<const MeasuredError> table, const SceneLabel& scene,
                                      bool ofThisScene) {
    std::vector<Expectation> expected;
    std::size_t mostScenes = 0;
    for (const MeasuredError& row : table) {
        if (row.scene.space != scene.space || (ofThisScene && row.scene != scene)) {
            continue;
        }
        auto entry = std::find_if(expected.begin(), expected.end(), [&row](const Expectation& e) {
            return e.choice.sampling == row.sampling;
        });
        if (entry == expected.end()) {
            entry = expected.insert(entry,
                                    {{.sampling = row.sampling, .ofThisScene = ofThisScene}, {}});
        }
        entry->add(row);
        mostScenes = std::max(mostScenes, entry->scenes.size());
    }
    std::vector<ErrorChoice> choices;
    for (const Expectation& e : expected) {
        if (e.scenes.size() == mostScenes) {
            choices.push_back(e.choice);
        }
    }
    return choices;
}

} // namespace

std::string describe(const Sampling& s) {
    return std::string(name(s.classification)) + ", " + name(s.target) + ", a layer every " +
           number(s.layerSpacingVoxels) + " voxels, " +
           (s.layersPerPlane == 0 ? "all" : std::to_string(s.layersPerPlane)) + " per plane, " +
           "termination " + (s.termination ? number(*s.termination) : "off") +
           (s.jitter ? ", jittered" : "");
}

Settings withSampling(const Settings& base, const Sampling& sampling, const SceneFacts& facts) {
    Settings settings = base;
    settings.classification = sampling.classification;
    settings.target = sampling.target;
    settings.termination = sampling.termination;
    settings.jitter = sampling.jitter;
    settings.layerSpacingVoxels = sampling.layerSpacingVoxels;
    settings.totalLayers.reset();
    settings.planes.reset();
    const int total = totalLayers(settings, facts);
    const int length =
        sampling.layersPerPlane == 0 ? total : std::min(sampling.layersPerPlane, total);
    settings.layersPerPlane = length;
    settings.form = unrollLengthFor(length) == 0 ? SegmentForm::Loop : base.form;
    return settings;
}

Result<ErrorChoice> cheapestWithin(double rmse, const SceneLabel& scene,
                                   std::span<const MeasuredError> table) {
    std::vector<ErrorChoice> expected = expectations(table, scene, true);
    if (expected.empty()) {
        expected = expectations(table, scene, false);
    }
    if (expected.empty()) {
        return fail(ErrorCode::FileNotFound,
                    std::string("no errors were measured on this device in ") + name(scene.space) +
                        " space: run `slabcast error` on this volume, or leave --target-error out");
    }
    const auto reaches = [rmse](const ErrorChoice& c) { return c.expectedRmse <= rmse; };
    const auto best = std::min_element(
        expected.begin(), expected.end(), [&](const ErrorChoice& a, const ErrorChoice& b) {
            return reaches(a) && reaches(b) ? a.expectedMsPerMegapixel < b.expectedMsPerMegapixel
                                            : a.expectedRmse < b.expectedRmse;
        });
    if (!reaches(*best)) {
        return fail(ErrorCode::InvalidArgument,
                    "nothing that was measured on this device reaches an RMSE of " + number(rmse) +
                        ": the best is " + number(best->expectedRmse) + " (" +
                        describe(best->sampling) +
                        "); ask for that, or measure finer settings with `slabcast error`");
    }
    return *best;
}

} // namespace slabcast
