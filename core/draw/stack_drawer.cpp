#include "core/draw/stack_drawer.h"

#include <algorithm>
#include <cmath>
#include <cstring>
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

/// What any device takes as the offset of a bound range.
constexpr std::size_t kRangeAlignment = 256;

constexpr std::size_t aligned(std::size_t bytes) {
    return (bytes + kRangeAlignment - 1) / kRangeAlignment * kRangeAlignment;
}

// A view's place in the buffer. The blocks' declared sizes must be backed.
constexpr std::size_t kOutlinesAt = aligned(sizeof(FrameBlock));
constexpr std::size_t kOutlineBytes = kMaxOutlines * sizeof(glm::vec4);
constexpr std::size_t kViewBytes = kOutlinesAt + aligned(kOutlineBytes);

} // namespace

PlaneRuns::PlaneRuns(BlendOrder order, const StackShape& stack, int planesPerRun)
    : order_(order), stack_(stack), planesPerRun_(planesPerRun) {}

bool PlaneRuns::next(PlaneRun& run) {
    if (begun_ >= stack_.planes) {
        return false;
    }
    if (order_ == BlendOrder::BackToFront) {
        run = {stack_.planes - 1, -1, stack_.planes};
        begun_ = stack_.planes;
        return true;
    }
    const int toMark = planesPerRun_ > 0
                           ? planesPerRun_ - (stack_.firstPlane + begun_) % planesPerRun_
                           : stack_.planes;
    const int end = std::min(begun_ + toMark, stack_.planes);
    run = {begun_, 1, end - begun_};
    begun_ = end;
    return true;
}

void StackDrawer::create() {
    blocks_ = gl::Buffer::make("frame blocks and plane outlines");
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
    (void)program.uniform("planeRun"); // draw() asks GL nothing
    program.use();
    for (std::size_t unit = 0; unit < kSamplerNames.size(); ++unit) {
        gl::Uniform1i(program.uniform(kSamplerNames[unit]), static_cast<GLint>(unit));
    }
}

void StackDrawer::reserve(std::size_t views) {
    staged_.resize(std::max(staged_.size(), views * kViewBytes));
    shapes_.resize(std::max(shapes_.size(), views));
}

void StackDrawer::stage(std::size_t view, FrameBlock block, const ProxyStack& stack,
                        const Frustum& frustum, bool tight) {
    SLABCAST_EXPECTS(view < shapes_.size(), view);
    const int planes = static_cast<int>(stack.outlines.size());
    const int planesPerOutline = std::max(1, (planes + kMaxOutlines - 1) / kMaxOutlines);
    block.counts = {stack.firstPlane, block.counts.y, planesPerOutline, 0};
    std::byte* const place = staged_.data() + view * kViewBytes;
    std::memcpy(place, &block, sizeof block);

    const glm::dvec2 low(frustum.left, frustum.bottom);
    const glm::dvec2 high(frustum.right, frustum.top);
    const glm::dvec2 halfView = (high - low) / 2.0;
    const int outlines = (planes + planesPerOutline - 1) / planesPerOutline;
    for (int k = 0; k < outlines; ++k) {
        const Outline o = joined(group(stack, static_cast<std::size_t>(k), planesPerOutline));
        const glm::vec4 inView(
            glm::dvec4((o.centre - (low + high) / 2.0) / halfView, o.halfSize / halfView));
        std::memcpy(place + kOutlinesAt + k * sizeof inView, &inView, sizeof inView);
    }
    shapes_[view] = {stack.firstPlane, planes, tight || planesPerOutline > 1};
}

// New storage every time: the driver keeps the old one until the GPU has read it, nothing waits.
void StackDrawer::upload(std::size_t views) const {
    gl::BindBuffer(GL_UNIFORM_BUFFER, blocks_.id());
    gl::BufferData(GL_UNIFORM_BUFFER, static_cast<GLsizeiptr>(views * kViewBytes), staged_.data(),
                   GL_STREAM_DRAW);
}

const StackShape& StackDrawer::begin(std::size_t view) const {
    const std::size_t at = view * kViewBytes;
    gl::BindBufferRange(GL_UNIFORM_BUFFER, kFrameBinding, blocks_.id(), static_cast<GLintptr>(at),
                        sizeof(FrameBlock));
    gl::BindBufferRange(GL_UNIFORM_BUFFER, kOutlineBinding, blocks_.id(),
                        static_cast<GLintptr>(at + kOutlinesAt), kOutlineBytes);
    return shapes_[view];
}

void StackDrawer::useVertices() const {
    gl::BindVertexArray(vertices_.id());
}

void StackDrawer::draw(const gl::Program& program, const StackShape& stack,
                       const PlaneRun& run) const {
    gl::Uniform2i(program.uniform("planeRun"), run.first, run.step);
    gl::DrawArraysInstanced(GL_TRIANGLE_FAN, stack.square ? kCorners : 0,
                            stack.square ? 4 : kCorners, run.count);
}

std::int64_t StackDrawer::bytes() const {
    return static_cast<std::int64_t>(staged_.size());
}

void StackDrawer::forget() {
    polygons_.forget();
    blocks_.forget();
    vertices_.forget();
}

} // namespace slabcast
