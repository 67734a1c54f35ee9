#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <mutex>
#include <sstream>

#include <gtest/gtest.h>

#include "core/base/parallel.h"
#include "core/frame/shader_variant.h"

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

/// The reference compiler's complaints about two stages, compiled and linked; empty where it has
/// none.
std::string complaints(const Folder& folder, const std::string& stem, const ShaderPair& pair) {
    const std::string vertex = folder.file(stem + ".vert");
    const std::string fragment = folder.file(stem + ".frag");
    const std::string log = folder.file(stem + ".log");
    std::ofstream(vertex) << pair.vertex;
    std::ofstream(fragment) << pair.fragment;
    return runs("glslangValidator -l '" + vertex + "' '" + fragment + "' > '" + log + "' 2>&1")
               ? ""
               : textOf(log) + "(failed)";
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

TEST_F(ShaderValidator, TakesEveryValidVariant) {
    const std::vector<ShaderVariant> variants = allVariants();
    ASSERT_FALSE(variants.empty());
    std::mutex oneAtATime;
    // Nearly all of a run is the tool's own start, so runs side by side are what keeps this short.
    parallelFor(
        static_cast<std::int64_t>(variants.size()), 1, [&](std::int64_t begin, std::int64_t) {
            const ShaderVariant& variant = variants[static_cast<std::size_t>(begin)];
            const Result<ShaderPair> pair = shaderText(variant);
            const std::string found =
                pair ? complaints(folder_, std::to_string(begin), *pair) : pair.error().detail;
            const std::lock_guard lock(oneAtATime);
            EXPECT_EQ(found, "") << name(variant);
        });
}

TEST_F(ShaderValidator, TakesTheCompositor) {
    const Result<std::string> vertex = expandShader("fullscreen.vert", {});
    const Result<std::string> fragment = expandShader("composite.frag", {});
    ASSERT_TRUE(vertex && fragment);
    EXPECT_EQ(complaints(folder_, "composite", {*vertex, *fragment}), "");
}

TEST_F(ShaderValidator, NoticesWhatDoesNotCompileOrLink) {
    const ShaderPair good = shaderText({.unroll = 8}).value();
    const ShaderPair bad[] = {
        withReplacement(good, &ShaderPair::fragment, "float sampleField(", "float renamedField("),
        withReplacement(good, &ShaderPair::vertex, "flat out int plane", "flat out float plane"),
    };
    EXPECT_EQ(complaints(folder_, "good", good), "");
    for (const ShaderPair& pair : bad) {
        EXPECT_NE(complaints(folder_, "bad", pair), "");
    }
}

} // namespace
} // namespace slabcast
