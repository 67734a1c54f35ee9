#pragma once

#include <array>
#include <span>
#include <vector>

#include "core/gl/caps.h"
#include "core/gl/objects.h"
#include "core/gl/state_guard.h"
#include "core/plan/frame_plan.h"
#include "core/scene/scene.h"
#include "core/scene/table_texture.h"
#include "core/skip/gpu/skip_texture.h"

namespace slabcast {

/// A scene's textures: made from the host's copy when a plan first needs them, released when it no
/// longer does. While the scene is edited, what the next TF may need again stays.
class GpuScene {
public:
    /// Touches `state`, and calls GL, only where there is something to do. Fails:
    /// DeviceOutOfMemory, VolumeTooLarge.
    Result<void> update(const Scene& scene, const FramePlan& plan, const gl::Caps& caps,
                        gl::StateScope& state);

    /// The volume's texture alone, scalars or pre-classified, for who builds from it; owned here.
    /// Fails: as update().
    Result<GLuint> volumeTexture(const Scene& scene, bool pre, const gl::Caps& caps,
                                 gl::StateScope& state);
    /// The texture of a structure that was built on the GPU, in place of those that were held.
    void adopt(const BuiltSkip& skip, SkipTexture texture);

    /// Whether the textures are those of this scene, its look and this plan.
    bool serve(const Scene& scene, const FramePlan& plan) const;

    /// Each to its unit of core/plan/shader_resources.h; the skip structure where it was uploaded.
    void bind(const BuiltSkip& skip) const;
    int tableWidth() const { return table_.width(); }

    std::int64_t volumeBytes() const { return volumeBytes_ + normalsBytes_; } // with its normals
    std::int64_t skipBytes() const; // of all structures, and of spare ones
    std::int64_t tableBytes() const { return table_.bytes(); }

    void forget();

private:
    /// Generations of what the textures were made from, or are needed from; 0: nothing.
    /// volume: the scene's texels or, as colours, its look.
    struct Sources {
        int volume = 0;
        int table = 0;
        int normals = 0;
        TableTexture::Content tableContent;
        bool operator==(const Sources&) const = default;
    };
    struct HeldSkip {
        int generation = 0;
        SkipTexture texture;
        glm::ivec3 blocks{0}; // of a grid, which may be uploaded in several goes
        int slices = 0;       // of them, so far
        bool whole() const { return slices == blocks.z; }
    };
    static Sources needs(const Scene& scene, const FramePlan& plan);
    /// Structures whose textures are to be there; some may be null.
    using NeededSkips = std::array<const BuiltSkip*, 3>;
    static NeededSkips neededSkips(const Scene& scene, const FramePlan& plan);
    bool isNeeded(const HeldSkip& one, const NeededSkips& needed) const;
    bool hold(const NeededSkips& needed, bool live) const;
    HeldSkip* held(const BuiltSkip& skip);
    const HeldSkip* held(const BuiltSkip& skip) const;

    Result<void> updateVolume(const Scene& scene, bool pre, int generation, const gl::Caps& caps,
                              gl::StateScope& state);
    Result<void> updateTable(const Scene& scene, const Sources& needed, const gl::Caps& caps,
                             gl::StateScope& state);
    Result<void> updateNormals(const Scene& scene, int generation, const gl::Caps& caps,
                               gl::StateScope& state);
    Result<void> updateSkips(const Scene& scene, const FramePlan& plan, const gl::Caps& caps,
                             gl::StateScope& state);
    Result<void> needOctree(const BuiltSkip& skip, const gl::Caps& caps);
    Result<HeldSkip> emptyGrid(glm::ivec3 blocks, const gl::Caps& caps);
    Result<void> needGrid(const BuiltSkip& skip, std::int64_t mostBytes, const gl::Caps& caps);

    Sources held_;
    gl::Texture volume_;
    gl::Texture normals_;
    TableTexture table_;
    std::vector<HeldSkip> skips_;
    std::vector<HeldSkip> spares_; // of grids, longest unused first: no frame allocates anew
    std::int64_t volumeBytes_ = 0;
    std::int64_t normalsBytes_ = 0;
};

} // namespace slabcast
