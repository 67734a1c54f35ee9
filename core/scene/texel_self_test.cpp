#include <array>
#include <cmath>
#include <cstring>

#include <glm/gtc/packing.hpp>

#include "core/gl/color_targets.h"
#include "core/gl/program.h"
#include "core/gl/state_guard.h"
#include "core/scene/self_test_row.h"
#include "core/scene/texel_format.h"
#include "core/scene/volume_texture.h"

// The part of texel_format.h that draws: textures of known texels, read back through a float
// target.
namespace slabcast {

namespace {

constexpr int kSamples = 1024;

// The position comes back with the sample: the expectation is computed where the texture was read.
constexpr const char* kSampleText = R"(#version 320 es
precision highp float;
precision highp sampler3D;
uniform sampler3D texels;
uniform vec3 start;
uniform vec3 stop;
out vec4 result;
void main() {
    vec3 uvw = mix(start, stop, (gl_FragCoord.x - 0.5) / 1023.0);
    result = vec4(texture(texels, uvw).r, uvw);
}
)";

constexpr const char* kFetchText = R"(#version 320 es
precision highp float;
precision highp sampler3D;
uniform sampler3D texels;
out vec4 result;
void main() {
    int i = int(gl_FragCoord.x);
    result = texelFetch(texels, ivec3(i % 16, (i / 16) % 8, i / 128), 0);
}
)";
constexpr glm::ivec3 kFetchDims{16, 8, 8};

/// A way through 2x2x2 texels; bit i + 2j + 4k of `high` says which of them hold the higher value.
struct Sweep {
    unsigned high;
    glm::vec3 start;
    glm::vec3 stop;
    int axes;
};

// Along each axis from the clamped border across both texels; and across all eight, alternating.
constexpr Sweep kSweeps[] = {
    {0b10101010, {0.125F, 0.25F, 0.25F}, {0.875F, 0.25F, 0.25F}, 1},
    {0b11001100, {0.25F, 0.125F, 0.25F}, {0.25F, 0.875F, 0.25F}, 1},
    {0b11110000, {0.25F, 0.25F, 0.125F}, {0.25F, 0.25F, 0.875F}, 1},
    {0b10010110, {0.25F, 0.25F, 0.25F}, {0.75F, 0.75F, 0.75F}, 3},
};

using CodePair = std::array<double, 2>;

/// How a format's texels are written and read here. Codes are integers, or the float itself.
struct FormatProbe {
    TexelFormat format;
    std::array<CodePair, 2> pairs; // far apart: the weights; close: the precision of the result
    double perCode;                // sampled value of one code
    void (*append)(std::vector<std::byte>& data, double code);
    double (*ladder)(int i);              // codes for the fetch test, spread over the range
    double (*sampled)(glm::vec4 fetched); // as the shader's field function decodes it
};

template <class T>
void appendBytes(std::vector<std::byte>& data, T value) {
    const std::size_t at = data.size();
    data.resize(at + sizeof value);
    std::memcpy(data.data() + at, &value, sizeof value);
}

void appendHighLow(std::vector<std::byte>& data, double code) {
    const auto value = static_cast<unsigned>(code);
    data.push_back(static_cast<std::byte>(value >> 8));
    data.push_back(static_cast<std::byte>(value & 255U));
}

double wideLadder(int i) {
    return i * 64 + i % 64;
}

double red(glm::vec4 fetched) {
    return fetched.r;
}

const FormatProbe kProbes[] = {
    {TexelFormat::R8,
     {{{0, 255}, {127, 128}}},
     1.0 / 255.0,
     [](std::vector<std::byte>& data, double code) {
         data.push_back(std::byte(static_cast<int>(code)));
     },
     [](int i) { return static_cast<double>(i % 256); },
     red},
    {TexelFormat::R16,
     {{{0, 65535}, {32704, 32768}}},
     1.0 / 65535.0,
     [](std::vector<std::byte>& data, double code) {
         appendBytes(data, static_cast<std::uint16_t>(code));
     },
     wideLadder,
     red},
    {TexelFormat::R16F,
     {{{-2048, 2048}, {1024, 1032}}},
     1.0,
     [](std::vector<std::byte>& data, double code) {
         appendBytes(data, glm::packHalf1x16(static_cast<float>(code)));
     },
     [](int i) { return i * 4.0 + i % 4 - 2048.0; },
     red},
    {TexelFormat::Rg8Exact,
     {},
     1.0,
     appendHighLow,
     wideLadder,
     [](glm::vec4 fetched) {
         return static_cast<double>(fetched.r * 65280.0F + fetched.g * 255.0F);
     }},
    {TexelFormat::R32fExact,
     {},
     1.0,
     [](std::vector<std::byte>& data, double code) { appendBytes(data, static_cast<float>(code)); },
     [](int i) { return static_cast<double>(std::sin(static_cast<float>(i))); },
     red},
};

Texels emptyTexels(TexelFormat format, glm::ivec3 dims) {
    Texels texels;
    texels.format = format;
    texels.dims = dims;
    return texels;
}

/// Exact trilinear interpolation of 2x2x2 texels that are 0 or 1, clamped to the edge.
double weightOfHigh(unsigned high, glm::vec3 uvw) {
    const glm::dvec3 t = glm::clamp(glm::dvec3(uvw) * 2.0 - 0.5, 0.0, 1.0);
    double sum = 0.0;
    for (unsigned corner = 0; corner < 8; ++corner) {
        const glm::bvec3 upper(corner & 1U, corner & 2U, corner & 4U);
        const glm::dvec3 w = glm::mix(1.0 - t, t, upper);
        sum += (high >> corner & 1U) != 0 ? w.x * w.y * w.z : 0.0;
    }
    return sum;
}

/// Programs and a target of one row; draws one triangle over it and reads the row.
class Bench {
public:
    static Result<Bench> make() {
        Bench bench;
        auto sample = gl::buildProgram("texel sampling test", kRowVertexText, kSampleText);
        auto fetch = gl::buildProgram("texel fetch test", kRowVertexText, kFetchText);
        if (!sample || !fetch) {
            return tl::unexpected(sample ? fetch.error() : sample.error());
        }
        bench.sample_ = std::move(*sample);
        bench.fetch_ = std::move(*fetch);
        if (!bench.target_.resize(kSamples, 1, {GL_RGBA32F})) {
            return fail(ErrorCode::DeviceUnsupported,
                        "RGBA32F cannot be drawn to, though GLES 3.2 asks for it");
        }
        gl::BindVertexArray(bench.vertexArray_.id());
        drawPlainly(kSamples);
        return bench;
    }

    Result<std::vector<FilterSample>> filtered(const FormatProbe& probe, const gl::Caps& caps) {
        std::vector<FilterSample> samples;
        for (const CodePair& pair : probe.pairs) {
            for (const Sweep& sweep : kSweeps) {
                const auto read = drawSweep(probe, pair, sweep, caps);
                if (!read) {
                    return tl::unexpected(read.error());
                }
                const double low = pair[0] * probe.perCode;
                const double high = pair[1] * probe.perCode;
                for (const glm::vec4& pixel : *read) {
                    const double weight = weightOfHigh(sweep.high, {pixel.y, pixel.z, pixel.w});
                    samples.push_back(
                        {low + weight * (high - low), pixel.x, low, high, sweep.axes});
                }
            }
        }
        return samples;
    }

    Result<std::vector<FetchSample>> fetched(const FormatProbe& probe, const gl::Caps& caps) {
        Texels texels = emptyTexels(probe.format, kFetchDims);
        std::vector<std::byte> data;
        for (int i = 0; i < kSamples; ++i) {
            probe.append(data, probe.ladder(i));
        }
        texels.data = data;
        fetch_.use();
        const auto read = draw(texels, caps);
        if (!read) {
            return tl::unexpected(read.error());
        }
        std::vector<FetchSample> samples;
        for (int i = 0; i < kSamples; ++i) {
            samples.push_back({probe.ladder(i) * probe.perCode,
                               probe.sampled((*read)[static_cast<std::size_t>(i)])});
        }
        return samples;
    }

private:
    using Row = std::vector<glm::vec4>;

    Result<Row> drawSweep(const FormatProbe& probe, const CodePair& pair, const Sweep& sweep,
                          const gl::Caps& caps) {
        Texels texels = emptyTexels(probe.format, glm::ivec3(2));
        std::vector<std::byte> data;
        for (unsigned corner = 0; corner < 8; ++corner) {
            probe.append(data, pair[sweep.high >> corner & 1U]);
        }
        texels.data = data;
        sample_.use();
        gl::Uniform3fv(sample_.uniform("start"), 1, &sweep.start.x);
        gl::Uniform3fv(sample_.uniform("stop"), 1, &sweep.stop.x);
        return draw(texels, caps);
    }

    Result<Row> draw(const Texels& texels, const gl::Caps& caps) {
        const auto texture = uploadTexels(texels, caps);
        if (!texture) {
            return tl::unexpected(texture.error());
        }
        gl::ActiveTexture(GL_TEXTURE0); // where the samplers' default of 0 looks
        gl::BindSampler(0, 0);
        gl::BindTexture(GL_TEXTURE_3D, texture->id());
        gl::DrawArrays(GL_TRIANGLES, 0, 3);
        return target_.read();
    }

    gl::Program sample_;
    gl::Program fetch_;
    gl::ColorTargets target_;
    gl::VertexArray vertexArray_ = gl::VertexArray::make("texel test");
};

TexelFormatTest testFormat(Result<Bench>& bench, const FormatProbe& probe, const gl::Caps& caps) {
    TexelFormatTest failed{.format = probe.format};
    if (!bench) {
        failed.reason = bench.error().detail;
        return failed;
    }
    if (probe.format == TexelFormat::R16 && !caps.norm16) {
        failed.reason = "the device lacks EXT_texture_norm16";
        return failed;
    }
    const auto fetched = bench->fetched(probe, caps);
    const auto filtered =
        isExact(probe.format) ? Result<std::vector<FilterSample>>{} : bench->filtered(probe, caps);
    if (!fetched || !filtered) {
        failed.reason = fetched ? filtered.error().detail : fetched.error().detail;
        return failed;
    }
    return judgeTexelFormat(probe.format, *filtered, *fetched);
}

} // namespace

std::vector<TexelFormatTest> selfTestTexelFormats(const gl::Caps& caps) {
    const gl::StateGuard guard;
    Result<Bench> bench = Bench::make();
    std::vector<TexelFormatTest> tests;
    for (const FormatProbe& probe : kProbes) {
        tests.push_back(testFormat(bench, probe, caps));
    }
    return tests;
}

} // namespace slabcast
