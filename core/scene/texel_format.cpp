#include "core/scene/texel_format.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

namespace slabcast {

namespace {

/// Of the range that texels use, in sampled units.
struct Scale {
    double full;
    double step;           // coarsest rounding of a stored or filtered value
    double fetchTolerance; // a fetched texel is converted to float32 and no further
};

// In the order of TexelFormat. R16F holds integers to +-2048.
constexpr Scale kScales[] = {
    {1.0, 1.0 / 255.0, 0.1 / 255.0},
    {1.0, 1.0 / 65535.0, 0.1 / 65535.0},
    {4096.0, 1.0, 0.0},
    {65535.0, 1.0, 0.01},
    {1.0, 0.0, 0.0},
};

const Scale& scaleOf(TexelFormat format) {
    return kScales[static_cast<std::size_t>(format)];
}

std::string formatted(const char* pattern, double value) {
    char text[96];
    std::snprintf(text, sizeof text, pattern, value);
    return text;
}

double deviation(double measured, double expected) {
    const double error = std::abs(measured - expected);
    return std::isnan(error) ? HUGE_VAL : error; // a NaN would pass every comparison
}

struct FilterVerdict {
    double worstError = 0.0;
    double worstExcess = 0.0; // over what eight-bit weights and the format's rounding explain
    double shareAtExcess = 0.0;
    bool nearest = true; // every sample is one of its texels, though most lie between two
};

FilterVerdict judgeFilter(const Scale& scale, std::span<const FilterSample> samples) {
    FilterVerdict verdict;
    for (const FilterSample& sample : samples) {
        const double difference = sample.high - sample.low;
        const double error = deviation(sample.measured, sample.expected);
        const double excess = error - (sample.axes * difference / 256.0 + scale.step);
        if (excess > verdict.worstExcess) {
            verdict.worstExcess = excess;
            verdict.shareAtExcess = error / difference;
        }
        verdict.worstError = std::max(verdict.worstError, error);
        verdict.nearest &= std::min(deviation(sample.measured, sample.low),
                                    deviation(sample.measured, sample.high)) <= scale.step;
    }
    return verdict;
}

double worstFetchError(std::span<const FetchSample> samples) {
    double worst = 0.0;
    for (const FetchSample& sample : samples) {
        worst = std::max(worst, deviation(sample.measured, sample.expected));
    }
    return worst;
}

const TexelFormatTest* find(std::span<const TexelFormatTest> tests, TexelFormat format) {
    const auto at = std::find_if(tests.begin(), tests.end(),
                                 [&](const auto& test) { return test.format == format; });
    return at == tests.end() ? nullptr : &*at;
}

bool isUsable(std::span<const TexelFormatTest> tests, TexelFormat format) {
    const TexelFormatTest* test = find(tests, format);
    return test != nullptr && test->usable;
}

std::string whyNot(std::span<const TexelFormatTest> tests, TexelFormat format) {
    const TexelFormatTest* test = find(tests, format);
    return std::string(name(format)) + " is not usable (" +
           (test == nullptr ? "not tested" : test->reason) + ")";
}

std::string tooLong(double step) {
    return formatted(" has steps of %.3g, too long for what is shown", step);
}

/// What a format keeps of voxels wider than eight bits.
std::string precisionOf(TexelFormat format, bool shortIntegers, double range) {
    if (shortIntegers) {
        return format == TexelFormat::R16 ? "keeps every 16-bit integer"
                                          : "keeps integers of up to 12 bits, rounds wider ones";
    }
    const double levels = format == TexelFormat::R16 ? 65535.0 : 4096.0;
    return formatted("rounds by at most %.3g data units", 0.5 * range / levels);
}

TexelFormat fetchedFormat(bool shortIntegers) {
    return shortIntegers ? TexelFormat::Rg8Exact : TexelFormat::R32fExact;
}

} // namespace

TexelFormatTest judgeTexelFormat(TexelFormat format, std::span<const FilterSample> filtered,
                                 std::span<const FetchSample> fetched) {
    const Scale& scale = scaleOf(format);
    const FilterVerdict filter = judgeFilter(scale, filtered);
    TexelFormatTest test{.format = format,
                         .maxFilterError = filter.worstError / scale.full,
                         .maxFetchError = worstFetchError(fetched) / scale.full};
    if (test.maxFetchError * scale.full > scale.fetchTolerance) {
        test.reason = formatted("fetched texels are off by %.2g of full scale", test.maxFetchError);
    } else if (isExact(format)) {
        test.usable = true;
        test.reason = "texels are fetched as stored";
    } else if (filtered.empty() || filter.nearest) {
        test.reason = "not filtered: samples between two texels are one of them";
    } else if (filter.worstExcess > 0.0) {
        test.reason = formatted("filtered values are off by %.2g of the texels' difference",
                                filter.shareAtExcess);
    } else {
        test.usable = true;
        test.reason = formatted("filtered to within %.2g of full scale", test.maxFilterError);
    }
    return test;
}

double longestTexelStep(const VolumeStatistics& statistics, const TransferFunction& tf) {
    constexpr double kStepsOfBulk = 32.0;
    constexpr double kStepsOfBand = 4.0;
    const auto ofRange = [](double low, double high, double steps) {
        return high > low ? (high - low) / steps : std::numeric_limits<double>::infinity();
    };
    const ValueRange bulk = statistics.shown();
    const ValueRange visible = visibleValues(tf).value_or(ValueRange{});
    return std::min(ofRange(bulk.min, bulk.max, kStepsOfBulk),
                    ofRange(visible.min, visible.max, kStepsOfBand));
}

double texelStep(TexelFormat format, VoxelType type, const VolumeStatistics& statistics) {
    const double levels = format == TexelFormat::R8    ? 255.0
                          : format == TexelFormat::R16 ? 65535.0
                                                       : 4096.0;
    const double range = statistics.max - statistics.min;
    const bool keepsIntegers = !isFloatingPoint(type) && range <= levels;
    return isExact(format) || keepsIntegers || bytesPerVoxel(type) == 1 ? 0.0 : range / levels;
}

TexelFormat chooseTexelFormat(VoxelType type, const VolumeStatistics& statistics, bool exact,
                              double longestStep, std::span<const TexelFormatTest> tests,
                              std::string* reason) {
    std::string ignored;
    std::string& why = reason == nullptr ? ignored : *reason;
    const bool shortIntegers = !isFloatingPoint(type) && bytesPerVoxel(type) <= 2;
    if (exact) {
        why = std::string("exact: interpolated in the shader from ") +
              name(fetchedFormat(shortIntegers));
        return fetchedFormat(shortIntegers);
    }
    if (bytesPerVoxel(type) == 1) {
        why = "R8 keeps every 8-bit voxel";
        return TexelFormat::R8;
    }
    std::string rejected;
    for (const TexelFormat format : {TexelFormat::R16, TexelFormat::R16F}) {
        const double step = texelStep(format, type, statistics);
        if (isUsable(tests, format) && step <= longestStep) {
            why = std::string(name(format)) + " " +
                  precisionOf(format, shortIntegers, statistics.max - statistics.min) + rejected;
            return format;
        }
        rejected +=
            "; " + (isUsable(tests, format) ? name(format) + tooLong(step) : whyNot(tests, format));
    }
    why =
        std::string(name(fetchedFormat(shortIntegers))) + ", interpolated in the shader" + rejected;
    return fetchedFormat(shortIntegers);
}

} // namespace slabcast
