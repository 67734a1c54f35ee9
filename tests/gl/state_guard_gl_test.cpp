#include "core/gl/state_guard.h"

#include <array>
#include <map>
#include <string>
#include <vector>

#include "core/gl/color_targets.h"
#include "core/gl/objects.h"
#include "core/gl/program.h"
#include "core/scene/volume_texture.h"
#include "tests/support/render_support.h"

namespace slabcast {

namespace {

/// The documented state, read one by one: name of the state -> its value.
using Snapshot = std::map<std::string, std::vector<double>>;

struct Tracked {
    const char* name;
    GLenum query;
    int count;
};

constexpr Tracked kTracked[] = {
    {"program", GL_CURRENT_PROGRAM, 1},
    {"vertex array", GL_VERTEX_ARRAY_BINDING, 1},
    {"draw framebuffer", GL_DRAW_FRAMEBUFFER_BINDING, 1},
    {"read framebuffer", GL_READ_FRAMEBUFFER_BINDING, 1},
    {"viewport", GL_VIEWPORT, 4},
    {"scissor box", GL_SCISSOR_BOX, 4},
    {"colour mask", GL_COLOR_WRITEMASK, 4},
    {"clear colour", GL_COLOR_CLEAR_VALUE, 4},
    {"depth mask", GL_DEPTH_WRITEMASK, 1},
    {"depth function", GL_DEPTH_FUNC, 1},
    {"depth range", GL_DEPTH_RANGE, 2},
    {"blend source rgb", GL_BLEND_SRC_RGB, 1},
    {"blend source alpha", GL_BLEND_SRC_ALPHA, 1},
    {"blend destination rgb", GL_BLEND_DST_RGB, 1},
    {"blend destination alpha", GL_BLEND_DST_ALPHA, 1},
    {"blend equation rgb", GL_BLEND_EQUATION_RGB, 1},
    {"blend equation alpha", GL_BLEND_EQUATION_ALPHA, 1},
    {"blend", GL_BLEND, 1},
    {"cull face", GL_CULL_FACE, 1},
    {"depth test", GL_DEPTH_TEST, 1},
    {"dither", GL_DITHER, 1},
    {"polygon offset", GL_POLYGON_OFFSET_FILL, 1},
    {"rasterizer discard", GL_RASTERIZER_DISCARD, 1},
    {"sample alpha to coverage", GL_SAMPLE_ALPHA_TO_COVERAGE, 1},
    {"sample coverage", GL_SAMPLE_COVERAGE, 1},
    {"sample mask", GL_SAMPLE_MASK, 1},
    {"scissor test", GL_SCISSOR_TEST, 1},
    {"stencil test", GL_STENCIL_TEST, 1},
    {"array buffer", GL_ARRAY_BUFFER_BINDING, 1},
    {"unpack buffer", GL_PIXEL_UNPACK_BUFFER_BINDING, 1},
    {"pack buffer", GL_PIXEL_PACK_BUFFER_BINDING, 1},
    {"uniform buffer", GL_UNIFORM_BUFFER_BINDING, 1},
    {"storage buffer", GL_SHADER_STORAGE_BUFFER_BINDING, 1},
    {"unpack alignment", GL_UNPACK_ALIGNMENT, 1},
    {"unpack row length", GL_UNPACK_ROW_LENGTH, 1},
    {"unpack image height", GL_UNPACK_IMAGE_HEIGHT, 1},
    {"unpack skip pixels", GL_UNPACK_SKIP_PIXELS, 1},
    {"unpack skip rows", GL_UNPACK_SKIP_ROWS, 1},
    {"unpack skip images", GL_UNPACK_SKIP_IMAGES, 1},
    {"pack alignment", GL_PACK_ALIGNMENT, 1},
    {"pack row length", GL_PACK_ROW_LENGTH, 1},
    {"pack skip pixels", GL_PACK_SKIP_PIXELS, 1},
    {"pack skip rows", GL_PACK_SKIP_ROWS, 1},
    {"active texture", GL_ACTIVE_TEXTURE, 1},
};

struct IndexedBuffer {
    std::string name;
    GLenum binding, start, size;
};

const IndexedBuffer kIndexedBuffers[] = {
    {"uniform buffer ", GL_UNIFORM_BUFFER_BINDING, GL_UNIFORM_BUFFER_START, GL_UNIFORM_BUFFER_SIZE},
    {"storage buffer ", GL_SHADER_STORAGE_BUFFER_BINDING, GL_SHADER_STORAGE_BUFFER_START,
     GL_SHADER_STORAGE_BUFFER_SIZE},
};

GLint integer(GLenum query) {
    GLint value = 0;
    gl::GetIntegerv(query, &value);
    return value;
}

Snapshot snapshot() {
    Snapshot state;
    for (const Tracked& row : kTracked) {
        std::array<GLfloat, 4> values{};
        gl::GetFloatv(row.query, values.data());
        state[row.name] = {values.begin(), values.begin() + row.count};
    }
    for (const IndexedBuffer& kind : kIndexedBuffers) {
        for (GLuint i = 0; i < 2; ++i) {
            std::vector<double>& value = state[kind.name + std::to_string(i)];
            for (const GLenum query : {kind.binding, kind.start, kind.size}) {
                GLint64 part = 0;
                gl::GetInteger64i_v(query, i, &part);
                value.push_back(double(part));
            }
        }
    }
    for (const GLenum query :
         {GL_IMAGE_BINDING_NAME, GL_IMAGE_BINDING_LEVEL, GL_IMAGE_BINDING_LAYERED,
          GL_IMAGE_BINDING_LAYER, GL_IMAGE_BINDING_ACCESS, GL_IMAGE_BINDING_FORMAT}) {
        GLint value = 0;
        gl::GetIntegeri_v(query, 0, &value);
        state["image unit 0, " + std::to_string(query)] = {double(value)};
    }
    GLint active = 0;
    gl::GetIntegerv(GL_ACTIVE_TEXTURE, &active);
    for (GLuint unit = 0; unit < 8; ++unit) {
        gl::ActiveTexture(GL_TEXTURE0 + unit);
        for (const GLenum binding : {GL_TEXTURE_BINDING_2D, GL_TEXTURE_BINDING_2D_ARRAY,
                                     GL_TEXTURE_BINDING_3D, GL_SAMPLER_BINDING}) {
            GLint id = 0;
            gl::GetIntegerv(binding, &id);
            state["unit " + std::to_string(unit) + " binding " + std::to_string(binding)] = {
                static_cast<double>(id)};
        }
    }
    gl::ActiveTexture(static_cast<GLenum>(active));
    return state;
}

/// Objects and numbers of one owner of the context; `k` tells owners apart.
struct Owner {
    explicit Owner(int number) : k(number) {
        gl::BindBuffer(GL_UNIFORM_BUFFER, buffer.id());
        gl::BufferData(GL_UNIFORM_BUFFER, 4096, nullptr, GL_STATIC_DRAW);
        gl::BindTexture(GL_TEXTURE_3D, volume.id()); // image units take immutable textures alone
        gl::TexStorage3D(GL_TEXTURE_3D, 2, GL_RGBA32UI, 4, 4, 4);
    }

    int k;
    gl::Buffer buffer = gl::Buffer::make("owner");
    gl::Texture plane = gl::Texture::make("owner", GL_TEXTURE_2D);
    gl::Texture layers = gl::Texture::make("owner", GL_TEXTURE_2D_ARRAY);
    gl::Texture volume = gl::Texture::make("owner", GL_TEXTURE_3D);
    gl::Sampler sampler = gl::Sampler::make("owner");
    gl::Framebuffer draw = gl::Framebuffer::make("owner");
    gl::Framebuffer read = gl::Framebuffer::make("owner");
    gl::VertexArray array = gl::VertexArray::make("owner");
    gl::Program program =
        *gl::buildProgram("owner", test::kTintVertexText, test::kTintFragmentText);

    void bindAll() const {
        program.use();
        gl::BindVertexArray(array.id());
        gl::BindFramebuffer(GL_DRAW_FRAMEBUFFER, draw.id());
        gl::BindFramebuffer(GL_READ_FRAMEBUFFER, read.id());
        for (GLuint unit = 0; unit < 8; ++unit) {
            gl::ActiveTexture(GL_TEXTURE0 + unit);
            gl::BindTexture(GL_TEXTURE_2D, plane.id());
            gl::BindTexture(GL_TEXTURE_2D_ARRAY, layers.id());
            gl::BindTexture(GL_TEXTURE_3D, volume.id());
            gl::BindSampler(unit, sampler.id());
        }
        gl::ActiveTexture(GL_TEXTURE3 + static_cast<GLenum>(k));
        for (const GLenum target :
             {GL_ARRAY_BUFFER, GL_PIXEL_UNPACK_BUFFER, GL_PIXEL_PACK_BUFFER}) {
            gl::BindBuffer(target, buffer.id());
        }
        for (const GLenum target : {GL_UNIFORM_BUFFER, GL_SHADER_STORAGE_BUFFER}) {
            gl::BindBufferRange(target, 0, buffer.id(), 256 * k, 512);
            gl::BindBufferBase(target, 1, buffer.id());
            gl::BindBuffer(target, k == 1 ? 0 : buffer.id()); // not what the last index holds
        }
        gl::BindImageTexture(0, volume.id(), k - 1, k == 1 ? GL_TRUE : GL_FALSE, k,
                             k == 1 ? GL_WRITE_ONLY : GL_READ_ONLY,
                             k == 1 ? GL_RGBA32F : GL_RGBA32UI);
    }

    void setAll() const {
        const auto on = static_cast<GLboolean>(k == 1);
        const auto shade = static_cast<GLfloat>(k) / 8.0F;
        gl::Viewport(k, k + 1, k + 2, k + 3);
        gl::Scissor(k + 4, k + 5, k + 6, k + 7);
        gl::ColorMask(on, !on, on, !on);
        gl::ClearColor(shade, shade, shade, shade);
        gl::DepthMask(on);
        gl::DepthFunc(GL_NEVER + static_cast<GLenum>(k));
        gl::DepthRangef(shade, 1.0F - shade);
        gl::BlendFuncSeparate(GL_SRC_COLOR + k, GL_DST_ALPHA + k, GL_ONE_MINUS_SRC_COLOR + k,
                              GL_SRC_ALPHA + k);
        gl::BlendEquationSeparate(k == 1 ? GL_FUNC_SUBTRACT : GL_MAX,
                                  k == 1 ? GL_MIN : GL_FUNC_ADD);
        for (const GLenum name :
             {GL_BLEND, GL_CULL_FACE, GL_DEPTH_TEST, GL_DITHER, GL_POLYGON_OFFSET_FILL,
              GL_RASTERIZER_DISCARD, GL_SAMPLE_ALPHA_TO_COVERAGE, GL_SAMPLE_COVERAGE,
              GL_SAMPLE_MASK, GL_SCISSOR_TEST, GL_STENCIL_TEST}) {
            (on ? gl::Enable : gl::Disable)(name);
        }
        for (const GLenum name : {GL_UNPACK_ALIGNMENT, GL_PACK_ALIGNMENT}) {
            gl::PixelStorei(name, k * 2);
        }
        for (const GLenum name : {GL_UNPACK_ROW_LENGTH, GL_UNPACK_IMAGE_HEIGHT,
                                  GL_UNPACK_SKIP_PIXELS, GL_UNPACK_SKIP_ROWS, GL_UNPACK_SKIP_IMAGES,
                                  GL_PACK_ROW_LENGTH, GL_PACK_SKIP_PIXELS, GL_PACK_SKIP_ROWS}) {
            gl::PixelStorei(name, k * 3);
        }
    }
};

} // namespace

class StateGuardGl : public GlTest {};

TEST_F(StateGuardGl, RestoresAllThatItDocuments) {
    const gl::StateGuard forOtherTests;
    const Owner host(1);
    const Owner renderer(2);
    host.bindAll();
    host.setAll();
    const Snapshot before = snapshot();
    {
        const gl::StateGuard guard;
        renderer.bindAll();
        renderer.setAll();
        const Snapshot inside = snapshot();
        for (const auto& [name, value] : before) { // else the comparison below could not fail
            EXPECT_NE(inside.at(name), value) << name;
        }
    }
    const Snapshot after = snapshot();
    for (const auto& [name, value] : before) {
        EXPECT_EQ(after.at(name), value) << name;
    }
}

TEST_F(StateGuardGl, AProgramThatTheHostDeletedEndsWithoutAnError) {
    const gl::StateGuard forOtherTests;
    const auto tint = [] {
        return *gl::buildProgram("tint", test::kTintVertexText, test::kTintFragmentText);
    };
    gl::Program ofHost = tint();
    const gl::Program ours = tint();
    ofHost.use();
    ofHost.release(); // it stays current
    ASSERT_NE(integer(GL_CURRENT_PROGRAM), 0);
    {
        const gl::StateGuard guard;
        ours.use();
    }
    EXPECT_EQ(takeErrorCount(), 0);
    EXPECT_EQ(integer(GL_CURRENT_PROGRAM), 0);
}

TEST_F(StateGuardGl, PlainPixelTransferIsPlain) {
    const gl::StateGuard guard;
    const Owner host(1);
    host.bindAll();
    host.setAll();
    gl::StateGuard::usePlainUnpacking();
    gl::StateGuard::usePlainPacking();
    const Snapshot state = snapshot();
    for (const char* name :
         {"unpack buffer", "pack buffer", "unpack row length", "unpack image height",
          "unpack skip pixels", "unpack skip rows", "unpack skip images", "pack row length",
          "pack skip pixels", "pack skip rows"}) {
        EXPECT_EQ(state.at(name), std::vector<double>{0.0}) << name;
    }
    EXPECT_EQ(state.at("unpack alignment"), std::vector<double>{1.0});
    EXPECT_EQ(state.at("pack alignment"), std::vector<double>{1.0});
}

TEST_F(StateGuardGl, UnitsBeyondTheRestoredKeepTheirTextures) {
    const gl::StateGuard forOtherTests;
    const Owner host(1);
    gl::ActiveTexture(GL_TEXTURE9);
    gl::BindTexture(GL_TEXTURE_2D, host.plane.id());
    gl::BindTexture(GL_TEXTURE_3D, host.volume.id());
    {
        const gl::StateGuard guard;
        gl::ColorTargets layer;
        EXPECT_TRUE(layer.resize(4, 4, {GL_RGBA8}).has_value());
        EXPECT_TRUE(uploadTable({glm::vec4(1.0F)}, false, caps()).has_value());
        const glm::u8vec4 colour(1);
        EXPECT_TRUE(uploadClassified(&colour, {1, 1, 1}, caps()).has_value());
    }
    EXPECT_EQ(integer(GL_ACTIVE_TEXTURE), GL_TEXTURE9);
    EXPECT_EQ(integer(GL_TEXTURE_BINDING_2D), static_cast<GLint>(host.plane.id()));
    EXPECT_EQ(integer(GL_TEXTURE_BINDING_3D), static_cast<GLint>(host.volume.id()));
    gl::BindTexture(GL_TEXTURE_2D, 0);
    gl::BindTexture(GL_TEXTURE_3D, 0);
}

TEST_F(StateGuardGl, MakingABufferBindsNone) {
    const Owner host(1);
    gl::BindBuffer(GL_COPY_WRITE_BUFFER, host.buffer.id());
    const gl::Buffer made = gl::Buffer::make("made");
    EXPECT_EQ(integer(GL_COPY_WRITE_BUFFER_BINDING), static_cast<GLint>(host.buffer.id()));
    gl::BindBuffer(GL_COPY_WRITE_BUFFER, 0);
}

/// A target of four samples per pixel, as a host may give.
class MultisampleTarget {
public:
    explicit MultisampleTarget(glm::ivec2 size) : size_(size) {
        gl::GenRenderbuffers(1, &color_);
        gl::BindRenderbuffer(GL_RENDERBUFFER, color_);
        gl::RenderbufferStorageMultisample(GL_RENDERBUFFER, 4, GL_RGBA8, size.x, size.y);
        gl::BindFramebuffer(GL_FRAMEBUFFER, framebuffer_.id());
        gl::FramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, color_);
        const GLfloat clear[4] = {};
        gl::ClearBufferfv(GL_COLOR, 0, clear);
    }
    ~MultisampleTarget() { gl::DeleteRenderbuffers(1, &color_); }
    MultisampleTarget(const MultisampleTarget&) = delete;
    MultisampleTarget& operator=(const MultisampleTarget&) = delete;

    GLuint framebuffer() const { return framebuffer_.id(); }

    test::Picture resolved() const {
        gl::ColorTargets single;
        EXPECT_TRUE(single.resize(size_.x, size_.y, {GL_RGBA8}).has_value());
        gl::BindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer_.id());
        gl::BlitFramebuffer(0, 0, size_.x, size_.y, 0, 0, size_.x, size_.y, GL_COLOR_BUFFER_BIT,
                            GL_NEAREST);
        return {size_, single.read()};
    }

private:
    glm::ivec2 size_;
    GLuint color_ = 0;
    gl::Framebuffer framebuffer_ = gl::Framebuffer::make("multisampled");
};

class HostSwitchesGl : public test::RenderTest {};

TEST_F(HostSwitchesGl, ChangeNothingOfWhatIsDrawn) {
    const gl::StateGuard forOtherTests;
    const Scene scene = makeScene(test::constantVolume({16, 16, 16}, 5),
                                  {.tf = test::uniformTransfer(0.05, glm::dvec3(1.0))});
    Settings settings = test::segments(4, SegmentForm::Loop);
    settings.target = TargetFormat::Rgba8;
    const FramePlan plan = decide(scene, settings);
    const auto drawnUnder = [&](GLenum hostSwitch) {
        const MultisampleTarget target(test::kSize);
        const ViewTarget where{test::asymmetricView(scene),
                               target.framebuffer(),
                               {0, 0, test::kSize.x, test::kSize.y}};
        EXPECT_TRUE(renderer().prepare(scene, plan, {&where, 1}).has_value());
        gl::Enable(hostSwitch);
        EXPECT_TRUE(renderer().draw(scene, plan, {&where, 1}).has_value());
        EXPECT_TRUE(gl::IsEnabled(hostSwitch)) << hostSwitch;
        gl::Disable(hostSwitch);
        return target.resolved();
    };
    gl::SampleCoverage(0.25F, GL_FALSE);
    gl::SampleMaski(0, 1);
    const test::Picture plain = drawnUnder(GL_BLEND); // which is set anyway
    EXPECT_GT(plain.at(test::kSize / 2).a, 0.2);
    for (const GLenum hostSwitch : {GL_CULL_FACE, GL_DEPTH_TEST, GL_DITHER, GL_RASTERIZER_DISCARD,
                                    GL_SAMPLE_ALPHA_TO_COVERAGE, GL_SAMPLE_COVERAGE, GL_SAMPLE_MASK,
                                    GL_SCISSOR_TEST, GL_STENCIL_TEST}) {
        EXPECT_EQ(test::differingPixels(drawnUnder(hostSwitch), plain), 0) << hostSwitch;
    }
    gl::SampleCoverage(1.0F, GL_FALSE);
    gl::SampleMaski(0, ~0U);
}

} // namespace slabcast
