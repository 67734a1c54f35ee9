#include "core/draw/stack_drawer.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/gl/api.h"
#include "core/plan/shader_resources.h"

namespace slabcast {

namespace {

constexpr int kCorners = 10;

/// A 10-gon around the unit circle, then the square.
std::vector<glm::vec2> unitPolygons() {
    std::vector<glm::vec2> vertices;
    const double circumradius = 1.0 / std::cos(std::numbers::pi / kCorners);
    for (int k = 0; k < kCorners; ++k) {
        const double angle = 2.0 * std::numbers::pi * k / kCorners;
        vertices.push_back(glm::vec2(circumradius * glm::dvec2(std::cos(angle), std::sin(angle))));
    }
    vertices.insert(vertices.end(), {{-1.0F, -1.0F}, {1.0F, -1.0F}, {1.0F, 1.0F}, {-1.0F, 1.0F}});
    return vertices;
}

/// New storage at every upload: the driver keeps the old one until the GPU has read it, nothing
/// waits.
template <class T>
void uploadBlock(GLuint binding, const gl::Buffer& buffer, const T* data, std::size_t bytes) {
    gl::BindBufferBase(GL_UNIFORM_BUFFER, binding, buffer.id());
    gl::BufferData(GL_UNIFORM_BUFFER, static_cast<GLsizeiptr>(bytes), data, GL_STREAM_DRAW);
}

} // namespace

std::vector<PlaneRun> runsOf(BlendOrder order, const ProxyStack& stack, int planesPerRun) {
    const int planes = static_cast<int>(stack.outlines.size());
    if (order == BlendOrder::BackToFront) {
        return {{planes - 1, -1, planes}};
    }
    std::vector<PlaneRun> runs;
    for (int first = 0, end = 0; first < planes; first = end) {
        const int toMark =
            planesPerRun > 0 ? planesPerRun - (stack.firstPlane + first) % planesPerRun : planes;
        end = std::min(first + toMark, planes);
        runs.push_back({first, 1, end - first});
    }
    return runs;
}

void StackDrawer::create() {
    frameBlock_ = gl::Buffer::make("frame block");
    outlineBlock_ = gl::Buffer::make("plane outlines");
    polygons_ = gl::Buffer::make("unit polygons");
    vertices_ = gl::VertexArray::make("unit polygons");
    const std::vector<glm::vec2> vertices = unitPolygons();
    gl::BindVertexArray(vertices_.id());
    gl::BindBuffer(GL_ARRAY_BUFFER, polygons_.id());
    gl::BufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(vertices.size() * sizeof(glm::vec2)),
                   vertices.data(), GL_STATIC_DRAW);
    gl::EnableVertexAttribArray(0);
    gl::VertexAttribPointer(0, 2, GL_FLOAT, GL_FALSE, 0, nullptr);
}

void StackDrawer::connect(const gl::Program& program) {
    const struct {
        const char* name;
        GLuint binding;
    } blocks[] = {{"FrameBlock", kFrameBinding}, {"OutlineBlock", kOutlineBinding}};
    for (const auto& block : blocks) {
        const GLuint index = gl::GetUniformBlockIndex(program.id(), block.name);
        if (index != GL_INVALID_INDEX) {
            gl::UniformBlockBinding(program.id(), index, block.binding);
        }
    }
    program.use();
    for (std::size_t unit = 0; unit < kSamplerNames.size(); ++unit) {
        gl::Uniform1i(program.uniform(kSamplerNames[unit]), static_cast<GLint>(unit));
    }
}

void StackDrawer::begin(FrameBlock block, const ProxyStack& stack, const Frustum& frustum,
                        bool tight) {
    const int planes = static_cast<int>(stack.outlines.size());
    const int planesPerOutline = std::max(1, (planes + kMaxOutlines - 1) / kMaxOutlines);
    std::vector<glm::vec4> outlines;
    outlines.reserve(kMaxOutlines);
    const glm::dvec2 low(frustum.left, frustum.bottom);
    const glm::dvec2 high(frustum.right, frustum.top);
    const glm::dvec2 halfView = (high - low) / 2.0;
    for (const Outline& o : grouped(stack, planesPerOutline)) {
        outlines.push_back(glm::vec4(
            glm::dvec4((o.centre - (low + high) / 2.0) / halfView, o.halfSize / halfView)));
    }
    outlines.resize(kMaxOutlines); // the block's declared size must be backed
    block.counts = {stack.firstPlane, block.counts.y, planesPerOutline, 0};

    uploadBlock(kFrameBinding, frameBlock_, &block, sizeof block);
    uploadBlock(kOutlineBinding, outlineBlock_, outlines.data(),
                outlines.size() * sizeof(glm::vec4));
    square_ = tight || planesPerOutline > 1;
}

void StackDrawer::draw(const gl::Program& program, const PlaneRun& run) const {
    program.use();
    gl::Uniform2i(program.uniform("planeRun"), run.first, run.step);
    gl::BindVertexArray(vertices_.id());
    gl::DrawArraysInstanced(GL_TRIANGLE_FAN, square_ ? kCorners : 0, square_ ? 4 : kCorners,
                            run.count);
}

void StackDrawer::forget() {
    for (gl::Buffer* buffer : {&polygons_, &frameBlock_, &outlineBlock_}) {
        buffer->forget();
    }
    vertices_.forget();
}

} // namespace slabcast
