#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/plan/frame_plan.h"
#include "core/skip/live_skip.h"
#include "core/transfer/preclassified.h"
#include "core/transfer/preintegrated.h"
#include "core/transfer/shading.h"
#include "core/transfer/transfer_function.h"
#include "core/volume/texels.h"

namespace slabcast {

/// How a volume shall look.
struct Look {
    TransferFunction tf;
    CompositingSpace space = CompositingSpace::Display;
    Classification classification = Classification::Post;
    std::optional<ShadingParameters> shading; // none: unlit
    glm::dvec3 bakedLightDirection{
        0.0, -1.0, 0.0}; // patient space, towards the light; for pre-classified texels
};

/// A volume under a transfer function, on the host: what the renderer's textures are made from and
/// can be made from again. No GL. Not thread-safe; heavy steps use all cores inside. Copies share
/// the texels and may have looks of their own.
class Scene {
public:
    /// Turns the voxels into texels and lets the voxels go, so that the peak is volume + texels.
    /// `filterErrorOfFullScale`: what the self-test found (TexelFormatTest::maxFilterError).
    static Scene create(Volume volume, TexelFormat format, double filterErrorOfFullScale);

    /// Replaces the look; builds the table, what pre-classification and skipping need, and nothing
    /// else. Ends editing. Fails: InvalidTransferFunction, InvalidArgument. Cost: O(voxels) where
    /// texels or a skip structure are built.
    Result<void> setLook(const Look& look, const SkipOptions& skip, int maxTableSize);

    /// The same look with what `build` makes of its texels for a skip structure. Fails: as `build`.
    using SkipBuild = std::function<Result<BuiltSkip>(const SkipSource& source)>;
    Result<void> buildSkip(const SkipBuild& build);

    /// From here on TFs may come in every frame. Builds what is right under any of them, once.
    /// Cost: O(voxels). Fails: InvalidArgument (pre-classified: the texels hold the TF), and as
    /// LiveSkip::start(). Tested by: live_editing_gl_test.cpp
    Result<void> startEditing(const LiveOptions& options = {});
    /// The look under another TF, all else as it is. The next picture is right. Cost: O(codes), and
    /// that of the table. Fails: InvalidTransferFunction; then nothing has changed. Contract:
    /// editing.
    Result<void> edit(TransferFunction tf);
    /// Once a frame: LiveSkip::work(). Contract: editing.
    LiveProgress work(double budgetMs);
    /// Keeps what skips now, and nothing else.
    void stopEditing();
    /// Nothing where the scene is not edited.
    const LiveSkip* live() const { return live_ ? &*live_ : nullptr; }
    /// The scene as it is when one and the other structure serves, right under this TF or not: to
    /// ready a renderer for both. Contract: editing.
    std::vector<Scene> withEachServing() const;

    SceneFacts facts() const;

    const std::string& name() const { return volumeName_; }
    const VolumeGeometry& geometry() const { return geometry_; }
    const VolumeStatistics& statistics() const { return statistics_; }
    const Texels& texels() const { return *texels_; }
    const Look& look() const { return look_; }
    int maxTableSize() const { return maxTableSize_; } // as it was set with the look
    /// By one value; of a pre-integrated look what its table holds for front and back alike.
    const TransferTable& table() const {
        return preintegrated_ ? preintegrated_->diagonal : table_;
    }
    const ClassifiedTexels* classified() const { return classified_ ? &*classified_ : nullptr; }
    const PreintegratedTable* preintegrated() const {
        return preintegrated_ ? &*preintegrated_ : nullptr;
    }
    const BuiltSkip& skip() const { return live_ ? live_->current() : skip_; }
    /// Those whose textures are to be kept: skip(), and while editing what it takes turns with.
    std::vector<const BuiltSkip*> residentSkips() const;
    /// Numbers that no other texels and no other look of this process have: textures made from
    /// others are stale.
    int texelsGeneration() const { return texelsGeneration_; }
    int lookGeneration() const { return lookGeneration_; }
    /// Gradient magnitude below which shading fades where the look does not say: 0.5 % of the
    /// data's range per voxel.
    double defaultGradientFloorPerMm() const;

private:
    void buildTable();
    void needCodes();
    CellVisibility visibility() const; // of scalars. Contract: their codes were made

    std::string volumeName_;
    VolumeGeometry geometry_;
    bool integerData_ = true;
    VolumeStatistics statistics_;
    std::shared_ptr<const Texels> texels_;
    double filterErrorSampled_ = 0.0;
    std::shared_ptr<const TexelCodes> codes_; // made when the first skip structure is
    Look look_;
    int maxTableSize_ = 0;
    TransferTable table_; // of no use beside a pre-integrated one
    std::optional<PreintegratedTable> preintegrated_;
    std::optional<ClassifiedTexels> classified_;
    BuiltSkip skip_; // while the scene is not edited
    std::optional<LiveSkip> live_;
    int texelsGeneration_ = 0;
    int lookGeneration_ = 0;
};

} // namespace slabcast
