#pragma once

#include "core/scene/scene_api.h"

namespace slabcast {

/// A scene whose transfer function (TF) may change in every frame; drawn as any scene. Two skip
/// structures take turns (core/skip/live_skip.h): one that is right under every TF, and one that
/// skips more, is right for one TF and is rebuilt once the TF rests. Every picture is exact.
/// Not thread-safe; no GL. Tested by: live_editing_gl_test.cpp
class LiveScene {
public:
    /// Takes over a scene, with the look and all else that was provided, and builds what is right
    /// under any TF. Cost: O(voxels). Fails: InvalidArgument (nothing was provided; pre-classified:
    /// the texels hold the TF), and as LiveSkip::start().
    static Result<LiveScene> start(Scene scene, const LiveOptions& options = {});

    /// The look under another TF, all else as it is. The next picture is right; plan it anew. Cost:
    /// O(codes), and that of the table. Fails: InvalidTransferFunction; then nothing has changed.
    Result<void> edit(TransferFunction tf);
    /// Once a frame: LiveSkip::work().
    LiveProgress work(double budgetMs);

    const LiveSkip& live() const { return *scene_.live(); }
    /// What is drawn: its facts change with every edit and with what serves.
    const Scene& scene() const { return scene_; }
    operator const Scene&() const { return scene_; }
    /// The scene as it is when one and the other structure serves, right under this TF or not: to
    /// ready a renderer for both.
    std::vector<Scene> withEachServing() const;

    /// The scene with what skips now, and nothing else.
    Scene stop() &&;

private:
    explicit LiveScene(Scene scene) : scene_(std::move(scene)) {}

    Scene scene_;
};

} // namespace slabcast
