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

/// The files of one form of skipping; what a form does not include is null.
struct SkipFiles {
    const char* skip;
    const char* node;
};

constexpr std::array<SkipFiles, 6> kSkipFiles = {{
    {"skip_none.glsl", nullptr},
    {"skip_proximity.glsl", nullptr},
    {"skip_boxes.glsl", nullptr},
    {"skip_octree.glsl", "node_bits.glsl"},
    {"skip_octree.glsl", "node_wide.glsl"},
    {"skip_octree.glsl", "node_range.glsl"},
}};

const ClassificationInfo& infoOf(Classification classification) {
    const auto index = static_cast<std::size_t>(classification);
    SLABCAST_EXPECTS(index < kClassifications.size(), index);
    return kClassifications[index];
}

const char* targetFileOf(const ShaderVariant& v) {
    constexpr const char* kFiles[2][2] = {{"target_blended.glsl", "target_fetched.glsl"},
                                          {"target_counted.glsl", "target_counted_behind.glsl"}};
    return kFiles[v.counts ? 1 : 0][v.fetchesTarget ? 1 : 0];
}

const char* terminateFileOf(const ShaderVariant& v) {
    return v.fetchesTarget ? "terminate_across.glsl"
           : v.terminates  ? "terminate_early.glsl"
                           : "terminate_none.glsl";
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
        {"COUNT_FILE", v.counts ? "count_work.glsl" : "count_none.glsl"},
        {"MEDIUM_FILE", v.halfGroups == 0 ? "medium_exact.glsl" : "medium_half.glsl"},
        {"HALF_GROUPS", std::to_string(v.halfGroups)},
        {"FIELD_FILE", v.exactField ? "field_exact.glsl" : "field_filtered.glsl"},
        {"SHADE_FILE", v.shaded ? "shade_phong.glsl" : "shade_none.glsl"},
        {"CLASSIFY_FILE", infoOf(v.classification).shaderFile},
        {"TARGET_FILE", targetFileOf(v)},
        {"TERMINATE_FILE", terminateFileOf(v)},
        {"MARCH_FILE", v.unroll == 0 ? "march_loop.glsl" : "march_unrolled.glsl"},
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
    Result<std::string> vertex = expandShader("plane.vert", defines);
    Result<std::string> fragment = expandShader("segment.frag", defines);
    if (!vertex || !fragment) {
        return tl::unexpected(vertex ? fragment.error() : vertex.error());
    }
    return ShaderPair{std::move(*vertex), std::move(*fragment)};
}

} // namespace slabcast
