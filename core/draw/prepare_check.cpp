#include "core/draw/prepare_check.h"

#include <optional>
#include <string>

namespace slabcast {

namespace {

Result<void> refused(std::string why) {
    return fail(ErrorCode::InvalidArgument, std::move(why));
}

/// The plan's variant says how texels are classified, lit and blended, and how the skip structure's
/// texture is read.
Result<void> checkProvided(const FramePlan& plan, const Needs& provided) {
    if (plan.variant.classification != provided.classification || plan.space != provided.space ||
        (plan.variant.shaded && !provided.shaded) ||
        (plan.variant.normals == Normals::Baked && !provided.normals)) {
        return refused("the plan is of another classification, shading or space than what was "
                       "provided: provide what the plan needs, then plan anew");
    }
    const SkipOptions& built = provided.skip;
    if (plan.skip != SkipStructure::None &&
        (plan.skip != built.structure || plan.variant.skip != formOf(built))) {
        return refused(std::string("the plan skips by ") + name(plan.skip) +
                       ", and what serves is " + name(built.structure) + ": plan anew");
    }
    if (plan.tighten && built.structure == SkipStructure::None) {
        return refused("the plan tightens its planes, and no structure is there to tighten them "
                       "around: provide what the plan needs, then plan anew");
    }
    return {};
}

} // namespace

Result<void> checkPlan(const FramePlan& plan, const Scene& scene) {
    const std::optional<Needs> provided = scene.provided();
    if (!provided) {
        return refused("nothing was provided for the scene's look: Scene::provide() what the plan "
                       "needs, then plan anew");
    }
    if (plan.look != scene.lookGeneration()) {
        return refused("the plan was made for another look or another scene: plan anew after every "
                       "change of either");
    }
    return plan.drawsNothing ? Result<void>{} : checkProvided(plan, *provided);
}

Result<void> checkViews(std::span<const ViewTarget> views) {
    for (std::size_t i = 0; i < views.size(); ++i) {
        const Viewport& v = views[i].viewport;
        if (v.width <= 0 || v.height <= 0) {
            continue; // a window made small
        }
        if (Result<void> ok = check(views[i].view); !ok) {
            return refused("view " + std::to_string(i) + ": " + ok.error().detail);
        }
        const std::optional<TargetLayer>& to = views[i].layer;
        if (to && (to->texture == 0 || to->layer < 0 || to->level < 0)) {
            return refused(
                "view " + std::to_string(i) +
                ": its layer is none: give a texture's name, and layer and level from 0");
        }
    }
    return {};
}

} // namespace slabcast
