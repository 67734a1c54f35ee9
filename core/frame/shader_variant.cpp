#include "core/frame/shader_variant.h"

#include <algorithm>

namespace slabcast {

namespace {

struct ClassificationInfo {
    Classification classification;
    const char* name;
    const char* shaderFile;
};

constexpr std::array<ClassificationInfo, 3> kClassifications = {{
    {Classification::Post, "post", "classify_post.glsl"},
    {Classification::Pre, "preclassified", "classify_pre.glsl"},
    {Classification::Preintegrated, "preintegrated", "classify_preintegrated.glsl"},
}};

const ClassificationInfo& infoOf(Classification classification) {
    const auto index = static_cast<std::size_t>(classification);
    SLABCAST_EXPECTS(index < kClassifications.size(), index);
    return kClassifications[index];
}

} // namespace

const char* name(Classification classification) {
    return infoOf(classification).name;
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
    text += v.halfGroups != 0 ? "+half" + std::to_string(v.halfGroups) : "";
    return text + (v.unroll == 0 ? "/loop" : "/unroll" + std::to_string(v.unroll));
}

std::vector<ShaderVariant> allVariants() {
    std::vector<int> lengths(kUnrollLengths.begin(), kUnrollLengths.end());
    lengths.push_back(0);
    std::vector<ShaderVariant> variants;
    for (const int length : lengths) {
        for (const ClassificationInfo& info : kClassifications) {
            for (int bits = 0; bits < 32; ++bits) {
                const auto bit = [bits](int k) { return (bits >> k & 1) != 0; };
                ShaderVariant v{.classification = info.classification,
                                .skip = bit(0) ? SkipStructure::Proximity : SkipStructure::None,
                                .shaded = bit(1),
                                .exactField = bit(2),
                                .terminates = bit(3),
                                .unroll = length,
                                .counts = bit(4)};
                if (!v.valid()) {
                    continue;
                }
                variants.push_back(v);
                if (v.unroll == 0 && !v.counts) {
                    v.halfGroups = kHalfAll;
                    variants.push_back(v);
                }
            }
        }
    }
    return variants;
}

Result<ShaderPair> shaderText(const ShaderVariant& v) {
    SLABCAST_EXPECTS(v.valid(), v.unroll);
    std::map<std::string, std::string> defines = {
        {"MAX_OUTLINES", std::to_string(kMaxOutlines)},
        {"COUNT_FILE", v.counts ? "count_work.glsl" : "count_none.glsl"},
        {"MEDIUM_FILE", v.halfGroups == 0 ? "medium_exact.glsl" : "medium_half.glsl"},
        {"HALF_GROUPS", std::to_string(v.halfGroups)},
        {"SKIP_FILE", v.skip == SkipStructure::None ? "skip_none.glsl" : "skip_proximity.glsl"},
        {"FIELD_FILE", v.exactField ? "field_exact.glsl" : "field_filtered.glsl"},
        {"SHADE_FILE", v.shaded ? "shade_phong.glsl" : "shade_none.glsl"},
        {"CLASSIFY_FILE", infoOf(v.classification).shaderFile},
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
