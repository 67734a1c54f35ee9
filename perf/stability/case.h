#pragma once

#include <cstdint>
#include <initializer_list>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <glm/glm.hpp>

#include "core/base/error.h"
#include "perf/number.h"

namespace slabcast::stability {

struct Picture {
    glm::ivec2 size{0};
    std::vector<glm::vec4> pixels; // premultiplied, rows from the bottom up
};

struct NamedPicture {
    std::string name;
    Picture picture;
};

/// A case's place in a plot of its family: y against x, a line per group; cases with the same
/// labels share it, and panels split it.
struct Series {
    std::string group;
    std::string panel; // may be empty
    double x = 0.0;
    double y = 0.0;
    std::string xLabel;
    std::string yLabel;
    std::optional<double> bound{}; // of y, where a plot is to show it
};

/// What one input's last digit does to a picture: a line of the table of condition numbers.
struct Condition {
    std::string scene;
    std::string input;
    double perturbation = 0.0;   // relative, of the input
    double largestChange = 0.0;  // of any component of any pixel, of full scale
    std::optional<double> limit; // of change / perturbation, by derivatives; none: past a step
    double jumpingShare = 0.0;   // of the pixels that the volume covers: past what derivatives say
};

/// A line of the table of what a plan left out, with GL's word for it.
struct LeftOut {
    std::vector<std::string> plan; // the plan's reasons
    int activeUniforms = 0;
    std::vector<std::string> samplers;
    std::int64_t fragments = 0;
    std::int64_t layers = 0;
    std::int64_t volumeAndSkipBytes = 0;
    int timedFrames = 0;
    double leastFrameMs = 0.0; // of the timed ones: no claim, since a machine's load is in it
    double leastFrameMsWithAll = 0.0;
};

/// One claim that was put to the test: that `measured` stays at or below `bound`. The bound is
/// derived before anything is drawn, from what formats, rounding and the method allow.
struct Case {
    std::string family;   // "stiff"
    std::string name;     // unique: "one-unit step, slicing, rgba8"
    std::string quantity; // what is measured, and its unit
    double bound = 0.0;
    std::string reason; // where the bound comes from
    double measured = 0.0;
    std::string failure{};                // why nothing could be measured; such a case fails
    std::vector<NamedPicture> pictures{}; // few: what the page shows beside the figures
    std::optional<Series> series{};
    std::optional<LeftOut> leftOut{};
    std::optional<Condition> condition{};

    bool pass() const { return failure.empty() && measured <= bound; } // false for NaN
    /// Whether a picture could exceed the bound at all.
    bool couldFail() const { return bound < 1.0 || !quantity.ends_with("of full scale"); }
};

/// "one-unit step, slicing, rgba8": the parts of a name, those that are empty left out.
std::string named(std::initializer_list<std::string_view> parts);

/// Fails: Internal, with how many cases exceed their bounds, and the first one's name.
/// Tested by: stability_gl_test.cpp
Result<void> verdict(std::span<const Case> cases);

} // namespace slabcast::stability
