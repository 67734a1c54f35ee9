#include "core/frame/layer_compositor.h"

#include "core/frame/shader_text.h"
#include "core/gl/api.h"

namespace slabcast {

Result<void> LayerCompositor::create() {
    const Result<std::string> vertex = expandShader("fullscreen.vert", {});
    const Result<std::string> fragment = expandShader("composite.frag", {});
    if (!vertex || !fragment) {
        return tl::unexpected(vertex ? fragment.error() : vertex.error());
    }
    Result<gl::Program> program = gl::buildProgram("composite", *vertex, *fragment);
    if (!program) {
        return tl::unexpected(program.error());
    }
    program_ = std::move(*program);
    noVertices_ = gl::VertexArray::make("no vertices");
    return {};
}

void LayerCompositor::composite(GLuint texture, int x, int y, LayerConversion conversion) const {
    program_.use();
    gl::ActiveTexture(GL_TEXTURE0);
    gl::BindTexture(GL_TEXTURE_2D, texture);
    gl::BindSampler(0, 0);
    gl::Uniform1i(program_.uniform("layer"), 0);
    gl::Uniform2i(program_.uniform("layerOrigin"), x, y);
    gl::Uniform1i(program_.uniform("conversion"), static_cast<GLint>(conversion));
    gl::BindVertexArray(noVertices_.id());
    gl::DrawArrays(GL_TRIANGLES, 0, 3);
}

void LayerCompositor::forget() {
    program_.forget();
    noVertices_.forget();
}

} // namespace slabcast
