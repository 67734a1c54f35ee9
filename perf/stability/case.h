#pragma once

#include <string>
#include <vector>

#include <glm/glm.hpp>

namespace slabcast::stability {

struct Picture {
    glm::ivec2 size{0};
    std::vector<glm::vec4> pixels; // premultiplied, rows from the bottom up
};

struct NamedPicture {
    std::string name;
    Picture picture;
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

    bool pass() const { return failure.empty() && measured <= bound; } // false for NaN
};

} // namespace slabcast::stability
