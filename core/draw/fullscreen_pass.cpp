#include "core/draw/fullscreen_pass.h"

#include "core/gl/api.h"
#include "core/gl/shader_text.h"

namespace slabcast {

Result<void> FullscreenPass::create(std::string_view label, const char* fragmentFile,
                                    std::initializer_list<const char*> uniforms) {
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
    program_.use();
    gl::Uniform1i(program_.uniform("layer"), 0);
    for (const char* name : uniforms) {
        (void)program_.uniform(name); // begin() asks GL nothing
    }
    return {};
}

const gl::Program& FullscreenPass::begin(GLuint layer) const {
    program_.use();
    gl::BindTexture(GL_TEXTURE_2D, layer);
    return program_;
}

void FullscreenPass::draw() {
    gl::DrawArrays(GL_TRIANGLES, 0, 3);
}

void FullscreenPass::forget() {
    program_.forget();
}

} // namespace slabcast
