#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/gl/caps.h"
#include "core/transfer/transfer_function.h"
#include "core/volume/statistics.h"
#include "core/volume/texels.h"

namespace slabcast {

/// What drawing from a tiny 3D texture and reading the result back found out about one format on
/// this device.
struct TexelFormatTest {
    TexelFormat format = TexelFormat::R8;
    bool usable = false;
    /// Largest deviation from exact trilinear interpolation, relative to full scale (the difference
    /// of the two texels at the ends of the format's range). Exact formats are not filtered: 0.
    double maxFilterError = 0.0;
    /// Largest deviation of a texelFetch from the texel, relative to the format's full scale.
    double maxFetchError = 0.0;
    std::string reason{}; // one line, for people
};

/// One sample that the device filtered, in sampled units: texel/max, or the float.
struct FilterSample {
    double expected = 0.0; // exact trilinear interpolation
    double measured = 0.0;
    double low = 0.0; // smallest and largest of its texels
    double high = 0.0;
    int axes = 1; // along which it lies between texels: each may add its weight's error
};

struct FetchSample {
    double expected = 0.0;
    double measured = 0.0;
};

/// Usable where every fetch gives its texel and every filtered sample stays within 1/256 of the
/// difference per axis (weights of eight bits, cut off) and one rounding step of the format. Pure.
/// Tested by: texel_format_gl_test.cpp
TexelFormatTest judgeTexelFormat(TexelFormat format, std::span<const FilterSample> filtered,
                                 std::span<const FetchSample> fetched);

/// One entry per format, in the enumeration's order; those that the device lacks are entries that
/// are not usable. Extensions promise that a format exists, not that it is filtered
/// (EXT_texture_norm16), and no query tells. Saves and restores the GL state. Cost: 40 small draws,
/// once per device. Tested by: texel_format_gl_test.cpp
std::vector<TexelFormatTest> selfTestTexelFormats(const gl::Caps& caps);

/// What drawing from a tiny RGBA16F table and reading the result back found out about the device's
/// filter.
struct TableFilterTest {
    bool usable = false;
    double maxError = 0.0; // from exact interpolation, relative to the difference of the two texels
    std::string reason{};  // one line, for people
};

/// Usable where what lies between two zeros is exactly zero, and every sample stays within 1/256 of
/// the difference of its texels (weights of eight bits, cut off) and one rounding step of fp16.
/// Pure. Tested by: texel_format_test.cpp
TableFilterTest judgeTableFilter(std::span<const FilterSample> samples);

/// Saves and restores the GL state. Cost: one small draw, once per device.
/// Tested by: texel_format_gl_test.cpp
TableFilterTest selfTestTableFilter();

/// The longest step between the values of texels that shows what is there: a quarter of what the
/// transfer function makes visible, and a 32nd of where nearly all voxels lie; infinite where
/// neither is bounded. Longer ones miss a thin material, or draw terraces. Pure.
/// Tested by: texel_format_test.cpp
double longestTexelStep(const VolumeStatistics& statistics, const TransferFunction& tf);

/// Between the values of neighbouring texels; 0 where such voxels are kept as they are.
double texelStep(TexelFormat format, VoxelType type, const VolumeStatistics& statistics);

/// R8 for 8-bit voxels; for wider ones R16, or R16F where R16 is not usable: R16 keeps every 16-bit
/// integer and rounds other data 16 times finer. The fetched formats if `exact`, or if nothing else
/// is usable or has steps of `longestStep` or less: two bytes for integers of up to 16 bits,
/// float32 for the rest. Pure. `reason`, if not null, receives one line.
/// Tested by: texel_format_test.cpp, texel_format_gl_test.cpp
TexelFormat chooseTexelFormat(VoxelType type, const VolumeStatistics& statistics, bool exact,
                              double longestStep, std::span<const TexelFormatTest> tests,
                              std::string* reason);

} // namespace slabcast
