#include "core/frame/shader_variant.h"

#include <algorithm>

namespace slabcast {

const char* name(Classification classification) {
    return classification == Classification::Post ? "post" : "preclassified";
}

const char* name(SkipStructure skip) {
    return skip == SkipStructure::None ? "none" : "proximity";
}

int unrollLengthFor(int layersPerPlane) {
    const auto fit = std::find_if(kUnrollLengths.begin(), kUnrollLengths.end(),
                                  [=](int length) { return length >= layersPerPlane; });
    return fit == kUnrollLengths.end() ? 0 : *fit;
}

std::string name(const ShaderVariant& v) {
    std::string text = name(v.classification);
    text += v.skip == SkipStructure::None ? "" : std::string("+") + name(v.skip);
    text += v.shaded ? "+shaded" : "";
    text += v.exactField ? "+exact" : "";
    text += v.terminates ? "+terminate" : "";
    text += v.counts ? "+counts" : "";
    return text + (v.unroll == 0 ? "/loop" : "/unroll" + std::to_string(v.unroll));
}

std::vector<ShaderVariant> allVariants() {
    std::vector<int> lengths(kUnrollLengths.begin(), kUnrollLengths.end());
    lengths.push_back(0);
    std::vector<ShaderVariant> variants;
    for (const int length : lengths) {
        for (int bits = 0; bits < 64; ++bits) {
            const auto bit = [bits](int k) { return (bits >> k & 1) != 0; };
            const ShaderVariant v{.classification =
                                      bit(0) ? Classification::Pre : Classification::Post,
                                  .skip = bit(1) ? SkipStructure::Proximity : SkipStructure::None,
                                  .shaded = bit(2),
                                  .exactField = bit(3),
                                  .terminates = bit(4),
                                  .unroll = length,
                                  .counts = bit(5)};
            if (v.valid()) {
                variants.push_back(v);
            }
        }
    }
    return variants;
}

Result<ShaderPair> shaderText(const ShaderVariant& v) {
    SLABCAST_EXPECTS(v.valid(), v.unroll);
    const bool pre = v.classification == Classification::Pre;
    std::map<std::string, std::string> defines = {
        {"MAX_OUTLINES", std::to_string(kMaxOutlines)},
        {"COUNT_FILE", v.counts ? "count_work.glsl" : "count_none.glsl"},
        {"SKIP_FILE", v.skip == SkipStructure::None ? "skip_none.glsl" : "skip_proximity.glsl"},
        {"FIELD_FILE", v.exactField ? "field_exact.glsl" : "field_filtered.glsl"},
        {"SHADE_FILE", v.shaded ? "shade_phong.glsl" : "shade_none.glsl"},
        {"CLASSIFY_FILE", pre ? "classify_pre.glsl" : "classify_post.glsl"},
        {"TERMINATE_FILE", v.terminates ? "terminate_early.glsl" : "terminate_none.glsl"},
        {"MARCH_FILE", v.unroll == 0 ? "march_loop.glsl" : "march_unrolled.glsl"},
    };
    if (v.unroll > 0) {
        std::string layers;
        for (int k = 0; k < v.unroll; ++k) {
            layers += "X(" + std::to_string(k) + ") ";
        }
        defines["REPEAT_LAYERS(X)"] = layers;
    }
    Result<std::string> vertex = expandShader("plane.vert", defines);
    Result<std::string> fragment = expandShader("segment.frag", defines);
    if (!vertex || !fragment) {
        return tl::unexpected(vertex ? fragment.error() : vertex.error());
    }
    return ShaderPair{std::move(*vertex), std::move(*fragment)};
}

} // namespace slabcast
