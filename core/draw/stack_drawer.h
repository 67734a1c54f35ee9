#pragma once

#include <vector>

#include "core/draw/frame_block.h"
#include "core/draw/proxy_stack.h"
#include "core/gl/objects.h"
#include "core/gl/program.h"

namespace slabcast {

/// Planes of one draw call, by their places in the stack, nearest first: `first`, `first + step`...
struct PlaneRun {
    int first = 0;
    int step = 1;
    int count = 0;
};

/// A stack's planes in the order of blending. Front to back in runs that end where the lattice's
/// plane number is a multiple of `planesPerRun`, whatever the stack begins with: what tightening
/// leaves out must not move a mark. 0: one run.
std::vector<PlaneRun> runsOf(BlendOrder order, const ProxyStack& stack, int planesPerRun);

/// The unit polygons and the uniform blocks: an instanced draw per run of a view's planes. The
/// vertices never change; a view's planes are 16 bytes each in a uniform block.
class StackDrawer {
public:
    static constexpr GLuint kFrameBinding = 0;
    static constexpr GLuint kOutlineBinding = 1;

    void create();

    /// Tells a freshly linked program where its blocks and samplers are.
    static void connect(const gl::Program& program);

    /// Uploads what the runs of a view share; `block`'s counts are filled in here. `tight`:
    /// outlines are drawn as rectangles, not as 10-gons. They are related to the view in float64:
    /// from afar a tangent's float32 is coarser than a pixel.
    void begin(FrameBlock block, const ProxyStack& stack, const Frustum& frustum, bool tight);

    /// Draws planes of the stack that was begun. Contract: the run lies within it.
    void draw(const gl::Program& program, const PlaneRun& run) const;

    void forget();

private:
    gl::Buffer polygons_, frameBlock_, outlineBlock_;
    gl::VertexArray vertices_;
    bool square_ = false; // what the stack that was begun is drawn with
};

} // namespace slabcast
