#include <algorithm>

#include "perf/mobile/compile_variants.h"
#include "tests/support/gl_fixture.h"

namespace slabcast {
namespace {

struct Heard {
    std::string label;
    std::string failure;
};

class CompileVariantsTest : public GlTest {
protected:
    std::vector<Heard> compile(const std::vector<ShaderVariant>& variants,
                               const CompileOptions& options = {}) {
        std::vector<Heard> heard;
        const Result<void> done = compileVariants(
            variants, options, [&](const ShaderVariant& variant, const Error* failure) {
                heard.push_back({labelOf(variant), failure == nullptr ? "" : failure->detail});
            });
        EXPECT_TRUE(done.has_value()) << done.error().detail;
        GLint current = -1;
        gl::GetIntegerv(GL_CURRENT_PROGRAM, &current);
        EXPECT_EQ(current, 0); // all of them are deleted
        return heard;
    }
};

TEST_F(CompileVariantsTest, EachIsAnnouncedAndDrawn) {
    const std::vector<ShaderVariant> variants = {
        {.unroll = 2},
        {.classification = Classification::Pre, .unroll = 1, .lattice = LatticeKind::Shells},
        {.skip = SkipForm::Balls, .terminates = true, .unroll = 4}};
    const std::vector<Heard> heard = compile(variants);
    ASSERT_EQ(heard.size(), variants.size());
    for (std::size_t k = 0; k < variants.size(); ++k) {
        EXPECT_EQ(heard[k].label, labelOf(variants[k]));
        EXPECT_EQ(heard[k].failure, "");
    }
}

// What a compiler refuses is said, and the next one follows.
TEST_F(CompileVariantsTest, AFailureIsHeardAndPassedOver) {
    const ShaderVariant unrolled{.unroll = 1};
    const std::vector<Heard> heard =
        compile({unrolled, ShaderVariant{.unroll = 2}}, {.loopBodies = false});
    ASSERT_EQ(heard.size(), 4U); // neither has a loop whose body could be left out
    EXPECT_EQ(heard[1].label, heard[0].label);
    EXPECT_NE(heard[1].failure.find("addGroup("), std::string::npos);
    EXPECT_EQ(heard[2].label, "post/unroll2");
}

} // namespace
} // namespace slabcast
