#pragma once

#include "core/base/error.h"
#include "core/gl/objects.h"
#include "core/gl/program.h"

namespace slabcast {

/// How a layer's colours become the target's.
enum class LayerConversion : std::uint8_t { None = 0, Encode = 1, Decode = 2 };

/// Blends a layer over the bound framebuffer's viewport at (x, y), once.
class LayerCompositor {
public:
    Result<void> create();
    void composite(GLuint texture, int x, int y, LayerConversion conversion) const;
    void forget();

private:
    gl::Program program_;
    gl::VertexArray noVertices_;
};

} // namespace slabcast
