#pragma once

#include "core/frame/frame_plan.h"
#include "core/frame/scene.h"
#include "core/gl/caps.h"
#include "core/gl/objects.h"

namespace slabcast {

/// A scene's textures: made from the host's copy when a plan first needs them, released when it no
/// longer does.
class GpuScene {
public:
    /// Fails: DeviceOutOfMemory, VolumeTooLarge.
    Result<void> update(const Scene& scene, const FramePlan& plan, const gl::Caps& caps);

    /// Whether the textures are those of this scene, its look and this plan.
    bool serve(const Scene& scene, const FramePlan& plan) const;

    /// Texture units: 0 the volume (scalars or pre-classified), 1 the table, 2 the skip structure.
    void bind() const;

    std::int64_t volumeBytes() const { return volumeBytes_; }
    std::int64_t skipBytes() const { return skipBytes_; }
    std::int64_t tableBytes() const { return tableBytes_; }

    void forget();

private:
    /// Generations of what the textures were made from, or are needed from; 0: nothing.
    /// volume: the scene's texels or, as colours, its look.
    struct Sources {
        int volume = 0;
        int table = 0;
        int skip = 0;
        bool operator==(const Sources&) const = default;
    };
    static Sources needs(const Scene& scene, const FramePlan& plan);

    Result<void> updateTable(const Scene& scene, const gl::Caps& caps);
    Result<void> updateVolume(const Scene& scene, bool pre, const gl::Caps& caps);

    Sources held_;
    gl::Texture volume_, table_, skip_;
    std::int64_t volumeBytes_ = 0;
    std::int64_t skipBytes_ = 0;
    std::int64_t tableBytes_ = 0;
};

} // namespace slabcast
