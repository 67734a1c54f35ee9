#pragma once

#include <optional>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "core/base/error.h"
#include "core/volume/statistics.h"

namespace slabcast {

struct TransferPoint {
    double value = 0.0;
    glm::dvec3 color{1.0}; // sRGB-encoded, 0 to 1
    double opacity = 0.0;  // of opacityUnitMm of this material
};

/// Piecewise linear in opacity and in encoded colour; two points at one value make a step (the
/// second holds from the value on). Outside the points the end values hold.
struct TransferFunction {
    std::string name;
    std::string unit;
    double opacityUnitMm = 1.0;
    std::vector<TransferPoint> points;
};

/// Largest opacity that a TF keeps: extinction stays finite. For renderer and references alike.
inline constexpr double kMaxOpacity = 1.0 - 1.0 / 16777216.0;

/// Checks order, ranges and finiteness (values within float32), at most two points at one value;
/// clamps opacity to kMaxOpacity.
/// Fails: InvalidTransferFunction, with the path of the offending entry as `points[2].opacity`.
/// Tested by: transfer_function_test.cpp
Result<TransferFunction> validated(TransferFunction tf);

struct TransferSample {
    glm::dvec3 color{0.0}; // sRGB-encoded
    double opacity = 0.0;  // of opacityUnitMm
};

TransferSample evaluate(const TransferFunction& tf, double value);

/// From the first value that is visible to the last; infinite where an end value holds on. Nothing
/// where no opacity is above 0. Tested by: transfer_function_test.cpp
std::optional<ValueRange> visibleValues(const TransferFunction& tf);

/// -ln(1 - opacity) / opacityUnitMm: the extinction coefficient in 1/mm.
double extinctionPerMm(double opacity, double opacityUnitMm);

/// Where compositing happens. Display: encoded values are blended, as most viewers do. Linear:
/// light is blended.
enum class CompositingSpace : std::uint8_t { Display, Linear };

const char* name(CompositingSpace space);
glm::dvec3 linearFromSrgb(glm::dvec3 encoded);
glm::dvec3 srgbFromLinear(glm::dvec3 linear);
/// An encoded colour as it is composited.
glm::dvec3 colorIn(CompositingSpace space, glm::dvec3 encoded);

/// The TF as the GPU filters it: texels at even distances of value; rgb in the compositing space
/// (not premultiplied), alpha = extinction in units of `extinctionPerMm`.
struct TransferTable {
    double firstValue = 0.0;
    double lastValue = 1.0;
    std::vector<glm::vec4> texels;
    double extinctionPerMm = 1.0; // where alpha is 1
    bool wide = false; // texels are float32, since their extinction spans more than fp16 keeps

    double valueAt(std::size_t texel) const {
        const auto last = static_cast<double>(texels.size() - 1);
        const auto k = static_cast<double>(texel);
        return k == last ? lastValue : firstValue + k * (lastValue - firstValue) / last;
    }
};

/// Power of two in 1/mm in units of which the largest extinction of a TF is about 2^15: fp16 then
/// keeps 11 bits of it and of what is up to eight decades fainter, whatever the unit of length.
double extinctionUnitPerMm(const TransferFunction& tf);

/// Spans the part of [dataMin, dataMax] in which the TF varies, one texel per integer value where
/// that fits `maxSize` and the data are integers (then every knot at an integer is exact), else
/// `maxSize` texels; two equal ones where the TF is constant over the data.
/// Values are rounded to fp16, as the texture holds them, so extinction is off by 2^-11 of itself
/// at most; where points span more than the eight decades that fp16 keeps so well, texels stay
/// float32 (`wide`). Visible texels are never zero. A texel is exactly zero in alpha where the TF
/// is, with one exception: of a peak between two texels, higher than both, the nearer texel takes
/// the whole, so that nothing visible is lost for being narrow. A step becomes a ramp from one
/// texel to the next; a gap narrower than a texel is filled. Tested by: transfer_table_test.cpp
TransferTable makeTable(const TransferFunction& tf, double dataMin, double dataMax,
                        bool integerData, CompositingSpace space, int maxSize = 4096);
/// The same in place of another table: nothing is allocated where that was made with this size.
void makeTable(const TransferFunction& tf, double dataMin, double dataMax, bool integerData,
               CompositingSpace space, int maxSize, TransferTable& table);

/// Turns colour and extinction into premultiplied colour and the opacity of a layer, whose depth is
/// `depthPerExtinction` times the texel's extinction. What is visible stays visible in fp16.
void bakeLength(std::vector<glm::vec4>& texels, double depthPerExtinction);

/// Linear texture lookup of the table, as the shader does it, in float64: colour, and extinction in
/// 1/mm.
glm::dvec4 lookUp(const TransferTable& table, double value);

} // namespace slabcast
