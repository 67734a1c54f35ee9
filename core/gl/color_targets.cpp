#include "core/gl/color_targets.h"

#include <algorithm>

#include "core/gl/api.h"
#include "core/gl/state_guard.h"

namespace slabcast::gl {

namespace {

int bytesPerPixel(GLenum format) {
    switch (format) {
    case GL_DEPTH_COMPONENT16:
        return 2;
    case GL_RGBA8:
        return 4;
    case GL_RGBA16F:
        return 8;
    default:
        return 16;
    }
}

} // namespace

bool ColorTargets::is(int width, int height, std::span<const GLenum> formats) const {
    return framebuffer_ && width == width_ && height == height_ &&
           std::equal(formats.begin(), formats.end(), formats_.begin(), formats_.end());
}

Result<void> ColorTargets::resize(int width, int height, std::span<const GLenum> formats) {
    if (is(width, height, formats)) {
        return {};
    }
    textures_.clear();
    framebuffer_ = Framebuffer::make("color targets");
    BindFramebuffer(GL_FRAMEBUFFER, framebuffer_.id());
    std::vector<GLenum> attachments;
    for (const GLenum format : formats) {
        const bool isDepth = format == GL_DEPTH_COMPONENT16;
        const GLenum attachment =
            isDepth ? GL_DEPTH_ATTACHMENT
                    : GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(attachments.size());
        textures_.push_back(Texture::make("color target", GL_TEXTURE_2D));
        BindTexture(GL_TEXTURE_2D, textures_.back().id());
        TexStorage2D(GL_TEXTURE_2D, 1, format, width, height);
        TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
        TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
        FramebufferTexture2D(GL_FRAMEBUFFER, attachment, GL_TEXTURE_2D, textures_.back().id(), 0);
        if (!isDepth) {
            attachments.push_back(attachment);
        }
    }
    DrawBuffers(static_cast<GLsizei>(attachments.size()), attachments.data());
    width_ = width;
    height_ = height;
    formats_.assign(formats.begin(), formats.end());
    if (CheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
        framebuffer_.release();
        return fail(ErrorCode::DeviceOutOfMemory,
                    "a color target of " + std::to_string(width) + "x" + std::to_string(height) +
                        " pixels cannot be drawn into on this device: draw smaller");
    }
    return {};
}

void ColorTargets::begin(glm::vec4 color) const {
    Viewport(0, 0, width_, height_);
    clear(color);
}

void ColorTargets::clear(glm::vec4 color) const {
    BindFramebuffer(GL_FRAMEBUFFER, framebuffer_.id());
    for (std::size_t k = 0; k < textures_.size(); ++k) {
        if (formats_[k] == GL_DEPTH_COMPONENT16) {
            const GLfloat farthest = 1.0F;
            DepthMask(GL_TRUE);
            ClearBufferfv(GL_DEPTH, 0, &farthest);
        } else {
            ClearBufferfv(GL_COLOR, static_cast<GLint>(k), &color.x);
        }
    }
}

void ColorTargets::dropDepth() const {
    if (hasDepth()) {
        const GLenum depth = GL_DEPTH_ATTACHMENT;
        InvalidateFramebuffer(GL_FRAMEBUFFER, 1, &depth);
    }
}

std::vector<glm::vec4> ColorTargets::read(std::size_t index) const {
    BindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer_.id());
    ReadBuffer(GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(index));
    StateGuard::usePlainPacking();
    std::vector<glm::vec4> pixels(static_cast<std::size_t>(width_) * height_);
    if (formats_[index] != GL_RGBA8) {
        ReadPixels(0, 0, width_, height_, GL_RGBA, GL_FLOAT, pixels.data());
        return pixels;
    }
    std::vector<glm::u8vec4> bytes(pixels.size());
    ReadPixels(0, 0, width_, height_, GL_RGBA, GL_UNSIGNED_BYTE, bytes.data());
    std::transform(bytes.begin(), bytes.end(), pixels.begin(),
                   [](glm::u8vec4 b) { return glm::vec4(b) / 255.0F; });
    return pixels;
}

std::int64_t ColorTargets::bytes() const {
    std::int64_t perPixel = 0;
    for (const GLenum format : formats_) {
        perPixel += bytesPerPixel(format);
    }
    return framebuffer_ ? perPixel * width_ * height_ : 0;
}

void ColorTargets::forget() {
    for (Texture& texture : textures_) {
        texture.forget();
    }
    framebuffer_.forget();
    *this = ColorTargets();
}

} // namespace slabcast::gl
