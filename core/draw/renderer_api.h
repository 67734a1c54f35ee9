#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/gl/caps.h"
#include "core/gl/host_state.h"
#include "core/plan/frame_plan.h"
#include "core/scene/live_scene.h"
#include "core/scene/scene_api.h"
#include "core/view/view.h"

namespace slabcast {

namespace gl {
struct ActiveResources;
}

/// How the caller's framebuffer holds colour. Encoded: sRGB-encoded values, stored as they are
/// written (an ordinary RGBA8). Linear: light (a float target). SrgbFormat: an sRGB format, which
/// encodes at every blend.
enum class TargetEncoding : std::uint8_t { Encoded, Linear, SrgbFormat };

/// One layer of a texture of the caller's, as headsets hand out their eyes. Of a 2D array or 3D
/// texture, in a format that is drawn into. Only names it: draw() holds on to no texture.
struct TargetLayer {
    unsigned texture = 0; // GL name
    int layer = 0;        // from 0
    int level = 0;        // of its mipmaps
};

/// One view's place in a framebuffer of the caller's, or in a layer, without a framebuffer of the
/// caller's. What is there stays, seen through the volume.
struct ViewTarget {
    View view;
    unsigned framebuffer = 0; // GL name; not read where there is a layer
    Viewport viewport;
    TargetEncoding encoding = TargetEncoding::Encoded;
    std::optional<TargetLayer> layer;
};

/// Work of one pixel or of a frame. Fragments are those that are shaded: not those that a mark of
/// saturation rejects before. A fetch is one texel address given to a texture unit (filtered or
/// not). A layer is skipped that lies inside the box, on a plane that is shaded, and is not
/// evaluated: invisible, or behind opaque material. A stretch is one look at the skip structure,
/// free or not; a block is visited where it is not.
template <class Number>
struct Work {
    Number fragments = 0;
    Number layersEvaluated = 0;
    Number layersSkipped = 0;
    Number volumeFetches = 0;
    Number skipFetches = 0;
    Number stretches = 0;
    Number blocksVisited = 0;

    template <class Other>
    Work& operator+=(const Work<Other>& other) {
        fragments += static_cast<Number>(other.fragments);
        layersEvaluated += static_cast<Number>(other.layersEvaluated);
        layersSkipped += static_cast<Number>(other.layersSkipped);
        volumeFetches += static_cast<Number>(other.volumeFetches);
        skipFetches += static_cast<Number>(other.skipFetches);
        stretches += static_cast<Number>(other.stretches);
        blocksVisited += static_cast<Number>(other.blocksVisited);
        return *this;
    }
};
using WorkCounters = Work<std::int64_t>;
using PixelWork = Work<float>; // exact: float32 counts to 2^24

/// Bytes of what the renderer keeps on the GPU.
struct GpuMemory {
    std::int64_t volumeBytes = 0;
    std::int64_t skipBytes = 0;
    std::int64_t otherBytes = 0; // table, outlines, layers of our own
};

/// Draws scenes. One GL context, one thread: every call needs the context current.
/// prepare() may compile and upload, and so may take long; draw() only records GL commands and
/// never waits. Tested by: renderer_gl_test.cpp, renderer_work_gl_test.cpp, views_gl_test.cpp
class Renderer {
public:
    /// Fails: ShaderCompile. Thread: the device's context is current.
    /// `hostState`: what every call of this renderer does with the GL state that it finds; what is
    /// said of restoring it below holds for HostState::Restore.
    static Result<Renderer> create(const Device& device, HostState hostState = HostState::Restore);
    /// For measuring alone: what the programs that it makes do otherwise.
    static Result<Renderer> create(const Device& device, const MeasuringText& measuring,
                                   HostState hostState = HostState::Restore);
    Renderer(Renderer&&) noexcept;
    Renderer& operator=(Renderer&&) noexcept;
    ~Renderer();

    /// Scene::provide(), with the skip structure built on the GPU where the needs and the device
    /// have it so: in a fraction of the time, texel by texel the same. Where the device cannot, one
    /// line goes to its log and the CPU builds. Restores the GL state (gl::StateGuard). Fails: as
    /// Scene::provide() and buildSkip(), but for DeviceUnsupported.
    Result<void> provide(Scene& scene, const Needs& needs);

    /// All that precedes prepare(): provides what the settings need and decides the plan from what
    /// was found, such as how much is visible. The same in steps: needsOf(), provide(),
    /// measureRatios() where the device shall be tuned to, slabcast::plan(). Fails: as those.
    Result<FramePlan> plan(Scene& scene, const Settings& settings,
                           std::span<const RatioMeasurement> measurements = {});

    /// The plan of a scene that is edited: it has what it needs.
    Result<FramePlan> plan(const LiveScene& scene, const Settings& settings,
                           std::span<const RatioMeasurement> measurements = {}) const;

    /// Builds the look's skip structure on the GPU, in place of what the scene has; waits for the
    /// host's copy of it. Restores the GL state (gl::StateGuard). Fails: DeviceUnsupported where
    /// the device lacks the capacity, and as buildSkipOnGpu(): Scene::provide() builds on the CPU.
    Result<void> buildSkip(Scene& scene, const SkipOptions& options);

    /// Brings all that draw() needs up to date with scene, plan and views: textures, shaders, a
    /// layer of our own as large as the largest view, the boxes that planes are tightened around.
    /// Nothing is done for what is there already; textures that the plan does not use are released
    /// (all, where it draws nothing; while the scene is edited, what the next TF may need stays),
    /// compiled shaders are kept. Of the views, sizes, encodings, frusta, whether they are layers
    /// and whether an eye is within two radii of the volume's middle count, not which or where they
    /// look (without views: any eye). Accepts exactly what draw() can draw. Restores the GL state
    /// (gl::StateGuard). Fails: InvalidArgument (a plan made for another look, or for other things
    /// than were provided since; a view that check() refuses; textures to be made from texels that
    /// were let go), DeviceOutOfMemory, VolumeTooLarge, ShaderCompile.
    Result<void> prepare(const Scene& scene, const FramePlan& plan,
                         std::span<const ViewTarget> views);

    /// Blends the volume over what each target holds, as premultiplied colour. One instanced draw
    /// per view, or one between marks of saturation; a layer of our own in between only where
    /// planes are drawn front to back or the target's encoding is not the compositing space. With
    /// termination, colour and opacity are off by at most what the termination opacity lacks of 1,
    /// in either order, beside the rounding of each plane's blending. Restores the GL state that
    /// gl::StateGuard documents. The last prepare() must have been for this scene, its look and
    /// this plan, or one that uses the same textures. Views may look elsewhere than those prepared,
    /// and be other layers: one costs two GL calls. Contract: a target's framebuffer is complete.
    /// Fails: InvalidArgument (scene or plan are others; a view is larger or wider than those
    /// prepared, or encoded otherwise, or one that check() refuses); then nothing was drawn.
    Result<void> draw(const Scene& scene, const FramePlan& plan, std::span<const ViewTarget> views);

    /// Draws the same frame once more, counting instead of colouring, and waits for the sums.
    /// Fails: DeviceUnsupported where float32 targets do not blend (GL_EXT_float_blend).
    Result<WorkCounters> countWork(const Scene& scene, const FramePlan& plan,
                                   std::span<const ViewTarget> views);
    /// The same of one view, pixel by pixel of its viewport, rows from the bottom up.
    Result<std::vector<PixelWork>> workPerPixel(const Scene& scene, const FramePlan& plan,
                                                const ViewTarget& target);

    /// Time that compiling the plan's variant took; 0 before prepare().
    double compileMs(const ShaderVariant& variant) const;
    /// What the variant's program uses, by the driver's account; nothing before prepare().
    gl::ActiveResources resources(const ShaderVariant& variant) const;
    GpuMemory gpuMemory() const;

    /// The context is gone: drops all names without a GL call. prepare() makes everything again.
    void contextLost();

private:
    struct State;
    explicit Renderer(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

} // namespace slabcast
