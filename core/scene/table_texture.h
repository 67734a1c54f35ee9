#pragma once

#include <array>
#include <vector>

#include "core/gl/caps.h"
#include "core/gl/texture_upload.h"
#include "core/scene/scene.h"
#include "core/scene/volume_texture.h"

namespace slabcast {

/// A TF's table on the GPU. While a scene is edited, a few textures take turns: a new table goes
/// into one that no frame in flight reads, and nothing is allocated once each of them was as long
/// as any table. Tested by: host_cost_gl_test.cpp
class TableTexture {
public:
    /// What the texture is made of, beside the scene's table.
    struct Content {
        bool filtered = false;    // read through the device's filter
        double bakedLengthMm = 0; // of the layers whose opacity it holds; 0: it holds extinction

        bool operator==(const Content&) const = default;
    };

    /// Uploads the scene's table. Fails: InvalidArgument (no size that the device takes),
    /// DeviceOutOfMemory. Contract: of a pre-integrated table its content is the default.
    Result<void> fill(const Scene& scene, const Content& content, const gl::Caps& caps);
    /// Texels of a row.
    int width() const { return slots_[current_].size.x; }

    GLuint id() const { return slots_[current_].texture.id(); }
    std::int64_t bytes() const;
    void release();
    void forget();

private:
    TableTexels texelsOf(const Scene& scene, const Content& content, const gl::Caps& caps);

    /// Frames that a driver may have in flight, and one more.
    static constexpr std::size_t kTurns = 3;
    struct Slot {
        gl::Texture texture;
        TexelLayout layout{};
        glm::ivec2 size{0};
    };
    std::array<Slot, kTurns> slots_;
    std::vector<glm::vec4> row_; // what is uploaded, where that is not the scene's own
    std::size_t current_ = 0;
};

} // namespace slabcast
