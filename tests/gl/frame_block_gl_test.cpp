#include "core/draw/frame_block.h"

#include <string>

#include "core/gl/program.h"
#include "core/plan/shader_resources.h"
#include "tests/support/gl_fixture.h"

namespace slabcast::test {

class FrameBlockTest : public GlTest {
protected:
    void SetUp() override {
        GlTest::SetUp();
        const auto load = [this](auto& function, const char* name) {
            function = reinterpret_cast<std::decay_t<decltype(function)>>(getProc()(name));
            ASSERT_NE(function, nullptr) << name;
        };
        load(indicesOf_, "glGetUniformIndices");
        load(propertyOf_, "glGetActiveUniformsiv");
    }

    GLint property(const gl::Program& program, GLuint index, GLenum what) const {
        GLint value = -1;
        propertyOf_(program.id(), 1, &index, what, &value);
        return value;
    }

    PFNGLGETUNIFORMINDICESPROC indicesOf_ = nullptr;
    PFNGLGETACTIVEUNIFORMSIVPROC propertyOf_ = nullptr;
};

/// A variant that reads as much of the block as one can; a block is laid out whole all the same.
constexpr ShaderVariant kReader{.skip = SkipForm::Octree, .shaded = true, .exactField = true};

TEST_F(FrameBlockTest, MembersLieWhereTheDriverReadsThem) {
    const Result<ShaderPair> text = shaderText(kReader);
    ASSERT_TRUE(text.has_value());
    const Result<gl::Program> program = gl::buildProgram("reader", text->vertex, text->fragment);
    ASSERT_TRUE(program.has_value()) << program.error().detail;
    const struct {
        const char* name;
        std::size_t offset;
        int number;
    } members[] = {
#define SLABCAST_MEMBER(type, name, number) {#name, offsetof(FrameBlock, name), number},
        SLABCAST_FRAME_FIELDS(SLABCAST_MEMBER)
#undef SLABCAST_MEMBER
    };
    for (const auto& member : members) {
        const std::string spelled = std::string(member.name) + (member.number > 1 ? "[0]" : "");
        const char* const asked = spelled.c_str();
        GLuint index = GL_INVALID_INDEX;
        indicesOf_(program->id(), 1, &asked, &index);
        ASSERT_NE(index, GL_INVALID_INDEX) << spelled;
        EXPECT_EQ(property(*program, index, GL_UNIFORM_OFFSET), GLint(member.offset)) << spelled;
        EXPECT_EQ(property(*program, index, GL_UNIFORM_SIZE), member.number) << spelled;
        if (member.number > 1) {
            EXPECT_EQ(property(*program, index, GL_UNIFORM_ARRAY_STRIDE), 16) << spelled;
        }
    }
    const GLuint block = gl::GetUniformBlockIndex(program->id(), "FrameBlock");
    ASSERT_NE(block, GL_INVALID_INDEX);
}

TEST_F(FrameBlockTest, AMemberElsewhereWouldBeNoticed) {
    const Result<ShaderPair> text = shaderText(kReader);
    ASSERT_TRUE(text.has_value());
    const auto withAnotherInFront = [](std::string stage) {
        const std::string list = "#define FRAME_FIELDS ";
        return stage.insert(stage.find(list) + list.size(), "vec4 another; ");
    };
    const Result<gl::Program> program = gl::buildProgram(
        "shifted", withAnotherInFront(text->vertex), withAnotherInFront(text->fragment));
    ASSERT_TRUE(program.has_value()) << program.error().detail;
    const char* const asked = "octreeLevels[0]";
    GLuint index = GL_INVALID_INDEX;
    indicesOf_(program->id(), 1, &asked, &index);
    EXPECT_EQ(property(*program, index, GL_UNIFORM_OFFSET),
              GLint(offsetof(FrameBlock, octreeLevels)) + 16);
}

} // namespace slabcast::test
