#include "core/gl/objects.h"

#include <array>
#include <cstring>
#include <set>
#include <vector>

#include "core/gl/caps.h"
#include "core/gl/debug.h"
#include "core/gl/program.h"
#include "core/gl/state_guard.h"
#include "platform/egl/egl_context.h"
#include "tests/support/gl_fixture.h"

namespace slabcast {

namespace {

gl::DeviceStrings deviceStrings(std::string version) {
    return {"Vendor", "Renderer", std::move(version), {}};
}

} // namespace

TEST(Caps, ReadsTheVersionOrRefuses) {
    const auto mesa = gl::capsFrom(deviceStrings("OpenGL ES 3.2 Mesa 22.3.6"), {});
    ASSERT_TRUE(mesa.has_value());
    EXPECT_EQ(mesa->major, 3);
    EXPECT_EQ(mesa->minor, 2);
    EXPECT_EQ(mesa->driver, "OpenGL ES 3.2 Mesa 22.3.6");
    EXPECT_TRUE(gl::capsFrom(deviceStrings("OpenGL ES 4.0"), {}).has_value());
    for (const char* low : {"OpenGL ES 3.1 v1.r32", "OpenGL ES 2.0", "4.6.0 NVIDIA 535", ""}) {
        const auto refused = gl::capsFrom(deviceStrings(low), {});
        ASSERT_FALSE(refused.has_value()) << low;
        EXPECT_EQ(refused.error().code, ErrorCode::DeviceUnsupported);
        EXPECT_NE(refused.error().detail.find(std::string("\"") + low + "\""), std::string::npos)
            << refused.error().detail;
        EXPECT_EQ(refused.error().detail.find('\n'), std::string::npos);
    }
}

TEST(Caps, FlagsFollowExtensionsAndTheMask) {
    gl::DeviceStrings strings = deviceStrings("OpenGL ES 3.2");
    const gl::Caps bare = *gl::capsFrom(strings, {});
    EXPECT_FALSE(bare.norm16 || bare.floatLinear || bare.floatBlend || bare.timerQuery ||
                 bare.framebufferFetch || bare.multiview || bare.imageFormats);
    strings.extensions = {"GL_OVR_multiview2",
                          "GL_EXT_texture_norm16",
                          "GL_OES_texture_float_linear",
                          "GL_EXT_float_blend",
                          "GL_NV_image_formats",
                          "GL_EXT_disjoint_timer_query",
                          "GL_EXT_shader_framebuffer_fetch_non_coherent"};
    EXPECT_FALSE(gl::capsFrom(strings, {})->framebufferFetch); // would need a barrier per plane
    strings.extensions.back() = "GL_EXT_shader_framebuffer_fetch";
    const gl::Caps rich = *gl::capsFrom(strings, {});
    EXPECT_TRUE(rich.norm16 && rich.floatLinear && rich.floatBlend && rich.timerQuery &&
                rich.framebufferFetch && rich.multiview && rich.imageFormats);
    EXPECT_EQ(rich.extensions.size(), 7U);
    const gl::Caps strict = *gl::capsFrom(strings, gl::mobileStrictMask());
    EXPECT_FALSE(strict.norm16 || strict.floatLinear || strict.floatBlend || strict.timerQuery ||
                 strict.framebufferFetch || strict.imageFormats);
    EXPECT_EQ(strict.extensions, std::vector<std::string>{"GL_OVR_multiview2"});
    EXPECT_TRUE(strict.multiview); // headsets have it
}

TEST(Caps, KnowsSoftwareRenderers) {
    gl::DeviceStrings strings = deviceStrings("OpenGL ES 3.2");
    EXPECT_FALSE(gl::capsFrom(strings, {})->isSoftware);
    for (const char* name : {"llvmpipe (LLVM 15.0.6, 256 bits)", "softpipe",
                             "ANGLE (Google, Vulkan 1.3 (SwiftShader Device))"}) {
        strings.renderer = name;
        EXPECT_TRUE(gl::capsFrom(strings, {})->isSoftware) << name;
    }
}

TEST(Caps, ParsesMasks) {
    EXPECT_TRUE(gl::parseExtensionMask("").empty());
    EXPECT_EQ(gl::parseExtensionMask("GL_A,,GL_B"), (std::vector<std::string>{"GL_A", "GL_B"}));
    EXPECT_EQ(gl::parseExtensionMask("mobile-strict"), gl::mobileStrictMask());
}

class GlObjects : public GlTest {};

TEST_F(GlObjects, MissingFunctionIsNamed) {
    const auto lacking = gl::loadApi([](const char* name) -> void* {
        static int anything = 0;
        return std::strcmp(name, "glTexStorage3D") == 0 ? nullptr : &anything;
    });
    ASSERT_TRUE(gl::loadApi(getProc()).has_value()); // the pointers are the process's
    ASSERT_FALSE(lacking.has_value());
    EXPECT_EQ(lacking.error().code, ErrorCode::DeviceUnsupported);
    EXPECT_NE(lacking.error().detail.find("glTexStorage3D"), std::string::npos);
    EXPECT_NE(lacking.error().detail.find("3.2"), std::string::npos);
}

TEST_F(GlObjects, QueriedLimitsReachTheSpecification) {
    EXPECT_GE(caps().maxTexture3DSize, 256); // ES 3.2, table 21.40
    EXPECT_GE(caps().maxTextureSize, 2048);
    EXPECT_GE(caps().maxUniformBlockSize, 16384);
    EXPECT_FALSE(caps().renderer.empty());
    ASSERT_FALSE(caps().extensions.empty());
    const std::string first = caps().extensions.front();
    const gl::Caps masked = *gl::queryCaps({first});
    EXPECT_EQ(
        std::set<std::string>(masked.extensions.begin(), masked.extensions.end()).count(first), 0U);
}

TEST_F(GlObjects, ObjectsExistWithTheirLabelUntilReleased) {
    auto labelOf = [](GLenum identifier, GLuint id) {
        std::array<GLchar, 64> text{};
        gl::GetObjectLabel(identifier, id, static_cast<GLsizei>(text.size()), nullptr, text.data());
        return std::string(text.data());
    };
    auto check = [&](auto object, GLenum identifier, auto exists, const char* expected) {
        const GLuint id = object.id();
        EXPECT_EQ(exists(id), GL_TRUE) << expected;
        EXPECT_EQ(labelOf(identifier, id), expected);
        object.release();
        EXPECT_EQ(exists(id), GL_FALSE) << expected;
        EXPECT_FALSE(object);
    };
    check(gl::Buffer::make("a buffer"), GL_BUFFER, gl::IsBuffer, "a buffer");
    for (const GLenum target : {GL_TEXTURE_2D, GL_TEXTURE_2D_ARRAY, GL_TEXTURE_3D}) {
        check(gl::Texture::make("a texture", target), GL_TEXTURE, gl::IsTexture, "a texture");
    }
    check(gl::Framebuffer::make("a target"), GL_FRAMEBUFFER, gl::IsFramebuffer, "a target");
    check(gl::VertexArray::make("an array"), GL_VERTEX_ARRAY, gl::IsVertexArray, "an array");
    check(gl::Sampler::make("a sampler"), GL_SAMPLER, gl::IsSampler, "a sampler");
    check(gl::ProgramObject::make("a program"), GL_PROGRAM, gl::IsProgram, "a program");
}

TEST_F(GlObjects, MakingLeavesBindingsAsTheyWere) {
    const gl::Texture volume = gl::Texture::make("bound", GL_TEXTURE_3D);
    const gl::VertexArray array = gl::VertexArray::make("bound");
    gl::BindTexture(GL_TEXTURE_3D, volume.id());
    gl::BindVertexArray(array.id());
    const gl::Texture other = gl::Texture::make("other", GL_TEXTURE_3D);
    const gl::VertexArray otherArray = gl::VertexArray::make("other");
    GLint bound = 0;
    gl::GetIntegerv(GL_TEXTURE_BINDING_3D, &bound);
    EXPECT_EQ(static_cast<GLuint>(bound), volume.id());
    gl::GetIntegerv(GL_VERTEX_ARRAY_BINDING, &bound);
    EXPECT_EQ(static_cast<GLuint>(bound), array.id());
}

TEST_F(GlObjects, MovingHandsOverAndScopeDeletes) {
    GLuint first = 0;
    GLuint second = 0;
    {
        gl::Buffer a = gl::Buffer::make("a");
        gl::Buffer b = gl::Buffer::make("b");
        first = a.id();
        second = b.id();
        a = std::move(b);
        EXPECT_EQ(a.id(), second);
        const gl::Buffer c = std::move(a);
        EXPECT_EQ(c.id(), second);
        EXPECT_EQ(a.id() == second, false);
    }
    EXPECT_EQ(gl::IsBuffer(first), GL_FALSE);
    EXPECT_EQ(gl::IsBuffer(second), GL_FALSE);
}

TEST_F(GlObjects, ForgottenAndBorrowedNamesAreNotDeleted) {
    gl::Texture texture = gl::Texture::make("kept", GL_TEXTURE_2D);
    const GLuint id = texture.id();
    {
        gl::Texture borrowed = gl::Texture::borrow(id);
        EXPECT_EQ(borrowed.id(), id);
        const gl::Texture moved = std::move(borrowed);
    }
    EXPECT_EQ(gl::IsTexture(id), GL_TRUE);
    texture.forget();
    EXPECT_EQ(texture.id(), 0U);
    EXPECT_EQ(gl::IsTexture(id), GL_TRUE);
    gl::DeleteTextures(1, &id);
}

TEST_F(GlObjects, ProgramBuildsAndFindsUniforms) {
    auto program = gl::buildProgram("tint", test::kTintVertexText, test::kTintFragmentText);
    ASSERT_TRUE(program.has_value()) << program.error().detail;
    EXPECT_GT(program->buildMs(), 0.0);
    EXPECT_GE(program->uniform("tint"), 0);
    EXPECT_EQ(program->uniform("tint"), gl::GetUniformLocation(program->id(), "tint"));
    EXPECT_EQ(program->uniform("absent"), -1);
    EXPECT_EQ(program->uniform("absent"), -1);
    const GLuint id = program->id();
    program->release();
    EXPECT_EQ(gl::IsProgram(id), GL_FALSE);
}

TEST_F(GlObjects, ComputeProgramBuilds) {
    const auto program = gl::buildComputeProgram(
        "fill", "#version 320 es\nlayout(local_size_x = 4) in;\nvoid main() {}\n");
    EXPECT_TRUE(program.has_value()) << program.error().detail;
}

TEST_F(GlObjects, BrokenShaderNamesProgramStageAndReason) {
    const std::string broken =
        std::string(test::kTintFragmentText) + "\nfloat f() { return nowhere; }\n";
    const auto compile = gl::buildProgram("broken", test::kTintVertexText, broken);
    ASSERT_FALSE(compile.has_value());
    EXPECT_EQ(compile.error().code, ErrorCode::ShaderCompile);
    for (const char* part : {"broken", "fragment shader", "nowhere"}) {
        EXPECT_NE(compile.error().detail.find(part), std::string::npos) << compile.error().detail;
    }
    EXPECT_EQ(compile.error().detail.find('\n'), std::string::npos);

    const auto link = gl::buildProgram("unlinked", test::kTintVertexText, R"(#version 320 es
precision highp float;
in vec4 nobodyWritesThis;
out vec4 colour;
void main() { colour = nobodyWritesThis; }
)");
    ASSERT_FALSE(link.has_value());
    EXPECT_EQ(link.error().code, ErrorCode::ShaderCompile);
    EXPECT_NE(link.error().detail.find("linking"), std::string::npos) << link.error().detail;
    takeErrorCount(); // some drivers report compiler errors to the debug output as well
}

TEST_F(GlObjects, DebugOutputCountsAndRestoresTheOuterOne) {
    int heard = 0;
    {
        gl::DebugOutput inner([&](const gl::DebugMessage& message) { heard += message.isError(); });
        gl::Enable(GL_TEXTURE_2D); // no capability of GLES 3
        EXPECT_EQ(inner.errorCount(), 1);
        EXPECT_FALSE(inner.firstError().empty());
        EXPECT_EQ(gl::takeError(), static_cast<GLenum>(GL_INVALID_ENUM));
        EXPECT_EQ(gl::takeError(), static_cast<GLenum>(GL_NO_ERROR));
    }
    EXPECT_EQ(heard, 1);
    EXPECT_EQ(takeErrorCount(), 0); // the fixture's own did not hear it
    gl::Enable(GL_TEXTURE_2D);
    EXPECT_EQ(takeErrorCount(), 1);
    EXPECT_EQ(takeErrorCount(), 0);
    EXPECT_EQ(gl::errorName(GL_INVALID_ENUM), "GL_INVALID_ENUM");
    EXPECT_EQ(gl::errorName(0x1234), "0x1234");
}

TEST_F(GlObjects, ContextsLiveAndEndApart) {
    auto other = EglContext::create();
    ASSERT_TRUE(other.has_value()) << other.error().detail;
    EXPECT_NE(other->description().find("EGL 1."), std::string::npos) << other->description();
    {
        auto third = EglContext::create({.debug = true, .preferSurfaceless = false});
        ASSERT_TRUE(third.has_value()) << third.error().detail;
    }
    other->makeCurrent();
    EXPECT_NE(gl::GetString(GL_VERSION), nullptr);
    makeCurrent();
    EXPECT_NE(gl::GetString(GL_VERSION), nullptr);
}

TEST_F(GlObjects, AbsentDeviceIsRefused) {
    const auto context = EglContext::create({.deviceIndex = 1000});
    ASSERT_FALSE(context.has_value());
    EXPECT_EQ(context.error().code, ErrorCode::InvalidArgument);
    EXPECT_NE(context.error().detail.find("1000"), std::string::npos);
}

} // namespace slabcast
