#pragma once

#include <span>
#include <string_view>

namespace slabcast {

/// What is published of a GPU, as it is built into one device. All of it at the given clock; what
/// nobody published is a range.
struct GpuRates {
    const char* name;     // as --device has it
    const char* compiler; // as the compilers' table has it: the 650's code is the 660's
    const char* title;    // with the device that it is of
    const char* renderer; // as its GL_RENDERER begins
    double megahertz;
    int cores;
    // Per clock, of all cores together.
    double issueSlots;         // instructions of one fragment each: tuples, FMAs, instructions
    double issueSlotsHigh;     // where sources differ: the most that is claimed
    double texels;             // bilinear, of 32 bits
    double fragments;          // that are begun
    double pixels;             // blended into the tile, of 32 bits
    double texelsOf3d;         // cost of a filtered 3D fetch, in bilinear ones
    int waveWidth, waveHeight; // pixels that run in lockstep
    double gigabytesPerSecond; // to memory, shared with all else
    int codeBytesLow, codeBytesHigh; // that the instruction cache of a core holds
    const char* source;
};

/// Sources are in gpu_rates.cpp, one by one. Tested by: frame_model_test.cpp
std::span<const GpuRates> gpuRates();

/// Null where no GPU has this name.
const GpuRates* findGpuRates(std::string_view name);

} // namespace slabcast
