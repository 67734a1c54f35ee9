#pragma once

#include <array>
#include <optional>

#include "core/gl/api.h"
#include "core/gl/host_state.h"

namespace slabcast::gl {

/// Restores the GL state that drawing a volume touches, so that a host's own renderer finds what it
/// left:
/// - program (none where the host has deleted it and left it current), vertex array, draw and read
///   framebuffer;
/// - viewport, scissor box; colour mask, clear colour; depth mask, function and range;
///   blend functions and equations;
/// - whether blend, cull face, depth test, dither, polygon offset, rasterizer discard, sample alpha
/// to coverage, sample coverage, sample mask, scissor and stencil test are enabled;
/// - array, pixel unpack and pixel pack buffer, uniform buffer (generic and indexed 0 and 1, with
/// their ranges), shader storage buffer likewise; image unit 0;
/// - pixel pack and unpack alignment, row length, image height and skips;
/// - active unit; on units 0 to 7 the 2D, 2D array and 3D texture and the sampler.
/// Makes unit 0 the active one: what binds a texture without choosing a unit binds it there.
/// Blending and the colour mask are saved of draw buffer 0 and restored to all draw buffers: a host
/// that sets them one by one (Enablei, ColorMaski, BlendFunci, BlendEquationi) must do so again.
/// Cost: about 110 glGet calls, no wait on most drivers. Tested by: state_guard_gl_test.cpp
class StateGuard {
public:
    StateGuard();
    ~StateGuard();
    StateGuard(const StateGuard&) = delete;
    StateGuard& operator=(const StateGuard&) = delete;

    /// Tightly packed pixels from client memory, whatever the host had set: before uploads.
    static void usePlainUnpacking();
    /// The same to client memory: before reads.
    static void usePlainPacking();

    static constexpr int kUnits = 8;
    static constexpr int kIndexedBuffers = 2; // of each kind
    static constexpr int kSwitches = 11;
    static constexpr int kPixelStores = 10;

private:
    struct Unit {
        GLint texture2d = 0;
        GLint texture2dArray = 0;
        GLint texture3d = 0;
        GLint sampler = 0;
    };
    struct BufferRange {
        GLint buffer = 0;
        GLint64 offset = 0;
        GLint64 size = 0;
    };
    struct Buffers {
        GLint generic = 0;
        std::array<BufferRange, kIndexedBuffers> indexed{};
    };
    struct ImageUnit {
        GLint texture = 0;
        GLint level = 0, layered = GL_FALSE, layer = 0;
        GLint access = GL_READ_ONLY, format = GL_R32UI;
    };
    struct Blend {
        GLint sourceRgb = GL_ONE, sourceAlpha = GL_ONE;
        GLint destinationRgb = GL_ZERO, destinationAlpha = GL_ZERO;
        GLint equationRgb = GL_FUNC_ADD, equationAlpha = GL_FUNC_ADD;
    };

    static Buffers buffersOf(GLenum binding, GLenum start, GLenum size);
    static void restore(GLenum target, const Buffers& buffers);
    void saveBindings();
    void restoreBindings() const;

    GLint program_ = 0;
    GLint vertexArray_ = 0;
    GLint drawFramebuffer_ = 0;
    GLint readFramebuffer_ = 0;
    GLint arrayBuffer_ = 0;
    GLint unpackBuffer_ = 0;
    GLint packBuffer_ = 0;
    GLint activeTexture_ = GL_TEXTURE0;
    std::array<GLint, 4> viewport_{};
    std::array<GLint, 4> scissor_{};
    std::array<GLfloat, 4> clearColor_{};
    std::array<GLboolean, 4> colorMask_{};
    GLboolean depthMask_ = GL_TRUE;
    GLint depthFunction_ = GL_LESS;
    std::array<GLfloat, 2> depthRange_{};
    Blend blend_;
    std::array<bool, kSwitches> switches_{};
    std::array<GLint, kPixelStores> pixelStores_{};
    Buffers uniformBuffers_;
    Buffers storageBuffers_;
    ImageUnit image_;
    std::array<Unit, kUnits> units_{};
};

/// A guard from the first change of state on, where the host wants its own back: what turns out to
/// change nothing calls no GL. Tested by: host_cost_gl_test.cpp
class StateScope {
public:
    explicit StateScope(HostState host) : restores_(host == HostState::Restore) {}

    /// Called before whatever changes state, as often as that is.
    void touch() {
        if (restores_ && !guard_) {
            guard_.emplace();
        }
    }

private:
    bool restores_;
    std::optional<StateGuard> guard_;
};

} // namespace slabcast::gl
