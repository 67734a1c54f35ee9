#include "core/gl/state_guard.h"

namespace slabcast::gl {

namespace {

constexpr std::array<GLenum, StateGuard::kSwitches> kSwitchNames = {GL_BLEND,
                                                                    GL_CULL_FACE,
                                                                    GL_DEPTH_TEST,
                                                                    GL_DITHER,
                                                                    GL_POLYGON_OFFSET_FILL,
                                                                    GL_RASTERIZER_DISCARD,
                                                                    GL_SAMPLE_ALPHA_TO_COVERAGE,
                                                                    GL_SAMPLE_COVERAGE,
                                                                    GL_SAMPLE_MASK,
                                                                    GL_SCISSOR_TEST,
                                                                    GL_STENCIL_TEST};

struct PixelStore {
    GLenum name;
    GLint plain; // what tightly packed pixels need
};

constexpr std::array<PixelStore, 6> kUnpacking = {{{GL_UNPACK_ALIGNMENT, 1},
                                                   {GL_UNPACK_ROW_LENGTH, 0},
                                                   {GL_UNPACK_IMAGE_HEIGHT, 0},
                                                   {GL_UNPACK_SKIP_PIXELS, 0},
                                                   {GL_UNPACK_SKIP_ROWS, 0},
                                                   {GL_UNPACK_SKIP_IMAGES, 0}}};
constexpr std::array<PixelStore, 4> kPacking = {{{GL_PACK_ALIGNMENT, 1},
                                                 {GL_PACK_ROW_LENGTH, 0},
                                                 {GL_PACK_SKIP_PIXELS, 0},
                                                 {GL_PACK_SKIP_ROWS, 0}}};
static_assert(kUnpacking.size() + kPacking.size() == StateGuard::kPixelStores);

GLenum pixelStoreName(std::size_t i) {
    return i < kUnpacking.size() ? kUnpacking[i].name : kPacking[i - kUnpacking.size()].name;
}

GLint integer(GLenum name) {
    GLint value = 0;
    GetIntegerv(name, &value);
    return value;
}

GLint indexed(GLenum name, GLuint index) {
    GLint value = 0;
    GetIntegeri_v(name, index, &value);
    return value;
}

GLuint asName(GLint value) {
    return static_cast<GLuint>(value);
}

GLenum asEnum(GLint value) {
    return static_cast<GLenum>(value);
}

/// 0 of one that the host has deleted: it lives on while it is current, and its name ends with the
/// first program that takes its place, so that nothing could set it back (GLES 3.2, section 7.3).
GLint currentProgram() {
    const GLint program = integer(GL_CURRENT_PROGRAM);
    GLint deleted = GL_FALSE;
    if (program != 0) {
        GetProgramiv(asName(program), GL_DELETE_STATUS, &deleted);
    }
    return deleted == GL_TRUE ? 0 : program;
}

void setSwitch(GLenum name, bool on) {
    (on ? Enable : Disable)(name);
}

} // namespace

StateGuard::StateGuard() {
    saveBindings();
    GetIntegerv(GL_VIEWPORT, viewport_.data());
    GetIntegerv(GL_SCISSOR_BOX, scissor_.data());
    GetFloatv(GL_COLOR_CLEAR_VALUE, clearColor_.data());
    GetBooleanv(GL_COLOR_WRITEMASK, colorMask_.data());
    GetBooleanv(GL_DEPTH_WRITEMASK, &depthMask_);
    depthFunction_ = integer(GL_DEPTH_FUNC);
    GetFloatv(GL_DEPTH_RANGE, depthRange_.data());
    blend_ = {integer(GL_BLEND_SRC_RGB),      integer(GL_BLEND_SRC_ALPHA),
              integer(GL_BLEND_DST_RGB),      integer(GL_BLEND_DST_ALPHA),
              integer(GL_BLEND_EQUATION_RGB), integer(GL_BLEND_EQUATION_ALPHA)};
    for (std::size_t i = 0; i < switches_.size(); ++i) {
        switches_[i] = IsEnabled(kSwitchNames[i]) == GL_TRUE;
    }
    for (std::size_t i = 0; i < pixelStores_.size(); ++i) {
        pixelStores_[i] = integer(pixelStoreName(i));
    }
}

StateGuard::~StateGuard() {
    restoreBindings();
    Viewport(viewport_[0], viewport_[1], viewport_[2], viewport_[3]);
    Scissor(scissor_[0], scissor_[1], scissor_[2], scissor_[3]);
    ClearColor(clearColor_[0], clearColor_[1], clearColor_[2], clearColor_[3]);
    ColorMask(colorMask_[0], colorMask_[1], colorMask_[2], colorMask_[3]);
    DepthMask(depthMask_);
    DepthFunc(asEnum(depthFunction_));
    DepthRangef(depthRange_[0], depthRange_[1]);
    BlendFuncSeparate(asEnum(blend_.sourceRgb), asEnum(blend_.destinationRgb),
                      asEnum(blend_.sourceAlpha), asEnum(blend_.destinationAlpha));
    BlendEquationSeparate(asEnum(blend_.equationRgb), asEnum(blend_.equationAlpha));
    for (std::size_t i = 0; i < switches_.size(); ++i) {
        setSwitch(kSwitchNames[i], switches_[i]);
    }
    for (std::size_t i = 0; i < pixelStores_.size(); ++i) {
        PixelStorei(pixelStoreName(i), pixelStores_[i]);
    }
}

void StateGuard::usePlainUnpacking() {
    BindBuffer(GL_PIXEL_UNPACK_BUFFER, 0);
    for (const PixelStore& store : kUnpacking) {
        PixelStorei(store.name, store.plain);
    }
}

void StateGuard::usePlainPacking() {
    BindBuffer(GL_PIXEL_PACK_BUFFER, 0);
    for (const PixelStore& store : kPacking) {
        PixelStorei(store.name, store.plain);
    }
}

void StateGuard::saveBindings() {
    program_ = currentProgram();
    vertexArray_ = integer(GL_VERTEX_ARRAY_BINDING);
    drawFramebuffer_ = integer(GL_DRAW_FRAMEBUFFER_BINDING);
    readFramebuffer_ = integer(GL_READ_FRAMEBUFFER_BINDING);
    arrayBuffer_ = integer(GL_ARRAY_BUFFER_BINDING);
    unpackBuffer_ = integer(GL_PIXEL_UNPACK_BUFFER_BINDING);
    packBuffer_ = integer(GL_PIXEL_PACK_BUFFER_BINDING);
    uniformBuffers_ =
        buffersOf(GL_UNIFORM_BUFFER_BINDING, GL_UNIFORM_BUFFER_START, GL_UNIFORM_BUFFER_SIZE);
    storageBuffers_ = buffersOf(GL_SHADER_STORAGE_BUFFER_BINDING, GL_SHADER_STORAGE_BUFFER_START,
                                GL_SHADER_STORAGE_BUFFER_SIZE);
    image_ = {indexed(GL_IMAGE_BINDING_NAME, 0),    indexed(GL_IMAGE_BINDING_LEVEL, 0),
              indexed(GL_IMAGE_BINDING_LAYERED, 0), indexed(GL_IMAGE_BINDING_LAYER, 0),
              indexed(GL_IMAGE_BINDING_ACCESS, 0),  indexed(GL_IMAGE_BINDING_FORMAT, 0)};
    activeTexture_ = integer(GL_ACTIVE_TEXTURE);
    for (GLuint i = 0; i < units_.size(); ++i) {
        ActiveTexture(GL_TEXTURE0 + i);
        units_[i] = {integer(GL_TEXTURE_BINDING_2D), integer(GL_TEXTURE_BINDING_2D_ARRAY),
                     integer(GL_TEXTURE_BINDING_3D), integer(GL_SAMPLER_BINDING)};
    }
    ActiveTexture(GL_TEXTURE0); // the host's may be beyond the units that are restored
}

void StateGuard::restoreBindings() const {
    UseProgram(asName(program_));
    BindVertexArray(asName(vertexArray_));
    BindFramebuffer(GL_DRAW_FRAMEBUFFER, asName(drawFramebuffer_));
    BindFramebuffer(GL_READ_FRAMEBUFFER, asName(readFramebuffer_));
    BindBuffer(GL_ARRAY_BUFFER, asName(arrayBuffer_));
    BindBuffer(GL_PIXEL_UNPACK_BUFFER, asName(unpackBuffer_));
    BindBuffer(GL_PIXEL_PACK_BUFFER, asName(packBuffer_));
    restore(GL_UNIFORM_BUFFER, uniformBuffers_);
    restore(GL_SHADER_STORAGE_BUFFER, storageBuffers_);
    BindImageTexture(0, asName(image_.texture), image_.level,
                     static_cast<GLboolean>(image_.layered), image_.layer, asEnum(image_.access),
                     asEnum(image_.format));
    for (GLuint i = 0; i < units_.size(); ++i) {
        ActiveTexture(GL_TEXTURE0 + i);
        BindTexture(GL_TEXTURE_2D, asName(units_[i].texture2d));
        BindTexture(GL_TEXTURE_2D_ARRAY, asName(units_[i].texture2dArray));
        BindTexture(GL_TEXTURE_3D, asName(units_[i].texture3d));
        BindSampler(i, asName(units_[i].sampler));
    }
    ActiveTexture(asEnum(activeTexture_));
}

StateGuard::Buffers StateGuard::buffersOf(GLenum binding, GLenum start, GLenum size) {
    Buffers buffers{integer(binding), {}};
    for (GLuint i = 0; i < buffers.indexed.size(); ++i) {
        GetIntegeri_v(binding, i, &buffers.indexed[i].buffer);
        GetInteger64i_v(start, i, &buffers.indexed[i].offset);
        GetInteger64i_v(size, i, &buffers.indexed[i].size);
    }
    return buffers;
}

void StateGuard::restore(GLenum target, const Buffers& buffers) {
    for (GLuint i = 0; i < buffers.indexed.size(); ++i) {
        const BufferRange& range = buffers.indexed[i];
        if (range.size == 0) { // bound as a whole, or not bound
            BindBufferBase(target, i, asName(range.buffer));
        } else {
            BindBufferRange(target, i, asName(range.buffer), GLintptr(range.offset),
                            GLsizeiptr(range.size));
        }
    }
    BindBuffer(target, asName(buffers.generic)); // last: indexed binds move it too
}

} // namespace slabcast::gl
