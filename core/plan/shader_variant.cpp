#include "core/plan/shader_variant.h"

#include <algorithm>

namespace slabcast {

namespace {

struct ClassificationInfo {
    Classification classification;
    const char* name;
    const char* shaderFile;
};

constexpr std::array<ClassificationInfo, 3> kClassifications = {{
    {Classification::Post, "post", "segment/classification/post.glsl"},
    {Classification::Pre, "preclassified", "segment/classification/preclassified.glsl"},
    {Classification::Preintegrated, "preintegrated", "segment/classification/preintegrated.glsl"},
}};

/// The files of one form of skipping; what a form does not include is null.
struct SkipFiles {
    const char* skip;
    const char* node;
};

constexpr std::array<SkipFiles, 6> kSkipFiles = {{
    {"segment/skip/none.glsl", nullptr},
    {"segment/skip/balls.glsl", nullptr},
    {"segment/skip/boxes.glsl", nullptr},
    {"segment/skip/octree.glsl", "segment/skip/node_bits.glsl"},
    {"segment/skip/octree.glsl", "segment/skip/node_wide.glsl"},
    {"segment/skip/octree.glsl", "segment/skip/node_range.glsl"},
}};

const ClassificationInfo& infoOf(Classification classification) {
    const auto index = static_cast<std::size_t>(classification);
    SLABCAST_EXPECTS(index < kClassifications.size(), index);
    return kClassifications[index];
}

const char* targetFileOf(const ShaderVariant& v) {
    constexpr const char* kFiles[2][2] = {
        {"segment/output/blended.glsl", "segment/output/fetched.glsl"},
        {"segment/output/counted.glsl", "segment/output/counted_behind.glsl"}};
    return kFiles[v.counts ? 1 : 0][v.fetchesTarget ? 1 : 0];
}

const char* terminateFileOf(const ShaderVariant& v) {
    return v.fetchesTarget ? "segment/termination/across.glsl"
           : v.terminates  ? "segment/termination/early.glsl"
                           : "segment/termination/none.glsl";
}

} // namespace

const char* name(Classification classification) {
    return infoOf(classification).name;
}

int unrollLengthFor(int layersPerPlane) {
    const auto fit = std::find_if(kUnrollLengths.begin(), kUnrollLengths.end(),
                                  [=](int length) { return length >= layersPerPlane; });
    return fit == kUnrollLengths.end() ? 0 : *fit;
}

std::string name(const ShaderVariant& v) {
    std::string text = name(v.classification);
    text += v.skip == SkipForm::None ? "" : std::string("+") + name(v.skip);
    text += v.shaded ? "+shaded" : "";
    text += v.exactField ? "+exact" : "";
    text += v.terminates ? "+terminate" : "";
    text += v.fetchesTarget ? "+fetch" : "";
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
            for (std::size_t bits = 0; bits < 32 * kSkipFiles.size(); ++bits) {
                const auto bit = [bits](int k) { return (bits >> k & 1) != 0; };
                ShaderVariant v{.classification = info.classification,
                                .skip = static_cast<SkipForm>(bits >> 5),
                                .shaded = bit(1),
                                .exactField = bit(2),
                                .terminates = bit(3),
                                .fetchesTarget = bit(0),
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
        {"COUNT_FILE", v.counts ? "segment/counting/work.glsl" : "segment/counting/none.glsl"},
        {"MEDIUM_FILE",
         v.halfGroups == 0 ? "segment/precision/exact.glsl" : "segment/precision/half.glsl"},
        {"HALF_GROUPS", std::to_string(v.halfGroups)},
        {"FIELD_FILE", v.exactField ? "segment/field/exact.glsl" : "segment/field/filtered.glsl"},
        {"SHADE_FILE", v.shaded ? "segment/shading/phong.glsl" : "segment/shading/none.glsl"},
        {"CLASSIFY_FILE", infoOf(v.classification).shaderFile},
        {"TARGET_FILE", targetFileOf(v)},
        {"TERMINATE_FILE", terminateFileOf(v)},
        {"MARCH_FILE", v.unroll == 0 ? "segment/form/loop.glsl" : "segment/form/unrolled.glsl"},
    };
    const SkipFiles& files = kSkipFiles[static_cast<std::size_t>(v.skip)];
    defines["SKIP_FILE"] = files.skip;
    if (files.node != nullptr) {
        defines["NODE_FILE"] = files.node;
    }
    if (v.unroll > 0) {
        std::string layers;
        for (int k = 0; k < v.unroll; ++k) {
            layers += "X(" + std::to_string(k) + ") ";
        }
        defines["REPEAT_LAYERS(X)"] = layers;
    }
    Result<std::string> vertex = expandShader("cover/plane.vert", defines);
    Result<std::string> fragment = expandShader("segment/segment.frag", defines);
    if (!vertex || !fragment) {
        return tl::unexpected(vertex ? fragment.error() : vertex.error());
    }
    return ShaderPair{std::move(*vertex), std::move(*fragment)};
}

} // namespace slabcast
