#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <glm/glm.hpp>

namespace slabcast {

/// What a microscope's program says about the pages of a TIFF, in the first page's description.
struct ImageStatement {
    enum class Program : std::uint8_t { Unknown, ImageJ, Ome };

    /// Which page holds what, where the file says so page by page; from 0.
    struct Place {
        std::int64_t channel;
        std::int64_t slice;
        std::int64_t frame;
        std::int64_t page;
        std::int64_t count; // of pages that follow, 0: all that are left
    };

    Program program = Program::Unknown;
    std::int64_t images = 0; // all of them, 0: unsaid
    std::int64_t channels = 1;
    std::int64_t slices = 0; // 0: unsaid
    std::int64_t frames = 1;
    std::string order = "CZT"; // the fastest first
    std::vector<Place> places;
    int volumes = 1;                   // OME: images in one file
    std::array<double, 3> lengthsMm{}; // of a voxel, 0: unsaid
    bool isWithoutUnit = false;        // lengths have no unit: millimetres are assumed
    double slope = 1.0;                // data value = slope * stored + intercept
    double intercept = 0.0;
    std::string unit;               // of the values
    std::vector<std::string> notes; // what was left aside
};

/// Resolutions are the page's, in pixels per unit, 0: unsaid; ImageJ gives them in its own unit.
/// Untrusted text: numbers that make no sense count as unsaid. Tested by: io_image_text_test.cpp
ImageStatement parseStatement(std::string_view description, std::array<double, 2> resolution);

} // namespace slabcast
