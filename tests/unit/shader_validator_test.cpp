#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <mutex>
#include <sstream>

#include <gtest/gtest.h>

#include "core/base/parallel.h"
#include "core/gl/shader_text.h"
#include "core/plan/shader_variant.h"
#include "core/skip/gpu/gpu_passes.h"
#include "tests/support/variant_walk.h"

namespace slabcast {
namespace {

namespace fs = std::filesystem;

/// A folder of its own, gone with the test.
class Folder {
public:
    Folder() {
        std::string pattern = (fs::temp_directory_path() / "slabcast-shaders-XXXXXX").string();
        path_ = mkdtemp(pattern.data());
    }
    ~Folder() { fs::remove_all(path_); }
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;

    std::string file(const std::string& name) const { return (path_ / name).string(); }

private:
    fs::path path_;
};

bool runs(const std::string& command) {
    return std::system(command.c_str()) == 0;
}

std::string textOf(const std::string& file) {
    std::ostringstream text;
    text << std::ifstream(file).rdbuf();
    return text.str();
}

/// The reference compiler's complaints about texts by file name; empty where it has none.
std::string complaints(const Folder& folder, const std::string& stem, const std::string& option,
                       const std::map<std::string, std::string>& texts) {
    const std::string log = folder.file(stem + ".log");
    std::string command = "glslangValidator " + option;
    for (const auto& [name, text] : texts) {
        const std::string file = folder.file(name);
        std::ofstream(file) << text;
        command += " '" + file + "'";
    }
    return runs(command + " > '" + log + "' 2>&1") ? "" : textOf(log) + "(failed)";
}

/// The reference compiler knows no framebuffer fetch: an output that is read stands for one.
std::string withoutFetch(std::string text) {
    const std::pair<std::string, std::string> replacements[] = {
        {"#extension GL_EXT_shader_framebuffer_fetch : require", ""},
        {" inout highp ", " out highp "}};
    for (const auto& [what, by] : replacements) {
        if (const std::size_t at = text.find(what); at != std::string::npos) {
            text.replace(at, what.size(), by);
        }
    }
    return text;
}

/// The same about two stages, compiled and linked.
std::string complaints(const Folder& folder, const std::string& stem, const ShaderPair& pair) {
    return complaints(
        folder, stem, "-l",
        {{stem + ".vert", pair.vertex}, {stem + ".frag", withoutFetch(pair.fragment)}});
}

ShaderPair withReplacement(ShaderPair pair, std::string ShaderPair::*stage, const std::string& what,
                           const std::string& by) {
    const std::size_t at = (pair.*stage).find(what);
    EXPECT_NE(at, std::string::npos) << what;
    (pair.*stage).replace(at, what.size(), by);
    return pair;
}

class ShaderValidator : public testing::Test {
protected:
    void SetUp() override {
        ASSERT_TRUE(runs("glslangValidator --version > /dev/null 2>&1"))
            << "glslangValidator does not run: install glslang-tools";
    }
    Folder folder_;
};

/// Nearly all of a run is the tool's own start: it is given many texts at once.
TEST_F(ShaderValidator, TakesWhatPlansReachAndEveryPairOfAxisValues) {
    const std::vector<ShaderVariant>& variants = test::walkedVariants();
    ASSERT_FALSE(variants.empty());
    std::mutex oneAtATime;
    parallelFor(static_cast<std::int64_t>(variants.size()), 100,
                [&](std::int64_t begin, std::int64_t end) {
                    std::map<std::string, std::string> texts;
                    for (std::int64_t i = begin; i < end; ++i) {
                        const auto& variant = variants[static_cast<std::size_t>(i)];
                        const Result<ShaderPair> pair = shaderText(variant);
                        texts[std::to_string(i) + ".frag"] =
                            pair ? withoutFetch(pair->fragment) : pair.error().detail;
                    }
                    const std::string found =
                        complaints(folder_, "from" + std::to_string(begin), "", texts);
                    const std::lock_guard lock(oneAtATime);
                    // Names of files with complaints are the variants' numbers.
                    EXPECT_EQ(found.find("ERROR"), std::string::npos)
                        << found << name(variants[static_cast<std::size_t>(begin)]) << " and on";
                    EXPECT_EQ(found.find("(failed)"), std::string::npos) << found;
                });
}

/// Those that only measuring takes: post-classification and pre-classification, lit or not.
TEST_F(ShaderValidator, TakesWhatMeasuringRounds) {
    std::map<std::string, std::string> texts;
    for (const ShaderVariant& v : test::walkedVariants()) {
        if (v.unroll == 0 && !v.counts && v.skip == SkipForm::None) {
            texts["half" + std::to_string(texts.size()) + ".frag"] =
                withoutFetch(shaderText(v, {.halfGroups = kHalfAll}).value().fragment);
        }
    }
    ASSERT_GE(texts.size(), 10U);
    EXPECT_EQ(complaints(folder_, "half", "", texts).find("ERROR"), std::string::npos);
}

/// What the stages hand each other depends on none of the rest.
TEST_F(ShaderValidator, LinksEveryWayOfSkippingAndWriting) {
    for (std::size_t skip = 0; skip < std::size(axes::kSkip); ++skip) {
        for (const bool fetches : {false, true}) {
            for (const bool counts : {false, true}) {
                const ShaderVariant v{.skip = static_cast<SkipForm>(skip),
                                      .terminates = true,
                                      .fetchesTarget = fetches,
                                      .unroll = 1,
                                      .counts = counts};
                EXPECT_EQ(complaints(folder_, "linked", shaderText(v).value()), "") << name(v);
            }
        }
    }
}

TEST_F(ShaderValidator, TakesThePassesOverALayer) {
    const Result<std::string> vertex = expandShader("pass/fullscreen.vert", {});
    for (const char* file : {"pass/composite.frag", "pass/mark.frag"}) {
        const Result<std::string> fragment = expandShader(file, {});
        ASSERT_TRUE(vertex && fragment) << file;
        EXPECT_EQ(complaints(folder_, "pass", {*vertex, *fragment}), "") << file;
    }
}

/// Programs of one stage: nothing to link, and one run takes them all.
TEST_F(ShaderValidator, TakesEveryPassOfTheBuilders) {
    std::map<std::string, std::string> texts;
    for (const BuildPass& pass : allBuildPasses()) {
        const Result<std::string> text = passText(pass);
        ASSERT_TRUE(text.has_value()) << text.error().detail;
        texts["pass" + std::to_string(texts.size()) + ".comp"] = *text;
    }
    ASSERT_FALSE(texts.empty());
    EXPECT_EQ(complaints(folder_, "passes", "", texts), "");
    texts["pass0.comp"] += "uint undeclared() { return neverMade; }\n";
    EXPECT_NE(complaints(folder_, "passes", "", texts), "");
}

TEST_F(ShaderValidator, NoticesWhatDoesNotCompileOrLink) {
    const ShaderPair good = shaderText({.unroll = 8}).value();
    const ShaderPair bad[] = {
        withReplacement(good, &ShaderPair::fragment, "float sampleField(", "float renamedField("),
        withReplacement(good, &ShaderPair::vertex, "flat out float planeFront",
                        "flat out int planeFront"),
    };
    EXPECT_EQ(complaints(folder_, "good", good), "");
    for (const ShaderPair& pair : bad) {
        EXPECT_NE(complaints(folder_, "bad", pair), "");
    }
}

} // namespace
} // namespace slabcast
