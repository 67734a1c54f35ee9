#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/plan/frame_plan.h"
#include "core/scene/device.h"
#include "core/skip/live_options.h"
#include "core/transfer/shading.h"
#include "core/transfer/transfer_function.h"
#include "core/volume/texels.h"

namespace slabcast {

struct BuiltSkip;
struct ClassifiedTexels;
class LiveSkip;
struct NormalTexels;
struct PreintegratedTable;
struct SkipSource;

/// What a volume is made of for the eye. How it is classified, composited and skipped through, and
/// whether it is lit, is asked for by Settings and built by provide().
struct Look {
    TransferFunction tf;
    ShadingParameters shading; // where it is lit; without a gradient floor a usual one is taken
    glm::dvec3 bakedLightDirection{
        0.0, -1.0, 0.0}; // patient space, towards the light; for pre-classified texels
};

/// A volume under a transfer function, on the host: what the renderer's textures are made from and
/// can be made from again. No GL. Not thread-safe; heavy steps use all cores inside. Copies share
/// the texels and may have looks of their own. Its life: create, setLook(), provide() what a plan
/// needs, draw; then any of the three again. Tested by: scene_test.cpp, scene_gl_test.cpp
class Scene {
public:
    Scene(); // of no volume: to be assigned to
    Scene(const Scene& other);
    Scene(Scene&&) noexcept;
    Scene& operator=(const Scene& other);
    Scene& operator=(Scene&&) noexcept;
    ~Scene();

    /// Turns the voxels into texels and lets the voxels go: in their own memory where texels are as
    /// long, else the peak is volume + texels. `statistics`: the volume's.
    /// Fails: InvalidArgument (a table of fewer than 4 texels). Contract: the volume is
    /// validated().
    static Result<Scene> create(Volume volume, const VolumeStatistics& statistics,
                                const TextureChoice& choice);
    static Result<Scene> create(Volume volume, const TextureChoice& choice);
    /// The same of a volume that nobody has validated yet, as the device likes its texels best.
    /// `exact`: interpolated in float32 by the shader. Fails: as validated() also.
    static Result<Scene> create(Volume volume, const Device& device, bool exact = false);

    /// Replaces the look; what was provided under the last one is dropped. Cost: O(points).
    /// Fails: InvalidTransferFunction, InvalidArgument (shading or light that are no numbers); then
    /// nothing has changed.
    Result<void> setLook(Look look);

    /// Builds what a plan needs under the look of now: the table or the classified texels, and the
    /// skip structure, on the CPU (Renderer::provide() also on the GPU). What is there already is
    /// kept, what is not needed is dropped. Cost: O(voxels) where texels or a structure are built.
    /// Fails: InvalidArgument (skip options; no look was set; the texels were let go), and as the
    /// structure's builder; then nothing skips, and all else is provided.
    Result<void> provide(const Needs& needs);
    /// Whether provide() would find all of it there.
    bool provides(const Needs& needs) const;
    /// What was provided last, with the structure that serves; nothing after setLook().
    std::optional<Needs> provided() const;

    /// The same look with what `build` makes of its texels for a skip structure. Fails: as `build`,
    /// and as provide(). Contract: all else was provided.
    using SkipBuild = std::function<Result<BuiltSkip>(const SkipSource& source)>;
    Result<void> buildSkip(const SkipBuild& build);

    /// Lets go of codes that structures are built from, 2 bytes a voxel; of 8-bit volumes they are
    /// the texels. Made again, in one pass, when the next one is built.
    void releaseCodes();
    /// Lets go of the texels on the host, once a renderer has prepared them: drawing goes on, and
    /// so do other looks. What is made from them then fails with InvalidArgument: pre-classified
    /// texels, structures where the codes are gone too, and textures, so that after a lost context
    /// (Renderer::contextLost()) a new scene must be created. Copies of this scene keep theirs.
    void releaseTexels();

    /// Of what was provided. Where nothing was, geometry alone: a plan made from it says what it
    /// needs, and is not to be drawn with.
    SceneFacts facts() const;

    const std::string& name() const;
    const VolumeGeometry& geometry() const;
    const VolumeStatistics& statistics() const;
    const Look& look() const;

    // What the renderer reads.
    const Texels& texels() const; // without data after releaseTexels()
    /// By one value; of a pre-integrated look what its table holds for front and back alike.
    const TransferTable& table() const;
    const ClassifiedTexels* classified() const;      // nothing of other classifications
    const PreintegratedTable* preintegrated() const; // nothing of other classifications
    const NormalTexels* normals() const;             // nothing unless they were asked for
    const BuiltSkip& skip() const;                   // that serves
    const LiveSkip* live() const;                    // nothing where it is not edited (LiveScene)
    /// Those whose textures are to be kept: skip(), and while editing what it takes turns with.
    std::vector<const BuiltSkip*> residentSkips() const;
    /// Numbers that no other texels and no other look of this process have: textures made from
    /// others are stale.
    int texelsGeneration() const;
    int lookGeneration() const;
    int normalsGeneration() const;
    /// Gradient magnitude below which shading fades where the look does not say: 0.5 % of the
    /// data's range per voxel.
    double defaultGradientFloorPerMm() const;

private:
    friend class LiveScene;

    Result<void> startEditing(const LiveOptions& options);
    Result<void> edit(TransferFunction tf);
    LiveProgress work(double budgetMs);
    void stopEditing();
    std::vector<Scene> withEachServing() const;

    struct State;
    explicit Scene(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

} // namespace slabcast
