#include "core/plan/needs.h"

namespace slabcast {

Needs needsOf(const Settings& settings) {
    const bool normals = settings.shaded && settings.classification == Classification::Post &&
                         settings.normals == Normals::Baked;
    Needs needs{settings.classification, settings.space,      settings.shaded, normals,
                settings.skipOptions,    settings.skipBuilder};
    needs.skip.structure = settings.skip.value_or(settings.skipOptions.structure);
    if (settings.tighten && needs.skip.structure == SkipStructure::None) {
        needs.skip.structure = SkipStructure::Blocks;
    }
    return needs;
}

} // namespace slabcast
