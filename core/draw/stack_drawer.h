#pragma once

#include <cstddef>
#include <cstdint>
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

/// What drawing knows of a view's planes.
struct StackShape {
    int firstPlane = 0; // of the lattice
    int planes = 0;
    bool square = false; // drawn as rectangles, not as 10-gons
};

/// A stack's planes in the order of blending, run by run. Front to back runs end where the
/// lattice's plane number is a multiple of `planesPerRun`, whatever the stack begins with: what
/// tightening leaves out must not move a mark. 0: one run.
class PlaneRuns {
public:
    PlaneRuns(BlendOrder order, const StackShape& stack, int planesPerRun);
    /// False after the last one.
    bool next(PlaneRun& run);
    bool done() const { return begun_ >= stack_.planes; }

private:
    BlendOrder order_;
    StackShape stack_;
    int planesPerRun_;
    int begun_ = 0;
};

/// The unit polygons and the uniform blocks: an instanced draw per run of a view's planes. The
/// vertices never change; a view's planes are 16 bytes each in a uniform block, and the blocks of
/// all views of a frame one upload.
class StackDrawer {
public:
    static constexpr GLuint kFrameBinding = 0;
    static constexpr GLuint kOutlineBinding = 1;

    void create();

    /// Tells a freshly linked program where its blocks and samplers are, and finds its uniforms.
    static void connect(const gl::Program& program);

    /// Room for so many views; nothing after it allocates.
    void reserve(std::size_t views);
    std::size_t views() const { return shapes_.size(); }

    /// Stages what a view's runs share; `block`'s counts are filled in here. `tight`: outlines are
    /// drawn as rectangles, not as 10-gons. They are related to the view in float64: from afar a
    /// tangent's float32 is coarser than a pixel. Contract: reserved.
    void stage(std::size_t view, FrameBlock block, const ProxyStack& stack, const Frustum& frustum,
               bool tight);
    /// Uploads what was staged of the first so many views.
    void upload(std::size_t views) const;

    /// Binds a view's blocks.
    const StackShape& begin(std::size_t view) const;
    /// Binds the polygons, which any other pass may draw without.
    void useVertices() const;
    /// Draws planes of the stack that was begun. Contract: the run lies within it; `program` and
    /// the vertices are in use.
    void draw(const gl::Program& program, const StackShape& stack, const PlaneRun& run) const;

    std::int64_t bytes() const;
    void forget();

private:
    gl::Buffer polygons_, blocks_;
    gl::VertexArray vertices_;
    std::vector<std::byte> staged_; // as the buffer
    std::vector<StackShape> shapes_;
};

} // namespace slabcast
