#include "core/draw/fullscreen_pass.h"

#include "core/gl/api.h"
#include "core/gl/shader_text.h"

namespace slabcast {

Result<void> FullscreenPass::create(std::string_view label, const char* fragmentFile) {
    const Result<std::string> vertex = expandShader("pass/fullscreen.vert", {});
    const Result<std::string> fragment = expandShader(fragmentFile, {});
    if (!vertex || !fragment) {
        return tl::unexpected(vertex ? fragment.error() : vertex.error());
    }
    Result<gl::Program> program = gl::buildProgram(label, *vertex, *fragment);
    if (!program) {
        return tl::unexpected(program.error());
    }
    program_ = std::move(*program);
    noVertices_ = gl::VertexArray::make("no vertices");
    return {};
}

const gl::Program& FullscreenPass::begin(GLuint layer) const {
    program_.use();
    gl::ActiveTexture(GL_TEXTURE0);
    gl::BindTexture(GL_TEXTURE_2D, layer);
    gl::BindSampler(0, 0);
    gl::Uniform1i(program_.uniform("layer"), 0);
    return program_;
}

void FullscreenPass::draw() const {
    gl::BindVertexArray(noVertices_.id());
    gl::DrawArrays(GL_TRIANGLES, 0, 3);
}

void FullscreenPass::forget() {
    program_.forget();
    noVertices_.forget();
}

} // namespace slabcast
