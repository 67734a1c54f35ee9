#include "core/scene/live_scene.h"

#include <utility>

#include "core/scene/scene.h"

namespace slabcast {

Result<LiveScene> LiveScene::start(Scene scene, const LiveOptions& options) {
    if (!scene.provided()) {
        return fail(ErrorCode::InvalidArgument,
                    "nothing was provided for the scene's look: call Scene::provide() first");
    }
    if (Result<void> started = scene.startEditing(options); !started) {
        return tl::unexpected(started.error());
    }
    return LiveScene(std::move(scene));
}

Result<void> LiveScene::edit(TransferFunction tf) {
    return scene_.edit(std::move(tf));
}

LiveProgress LiveScene::work(double budgetMs) {
    return scene_.work(budgetMs);
}

std::vector<Scene> LiveScene::withEachServing() const {
    return scene_.withEachServing();
}

Scene LiveScene::stop() && {
    scene_.stopEditing();
    return std::move(scene_);
}

} // namespace slabcast
