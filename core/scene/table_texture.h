#pragma once

#include <array>

#include "core/gl/caps.h"
#include "core/gl/texture_upload.h"
#include "core/scene/scene.h"

namespace slabcast {

/// A TF's table on the GPU. While a scene is edited, a few textures take turns: a new table goes
/// into one that no frame in flight reads, and nothing is allocated once each of them was as long
/// as any table. Tested by: host_cost_gl_test.cpp
class TableTexture {
public:
    /// Uploads the scene's table. Fails: InvalidArgument (no size that the device takes),
    /// DeviceOutOfMemory.
    Result<void> fill(const Scene& scene, const gl::Caps& caps);

    GLuint id() const { return slots_[current_].texture.id(); }
    std::int64_t bytes() const;
    void release();
    void forget();

private:
    /// Frames that a driver may have in flight, and one more.
    static constexpr std::size_t kTurns = 3;
    struct Slot {
        gl::Texture texture;
        TexelLayout layout{};
        glm::ivec2 size{0};
    };
    std::array<Slot, kTurns> slots_;
    std::size_t current_ = 0;
};

} // namespace slabcast
