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

    /// Texture units: 0 the volume (scalars or pre-classified), 1 the table, 2 the skip structure.
    void bind() const;

    std::int64_t volumeBytes() const { return volumeBytes_; }
    std::int64_t skipBytes() const { return skipBytes_; }
    std::int64_t tableBytes() const { return tableBytes_; }

    void forget();

private:
    Result<void> updateVolume(const Scene& scene, bool pre, const gl::Caps& caps);

    // What the textures were made from; -1: nothing. volume_ holds scalars or colours.
    int scalars_ = -1;
    int classifiedLook_ = -1;
    int tableLook_ = -1;
    int skipLook_ = -1;
    gl::Texture volume_, table_, skip_;
    std::int64_t volumeBytes_ = 0;
    std::int64_t skipBytes_ = 0;
    std::int64_t tableBytes_ = 0;
};

} // namespace slabcast
