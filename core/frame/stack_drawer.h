#pragma once

#include "core/frame/frame_block.h"
#include "core/frame/proxy_stack.h"
#include "core/gl/objects.h"
#include "core/gl/program.h"

namespace slabcast {

/// The unit polygons and the uniform blocks: one instanced draw per view. The vertices never
/// change; a view's planes are 16 bytes each in a uniform block.
class StackDrawer {
public:
    static constexpr GLuint kFrameBinding = 0;
    static constexpr GLuint kOutlineBinding = 1;

    void create();

    /// Tells a freshly linked program where its blocks and samplers are.
    static void connect(const gl::Program& program);

    /// `block`'s counts are filled in here. `tight`: outlines are drawn as rectangles, not as
    /// 10-gons. They are related to the view in float64: from afar a tangent's float32 is coarser
    /// than a pixel.
    void draw(FrameBlock block, const ProxyStack& stack, const Frustum& frustum, bool tight) const;

    void forget();

private:
    gl::Buffer polygons_, frameBlock_, outlineBlock_;
    gl::VertexArray vertices_;
};

} // namespace slabcast
