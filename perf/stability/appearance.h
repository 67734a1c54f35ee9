#pragma once

#include <optional>

#include "core/scene/scene.h"

namespace slabcast {

/// A look together with how it is classified, composited and lit: all that a scene of a case is
/// made of beside its volume.
struct Appearance {
    TransferFunction tf;
    CompositingSpace space = CompositingSpace::Display;
    Classification classification = Classification::Post;
    std::optional<ShadingParameters> shading; // none: unlit
    Normals normals = Normals::Computed;

    Look look() const {
        Look look;
        look.tf = tf;
        look.shading = shading.value_or(ShadingParameters{});
        return look;
    }
    Needs needs(const SkipOptions& skip) const {
        return {.classification = classification,
                .space = space,
                .shaded = shading.has_value(),
                .normals = normals == Normals::Baked,
                .skip = skip};
    }
};

/// Sets the look and provides all of it, structures built on the CPU. Fails: as the scene's calls.
inline Result<void> show(Scene& scene, const Appearance& appearance, const SkipOptions& skip) {
    return scene.setLook(appearance.look()).and_then([&] {
        return scene.provide(appearance.needs(skip));
    });
}

} // namespace slabcast
