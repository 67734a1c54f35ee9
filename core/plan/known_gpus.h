#pragma once

#include <string_view>

namespace slabcast {

/// A GPU of which a model says which ratio is best: work that was counted, times what the GPU's own
/// compiler says of the shaders, over what is published of it (perf/model). Nothing was measured on
/// it. Tested by: known_gpus_test.cpp
struct KnownGpu {
    const char* renderer; // as its GL_RENDERER begins
    const char* title;
    int layersSkipping; // per plane, where something empty is skipped; 0: all on one plane
    int layersPlain;    // where nothing is
};

inline constexpr KnownGpu kKnownGpus[] = {
    {"Mali-G71", "Mali-G71", 0, 0},           {"Mali-G52", "Mali-G52", 48, 0},
    {"Mali-G57", "Mali-G57", 16, 0},          {"Adreno (TM) 630", "Adreno 630", 16, 0},
    {"Adreno (TM) 650", "Adreno 650", 8, 0},  {"Adreno (TM) 660", "Adreno 660", 8, 0},
    {"Adreno (TM) 740", "Adreno 740", 16, 0},
};

/// Null where none begins so.
constexpr const KnownGpu* findKnownGpu(std::string_view renderer) {
    for (const KnownGpu& gpu : kKnownGpus) {
        if (renderer.starts_with(gpu.renderer)) {
            return &gpu;
        }
    }
    return nullptr;
}

} // namespace slabcast
