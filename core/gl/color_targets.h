#pragma once

#include <cstdint>
#include <initializer_list>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "core/base/error.h"
#include "core/gl/objects.h"

namespace slabcast::gl {

/// A framebuffer with textures of its own: layers in between, counters, pictures that are read
/// back. Tested by: renderer_gl_test.cpp
class ColorTargets {
public:
    /// One texture per format: GL_RGBA8, GL_RGBA16F or GL_RGBA32F, and GL_DEPTH_COMPONENT16 as the
    /// last, if any. Does nothing where size and formats are the same. Leaves the framebuffer
    /// bound. Fails: DeviceOutOfMemory (the framebuffer is not complete).
    Result<void> resize(int width, int height, std::span<const GLenum> formats);
    Result<void> resize(int width, int height, std::initializer_list<GLenum> formats) {
        return resize(width, height, std::span(formats.begin(), formats.size()));
    }
    /// Whether resize() would do nothing.
    bool is(int width, int height, std::span<const GLenum> formats) const;

    /// Makes it the draw framebuffer with its whole size as viewport, every texture filled with
    /// `color`, depth with 1. Leaves the depth mask on where there is depth.
    void begin(glm::vec4 color = glm::vec4(0.0F)) const;
    /// The same with the viewport as it is, for who sets one.
    void clear(glm::vec4 color = glm::vec4(0.0F)) const;

    /// Depth is not needed any more: a tiler then has nothing of it to store. Contract: it is the
    /// draw framebuffer. Does nothing where there is none.
    void dropDepth() const;

    /// Waits for the GPU and reads one texture, rows from the bottom up. 8-bit values come as
    /// k/255.
    std::vector<glm::vec4> read(std::size_t index = 0) const;

    int width() const { return width_; }
    int height() const { return height_; }
    GLuint framebuffer() const { return framebuffer_.id(); }
    GLuint texture(std::size_t index) const { return textures_[index].id(); }
    /// Whether a picture of this size and first format fits, with depth beside it where asked.
    bool holds(int width, int height, GLenum format, bool depth) const {
        return framebuffer_ && width <= width_ && height <= height_ && formats_.front() == format &&
               (hasDepth() || !depth);
    }
    bool hasDepth() const { return !formats_.empty() && formats_.back() == GL_DEPTH_COMPONENT16; }
    GLuint depth() const { return textures_.back().id(); } // contract: there is one
    std::int64_t bytes() const;
    void forget(); // contextLost

private:
    int width_ = 0;
    int height_ = 0;
    std::vector<GLenum> formats_;
    std::vector<Texture> textures_;
    Framebuffer framebuffer_;
};

} // namespace slabcast::gl
