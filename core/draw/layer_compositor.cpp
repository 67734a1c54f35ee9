#include "core/draw/layer_compositor.h"

#include "core/gl/api.h"

namespace slabcast {

void LayerCompositor::composite(GLuint texture, int x, int y, LayerConversion conversion) const {
    const gl::Program& program = pass_.begin(texture);
    gl::Uniform2i(program.uniform("layerOrigin"), x, y);
    if (conversion != conversion_) {
        gl::Uniform1i(program.uniform("conversion"), static_cast<GLint>(conversion));
        conversion_ = conversion;
    }
    pass_.draw();
}

} // namespace slabcast
