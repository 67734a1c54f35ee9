#include <algorithm>
#include <cmath>

#include "core/gl/color_targets.h"
#include "core/gl/program.h"
#include "core/gl/state_guard.h"
#include "core/gl/texture_upload.h"
#include "core/scene/self_test_row.h"
#include "core/scene/texel_format.h"
#include "core/scene/volume_texture.h"

// The part of texel_format.h that reads a table through the device's filter.
namespace slabcast {

namespace {

constexpr int kTexels = 64;
constexpr int kSamples = 1024;
constexpr double kStepOfHalf = 0x1p-10; // relative: a device may take either neighbour

// The position comes back with the sample: the expectation is computed where the table was read.
constexpr const char* kSampleText = R"(#version 320 es
precision highp float;
precision highp sampler2D;
uniform sampler2D table;
out vec4 result;
void main() {
    float at = (gl_FragCoord.x - 0.5) / 1023.0;
    vec4 found = textureLod(table, vec2(at, 0.5), 0.0);
    result = vec4(found.r, found.a, at, 0.0);
}
)";

/// Zeros, lone peaks, a step, a ramp; the highest values follow zeros.
double texelAt(int texel) {
    if (texel < 16) {
        return texel == 8 ? 1.0 : 0.0;
    }
    if (texel < 32) {
        return texel % 5 == 0 ? 0.25 : 0.0;
    }
    return texel < 48 ? (texel < 40 ? 0.0 : 1.0) : (texel - 48) / 16.0;
}

FilterSample sampleOf(double at, double measured) {
    const double place = std::clamp(at * kTexels - 0.5, 0.0, kTexels - 1.0);
    const int texel = std::min(static_cast<int>(place), kTexels - 2);
    const double a = texelAt(texel);
    const double b = texelAt(texel + 1);
    return {a + (b - a) * (place - texel), measured, std::min(a, b), std::max(a, b), 1};
}

Result<std::vector<FilterSample>> drawSamples() {
    std::vector<glm::vec4> texels;
    for (int k = 0; k < kTexels; ++k) {
        texels.emplace_back(static_cast<float>(texelAt(k)));
    }
    const TableTexels table = filteredTableTexels(texels);
    const auto texture = upload2d("table test", table.layout, table.size, table.data);
    const auto program = gl::buildProgram("table filter test", kRowVertexText, kSampleText);
    gl::ColorTargets target;
    if (!texture || !program) {
        return tl::unexpected(texture ? program.error() : texture.error());
    }
    if (Result<void> made = target.resize(kSamples, 1, {GL_RGBA32F}); !made) {
        return tl::unexpected(made.error());
    }
    const gl::VertexArray vertices = gl::VertexArray::make("table test");
    gl::BindVertexArray(vertices.id());
    drawPlainly(kSamples);
    program->use();
    gl::ActiveTexture(GL_TEXTURE0); // where the sampler's default of 0 looks
    gl::BindSampler(0, 0);
    gl::BindTexture(GL_TEXTURE_2D, texture->id());
    gl::DrawArrays(GL_TRIANGLES, 0, 3);
    std::vector<FilterSample> samples;
    for (const glm::vec4& pixel : target.read()) {
        samples.push_back(sampleOf(pixel.z, pixel.x));
        samples.push_back(sampleOf(pixel.z, pixel.y));
    }
    return samples;
}

} // namespace

TableFilterTest judgeTableFilter(std::span<const FilterSample> samples) {
    TableFilterTest test{.usable = !samples.empty(), .reason = "nothing was sampled"};
    double worst = 0.0; // over what is allowed
    for (const FilterSample& one : samples) {
        const double off = std::abs(one.measured - one.expected);
        const double difference = one.high - one.low;
        if (one.high == 0.0 && one.measured != 0.0) {
            return {.reason = "what lies between two zeros is not zero"};
        }
        test.maxError = std::max(test.maxError, difference > 0.0 ? off / difference : 0.0);
        const double allowed = difference / 256.0 + one.high * kStepOfHalf;
        worst = std::max(worst, allowed > 0.0 ? off / allowed : 0.0);
    }
    test.usable &= worst <= 1.0;
    if (!samples.empty()) {
        test.reason = test.usable ? "zero between zeros, error within weights of eight bits"
                                  : "the filter is off by more than weights of eight bits are";
    }
    return test;
}

TableFilterTest selfTestTableFilter() {
    const gl::StateGuard guard;
    const Result<std::vector<FilterSample>> samples = drawSamples();
    return samples ? judgeTableFilter(*samples) : TableFilterTest{.reason = samples.error().detail};
}

} // namespace slabcast
