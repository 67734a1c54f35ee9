#include "core/plan/shader_variant.h"

#include <algorithm>
#include <cctype>
#include <functional>
#include <map>
#include <regex>
#include <set>
#include <sstream>

#include <gtest/gtest.h>

#include "core/gl/shader_text.h"
#include "tests/support/variant_walk.h"

namespace slabcast {
namespace {

std::vector<std::string> linesOf(const std::string& text) {
    std::istringstream stream(text);
    std::vector<std::string> lines;
    for (std::string line; std::getline(stream, line);) {
        lines.push_back(line);
    }
    return lines;
}

std::string withoutComments(const std::string& text) {
    std::string code;
    for (const std::string& line : linesOf(text)) {
        code += line.substr(0, line.find("//")) + "\n";
    }
    return code;
}

std::size_t count(const std::string& text, const std::string& what) {
    std::size_t found = 0;
    for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) {
        ++found;
    }
    return found;
}

/// Every value of every axis with every other, valid or not.
std::vector<ShaderVariant> product() {
    std::vector<ShaderVariant> variants(1);
    for (const AxisInfo& axis : kAxes) {
        std::vector<ShaderVariant> next;
        for (const ShaderVariant& variant : variants) {
            for (std::size_t value = 0; value < axis.count; ++value) {
                axis.choose(next.emplace_back(variant), value);
            }
        }
        variants = std::move(next);
    }
    return variants;
}

TEST(ShaderVariant, ValidOnesAreAsManyAsTheRequirementsLeave) {
    // 11 forms (10 lengths and the loop), 6 of skipping, 3 of termination (none, within segments,
    // across planes), counting, two intervals, and jitter. Post is unlit, or lit by one of two
    // kinds of normals, and its field and table are exact, its table is, or neither; pre-integrated
    // has an exact field or not. Shells may have their lengths baked, but for pre-integrated
    // layers.
    const std::size_t alike = 11 * (6 * 3 * 2) * 2;
    const std::size_t named = alike * (3 * 3 * 2 + 1 * 2 + 2);
    const std::size_t valid = alike * 2 * (3 * 3 * 3 + 1 * 3 + 2 * 2);
    std::set<ShaderVariant> variants;
    std::set<std::string> names;
    for (const ShaderVariant& v : product()) {
        if (v.valid()) {
            variants.insert(v);
            names.insert(name(v));
        }
    }
    EXPECT_EQ(variants.size(), valid);
    EXPECT_EQ(names.size(), named); // lattice and jitter are stated beside the name
}

TEST(ShaderVariant, EveryAxisReadsBackWhatWasChosen) {
    for (const AxisInfo& axis : kAxes) {
        for (std::size_t value = 0; value < axis.count; ++value) {
            ShaderVariant v;
            axis.choose(v, value);
            EXPECT_EQ(axis.valueOf(v), value) << axis.name;
        }
        EXPECT_EQ(axis.valueOf(ShaderVariant{}), 0U) << axis.name; // the first is the default
    }
    for (std::size_t k = 0; k < kUnrollLengths.size(); ++k) {
        EXPECT_EQ(axes::kForm[k + 1].layersWrittenOut, kUnrollLengths[k]);
    }
    for (std::size_t k = 0; k < std::size(axes::kSkip); ++k) {
        const auto form = static_cast<SkipForm>(k);
        EXPECT_EQ(axes::kSkip[k].suffix,
                  form == SkipForm::None ? "" : std::string("+") + name(form));
    }
}

TEST(ShaderVariant, TheWalkHoldsWhatPlansReachAndEveryPairOfValues) {
    const std::vector<ShaderVariant>& walked = test::walkedVariants();
    std::set<test::AxisPair> pairs;
    for (const ShaderVariant& v : walked) {
        EXPECT_TRUE(v.valid()) << name(v);
        for (const test::AxisPair& pair : test::pairsOf(v)) {
            pairs.insert(pair);
        }
    }
    std::set<test::AxisPair> expected; // by the product, of which the walk knows nothing
    for (const ShaderVariant& v : product()) {
        if (v.valid()) {
            for (const test::AxisPair& pair : test::pairsOf(v)) {
                expected.insert(pair);
            }
        }
    }
    EXPECT_EQ(pairs, expected);
    const std::set<ShaderVariant> all(walked.begin(), walked.end());
    const std::set<ShaderVariant> reached = test::reachableVariants(1);
    EXPECT_TRUE(std::includes(all.begin(), all.end(), reached.begin(), reached.end()));
    RecordProperty("walked", static_cast<int>(walked.size()));
    RecordProperty("reached", static_cast<int>(reached.size()));
    RecordProperty("pairs", static_cast<int>(pairs.size()));
    EXPECT_LT(walked.size(), 2000U); // or walking takes longer than it says more
}

TEST(ShaderVariant, ValidityKnowsLengthsAndBakedTexels) {
    for (int unroll = -1; unroll <= 100; ++unroll) {
        const std::set<int> lengths = {0, 1, 2, 4, 8, 12, 16, 24, 32, 48, 64};
        EXPECT_EQ((ShaderVariant{.unroll = unroll}.valid()), lengths.count(unroll) == 1) << unroll;
    }
    EXPECT_FALSE((ShaderVariant{.classification = Classification::Pre, .shaded = true}.valid()));
    EXPECT_FALSE(
        (ShaderVariant{.classification = Classification::Pre, .exactField = true}.valid()));
    EXPECT_TRUE((ShaderVariant{.classification = Classification::Pre, .counts = true}.valid()));
    EXPECT_FALSE((ShaderVariant{.fetchesTarget = true}.valid()));
    constexpr auto kPreintegrated = Classification::Preintegrated;
    EXPECT_FALSE((ShaderVariant{.classification = kPreintegrated, .shaded = true}.valid()));
    EXPECT_TRUE((ShaderVariant{.classification = kPreintegrated, .exactField = true}.valid()));
}

TEST(ShaderVariant, NamesAreAsDocumented) {
    EXPECT_EQ(name(ShaderVariant{
                  .skip = SkipForm::Balls, .shaded = true, .terminates = true, .unroll = 16}),
              "post+balls+shaded+terminate/unroll16");
    EXPECT_EQ(name(ShaderVariant{.terminates = true, .fetchesTarget = true}),
              "post+terminate+fetch/loop");
    EXPECT_EQ(name(ShaderVariant{}), "post/loop");
}

TEST(ShaderVariant, TheShortestLengthThatHoldsASegment) {
    const std::pair<int, int> cases[] = {{1, 1},   {2, 2},   {3, 4},   {8, 8},   {9, 12},
                                         {13, 16}, {17, 24}, {25, 32}, {33, 48}, {49, 64},
                                         {64, 64}, {65, 0},  {444, 0}};
    for (const auto& [layers, length] : cases) {
        EXPECT_EQ(unrollLengthFor(layers), length) << layers;
    }
}

TEST(ShaderVariant, WhatIsOffIsAbsentFromTheText) {
    using V = ShaderVariant;
    const auto post = [](const V& v) { return v.classification == Classification::Post; };
    const auto never = [](const V&) { return false; };
    const struct {
        const char* token;
        std::function<bool(const V&)> present;
    } rules[] = {
        {"usampler3D skipTexels;", [](const V& v) { return v.skip != SkipForm::None; }},
        {"texelFetch(skipTexels", [](const V& v) { return v.skip != SkipForm::None; }},
        {"sampler2D transferTable;",
         [](const V& v) { return v.classification != Classification::Pre; }},
        {"texelFetch(transferTable",
         [=](const V& v) { return post(v) && v.table == TableRead::Exact; }},
        {"textureLod(transferTable",
         [](const V& v) {
             return v.classification == Classification::Preintegrated ||
                    v.table == TableRead::Filtered;
         }},
        {"segment.entry", [](const V& v) { return v.interval == Interval::Box; }},
        {"ray.layerLength * step0.w", [](const V& v) { return v.lengths == Lengths::PerRay; }},
        {"texelFetch(volumeTexels", [](const V& v) { return v.exactField; }},
        {"textureLod(volumeTexels", [](const V& v) { return !v.exactField; }},
        {"gradientRow[0].xyz",
         [](const V& v) { return v.shaded && v.normals == Normals::Computed; }},
        {"normalTexels", [](const V& v) { return v.normals == Normals::Baked; }},
        {"material.z * pow(", [](const V& v) { return v.shaded; }},
        {"pow(", [](const V& v) { return v.shaded; }},
        {"halved", never},
        {"missed.zw", [](const V& v) { return v.lattice == LatticeKind::Shells; }},
        {"jitterOf(", [](const V& v) { return v.jittered; }},
        {"viewport.w", [](const V& v) { return v.terminates; }},
        {"out highp vec4 colour;", [](const V& v) { return !v.counts; }},
        {"out highp vec4 work1;", [](const V& v) { return v.counts; }},
        {"inout highp vec4 colour;", [](const V& v) { return v.fetchesTarget && !v.counts; }},
        {"#extension", [](const V& v) { return v.fetchesTarget && !v.counts; }},
        {"sampler2D layerBefore;", [](const V& v) { return v.fetchesTarget && v.counts; }},
        {"opacityBefore()", [](const V& v) { return v.fetchesTarget; }},
        {"counted", [](const V& v) { return v.counts; }},
        {"discard", never},
        {"#include", never},
    };
    for (const V& v : test::walkedVariants()) {
        const std::string text = withoutComments(shaderText(v).value().fragment);
        for (const auto& rule : rules) {
            EXPECT_EQ(count(text, rule.token) > 0, rule.present(v))
                << name(v) << ": " << rule.token;
        }
        const std::size_t loops =
            count(text, "while (") + count(text, "for (") + count(text, "do {");
        EXPECT_EQ(loops > 0, v.unroll == 0) << name(v);
    }
}

/// Whether a word of its own stands there.
bool holdsWord(const std::string& text, const std::string& word) {
    const auto isWord = [](char c) {
        return std::isalnum(static_cast<unsigned char>(c)) || c == '_';
    };
    for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) {
        const std::size_t end = at + word.size();
        const bool begins = at == 0 || (!isWord(text[at - 1]) && text[at - 1] != '.');
        if (begins && (end == text.size() || !isWord(text[end]))) {
            return true;
        }
    }
    return false;
}

/// The fragment's text but for the frame block, and the macros that name members of it.
std::string withoutFrameBlock(std::string text) {
    const std::size_t at = text.find("layout(std140) uniform FrameBlock");
    const std::size_t end = text.find("#define octreeRise", at);
    EXPECT_NE(end, std::string::npos);
    text.erase(at, text.find('\n', end) - at);
    const std::size_t list = text.find("#define FRAME_FIELDS");
    return text.erase(list, text.find('\n', list) - list);
}

// The table says which resources a value takes: it must neither keep one back nor invent one.
TEST(ShaderVariant, TextsReadWhatTheTableSays) {
    std::set<std::string> fields;
    for (const AxisInfo& axis : kAxes) {
        for (std::size_t value = 0; value < axis.count; ++value) {
            fields.insert(axis.values[value].fields.begin(), axis.values[value].fields.end());
        }
    }
    EXPECT_GE(fields.size(), 14U);
    for (const ShaderVariant& v : test::walkedVariants()) {
        const std::string text = withoutFrameBlock(withoutComments(shaderText(v).value().fragment));
        std::set<std::string> taken;
        std::string extension;
        for (const AxisInfo& axis : kAxes) {
            const AxisValue& value = axis.values[axis.valueOf(v)];
            taken.insert(value.fields.begin(), value.fields.end());
            extension += value.extension != nullptr && !v.counts ? value.extension : "";
        }
        for (const std::string& field : fields) {
            EXPECT_EQ(holdsWord(text, field), taken.count(field) == 1) << name(v) << ": " << field;
        }
        const std::vector<std::string> samplers = samplersOf(v);
        for (const std::string sampler : kSamplerNames) {
            const bool listed =
                std::find(samplers.begin(), samplers.end(), sampler) != samplers.end();
            EXPECT_EQ(holdsWord(text, sampler), listed) << name(v) << ": " << sampler;
        }
        EXPECT_EQ(count(text, "#extension"), extension.empty() ? 0U : 1U) << name(v);
        EXPECT_NE(text.find(extension), std::string::npos) << name(v);
    }
}

TEST(ShaderVariant, OnlyMeasuringRoundsToHalfs) {
    for (const bool shaded : {false, true}) {
        const ShaderVariant v{.shaded = shaded};
        const std::string drawn = shaderText(v).value().fragment;
        const std::string rounded = shaderText(v, {.halfGroups = kHalfAll}).value().fragment;
        EXPECT_EQ(count(drawn, "HALF_GROUPS"), 0U);
        EXPECT_EQ(count(rounded, "#define HALF_GROUPS 31"), 1U);
        EXPECT_GT(count(rounded, "halved("), 0U);
    }
}

// What is mediump is what the half-precision study rounds: a mediump variable holds the rounded
// result of one of its groups, and nothing else is mediump.
TEST(ShaderVariant, WhatIsMediumpIsAGroupOfTheHalfPrecisionStudy) {
    const std::map<std::string, int> groups = {{"Opacity", kHalfOpacity},
                                               {"Sum", kHalfSum},
                                               {"Colour", kHalfColor},
                                               {"Light", kHalfLight},
                                               {"Extinction", kHalfExtinction}};
    const std::regex declaration(R"( *mediump (float|vec[234]) \w+ = in(\w+)\(.*)");
    int declared = 0;
    for (const ShaderVariant& v : test::walkedVariants()) {
        int found = 0;
        for (const std::string& line : linesOf(withoutComments(shaderText(v).value().fragment))) {
            EXPECT_EQ(line.find("lowp"), std::string::npos) << name(v) << ": " << line;
            if (line.find("mediump") != std::string::npos) {
                std::smatch parts;
                ASSERT_TRUE(std::regex_match(line, parts, declaration)) << name(v) << ": " << line;
                ASSERT_TRUE(groups.contains(parts[2])) << name(v) << ": " << line;
                EXPECT_EQ(count(line, "mediump"), 1U) << name(v) << ": " << line;
                declared |= groups.at(parts[2]);
                ++found;
            }
        }
        EXPECT_EQ(found > 0, v.shaded) << name(v);
    }
    EXPECT_EQ(declared, kHalfDeclared);
}

TEST(ShaderVariant, UnrolledTextsWriteOutTheirLengthOfLayers) {
    for (const int length : kUnrollLengths) {
        const std::string text = withoutComments(shaderText({.unroll = length}).value().fragment);
        const int group = groupOf({.unroll = length});
        EXPECT_EQ(length % group, 0);
        EXPECT_LE(group, kLoopGroup);
        EXPECT_EQ(group == 1, length == 1); // a group of one is a slice's only layer
        for (int layer = 0; layer < length; ++layer) {
            EXPECT_EQ(count(text, "X(" + std::to_string(layer) + ".0) "),
                      layer % group == 0 ? 1U : 0U);
            EXPECT_EQ(count(text, "X(" + std::to_string(layer) + ") "), layer < group ? 1U : 0U);
        }
    }
    EXPECT_EQ(groupOf({}), kLoopGroup);
    EXPECT_EQ(count(withoutComments(shaderText({}).value().fragment), "X(0.0)"), 0U);
}

/// Follows the #line directives: every line must be that of the file and number which the driver
/// will name.
void expectLinesOfTheirFiles(const std::string& text, const std::string& what) {
    std::vector<std::vector<std::string>> files;
    for (const auto& [file, content] : shaderTexts()) {
        files.push_back(linesOf(content));
    }
    const std::regex directive("#line (\\d+) (\\d+)");
    std::size_t file = files.size(); // none yet: the version and the defines
    std::size_t line = 0;
    std::size_t checked = 0;
    for (const std::string& shown : linesOf(text)) {
        std::smatch match;
        if (std::regex_match(shown, match, directive)) {
            line = std::stoul(match[1]);
            file = std::stoul(match[2]);
            ASSERT_LT(file, files.size()) << what;
        } else if (file < files.size()) {
            ASSERT_LE(line, files[file].size()) << what;
            EXPECT_EQ(shown, files[file][line - 1]) << what;
            ++line;
            ++checked;
        }
    }
    EXPECT_GT(checked, 10U) << what;
}

TEST(ShaderText, MessagesNameTheFileAndLineOfTheSource) {
    for (const ShaderVariant& v : test::walkedVariants()) {
        if (v.unroll == 0 || v.unroll == 4) {
            const ShaderPair pair = shaderText(v).value();
            expectLinesOfTheirFiles(pair.vertex, name(v));
            expectLinesOfTheirFiles(pair.fragment, name(v));
        }
    }
}

TEST(ShaderText, StartsWithItsVersionThenItsDefines) {
    const std::string text =
        expandShader("pass/fullscreen.vert", {{"SIZE", "3"}, {"SOME_FILE", "segment/ray.glsl"}})
            .value();
    EXPECT_EQ(text.rfind("#version 320 es\n#define SIZE 3\n#line 1 ", 0), 0U);
    EXPECT_EQ(text.find("SOME_FILE"), std::string::npos); // a choice of file is no GLSL
}

TEST(ShaderText, IncludesAFileOnce) {
    const std::string text = shaderText({.shaded = true}).value().fragment;
    EXPECT_EQ(count(text, "uniform FrameBlock"), 1U);
    EXPECT_EQ(count(text, "uniform sampler3D volumeTexels"), 1U);
    EXPECT_EQ(count(text, "void main()"), 1U);
}

TEST(ShaderText, AFileThatIsNotThereIsAnErrorThatNamesIt) {
    const Result<std::string> file = expandShader("absent.frag", {});
    ASSERT_FALSE(file);
    EXPECT_EQ(file.error().code, ErrorCode::ShaderCompile);
    EXPECT_NE(file.error().detail.find("absent.frag"), std::string::npos);
    // Through an include whose define is missing, and through one that names nothing.
    for (const std::map<std::string, std::string>& defines :
         {std::map<std::string, std::string>{}, {{"OUTPUT_FILE", "absent.glsl"}}}) {
        const Result<std::string> inner = expandShader("segment/segment.frag", defines);
        ASSERT_FALSE(inner);
        EXPECT_EQ(inner.error().code, ErrorCode::ShaderCompile);
        EXPECT_NE(inner.error().detail.find(defines.empty() ? "OUTPUT_FILE" : "absent.glsl"),
                  std::string::npos);
    }
}

} // namespace
} // namespace slabcast
