#include "core/gl/objects.h"

#include <algorithm>

namespace slabcast::gl {

namespace {

GLuint generate(PFNGLGENTEXTURESPROC gen) { // all glGen* share one signature
    GLuint id = 0;
    gen(1, &id);
    return id;
}

GLuint bound(GLenum binding) {
    GLint id = 0;
    GetIntegerv(binding, &id);
    return static_cast<GLuint>(id);
}

GLenum bindingOf(GLenum textureTarget) {
    switch (textureTarget) {
    case GL_TEXTURE_2D:
        return GL_TEXTURE_BINDING_2D;
    case GL_TEXTURE_2D_ARRAY:
        return GL_TEXTURE_BINDING_2D_ARRAY;
    case GL_TEXTURE_3D:
        return GL_TEXTURE_BINDING_3D;
    default:
        contractBreach(__func__, "a 2D, 2D array or 3D texture target", textureTarget);
    }
}

} // namespace

void label(GLenum identifier, GLuint id, std::string_view text) {
    constexpr std::size_t kShortestLimit =
        255; // GL_MAX_LABEL_LENGTH is 256 at least, its end included
    ObjectLabel(identifier, id, static_cast<GLsizei>(std::min(text.size(), kShortestLimit)),
                text.data());
}

Buffer Buffer::make(std::string_view text) {
    const GLuint before = bound(GL_COPY_WRITE_BUFFER_BINDING);
    const GLuint id = generate(GenBuffers);
    BindBuffer(GL_COPY_WRITE_BUFFER, id);
    BindBuffer(GL_COPY_WRITE_BUFFER, before);
    label(GL_BUFFER, id, text);
    return {id, true};
}

Texture Texture::make(std::string_view text, GLenum target) {
    const GLuint before = bound(bindingOf(target));
    const GLuint id = generate(GenTextures);
    BindTexture(target, id);
    BindTexture(target, before);
    label(GL_TEXTURE, id, text);
    return {id, true};
}

Framebuffer Framebuffer::make(std::string_view text) {
    const GLuint before = bound(GL_READ_FRAMEBUFFER_BINDING);
    const GLuint id = generate(GenFramebuffers);
    BindFramebuffer(GL_READ_FRAMEBUFFER, id);
    BindFramebuffer(GL_READ_FRAMEBUFFER, before);
    label(GL_FRAMEBUFFER, id, text);
    return {id, true};
}

VertexArray VertexArray::make(std::string_view text) {
    const GLuint before = bound(GL_VERTEX_ARRAY_BINDING);
    const GLuint id = generate(GenVertexArrays);
    BindVertexArray(id);
    BindVertexArray(before);
    label(GL_VERTEX_ARRAY, id, text);
    return {id, true};
}

Sampler Sampler::make(std::string_view text) {
    const GLuint id = generate(GenSamplers);
    SamplerParameteri(id, GL_TEXTURE_WRAP_R, GL_REPEAT); // its default: the first use creates it
    label(GL_SAMPLER, id, text);
    return {id, true};
}

ProgramObject ProgramObject::make(std::string_view text) {
    const GLuint id = CreateProgram();
    label(GL_PROGRAM, id, text);
    return {id, true};
}

} // namespace slabcast::gl
