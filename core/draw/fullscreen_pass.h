#pragma once

#include <initializer_list>
#include <string_view>

#include "core/base/error.h"
#include "core/gl/program.h"

namespace slabcast {

/// A fragment shader for every pixel of the viewport, which reads a layer as `layer`.
class FullscreenPass {
public:
    /// Leaves the program in use. `uniforms`: those that are set after begin(). Fails:
    /// ShaderCompile.
    Result<void> create(std::string_view label, const char* fragmentFile,
                        std::initializer_list<const char*> uniforms);
    bool exists() const { return static_cast<bool>(program_); }

    /// Uses the program, with `layer` on unit 0; its other uniforms are set after this. Contract:
    /// unit 0 is the active one, without a sampler.
    const gl::Program& begin(GLuint layer) const;
    /// Takes no vertices: any vertex array will do that has three.
    static void draw();
    void forget();

private:
    gl::Program program_;
};

} // namespace slabcast
