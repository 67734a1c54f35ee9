#pragma once

#include "core/plan/settings.h"
#include "core/skip/skip_structure.h"

namespace slabcast {

/// What frames of some settings are drawn from, beside the volume and its transfer function: the
/// kind of table or texels, and the skip structure. Scene::provide() builds this and nothing else.
struct Needs {
    Classification classification = Classification::Post;
    CompositingSpace space = CompositingSpace::Display;
    bool shaded = false; // of pre-classified texels: the light is in them
    bool normals = false; // baked, of what is shaded sample by sample
    SkipOptions skip{.structure = SkipStructure::None};
    SkipBuilder builder = SkipBuilder::Auto; // who builds the structure; never what is built

    bool operator==(const Needs&) const = default;
};

/// Depends on the settings alone, so that it is known before anything is built. Tight planes need a
/// structure to be tightened around: blocks, where the settings ask for no other. Pure.
/// Tested by: needs_test.cpp
Needs needsOf(const Settings& settings);

} // namespace slabcast
