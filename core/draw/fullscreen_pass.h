#pragma once

#include <string_view>

#include "core/base/error.h"
#include "core/gl/objects.h"
#include "core/gl/program.h"

namespace slabcast {

/// A fragment shader for every pixel of the viewport, which reads a layer as `layer`.
class FullscreenPass {
public:
    /// Fails: ShaderCompile.
    Result<void> create(std::string_view label, const char* fragmentFile);
    bool exists() const { return static_cast<bool>(program_); }

    /// Uses the program, with `layer` on unit 0; its other uniforms are set after this.
    const gl::Program& begin(GLuint layer) const;
    void draw() const;
    void forget();

private:
    gl::Program program_;
    gl::VertexArray noVertices_;
};

} // namespace slabcast
