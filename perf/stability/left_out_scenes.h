#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/gl/program.h"
#include "perf/stability/bench.h"

namespace slabcast::stability {

/// What there is to judge by when a scene was planned, prepared and drawn.
struct Evidence {
    const Scene& scene;
    const FramePlan& plan;
    const View& view;
    glm::ivec2 size;
    gl::ActiveResources resources;
    WorkCounters work;
    GpuMemory memory;
};

/// A claim about the work that is left, or about what there is to do it with.
struct WorkClaim {
    const char* quantity;
    double (*measured)(const Evidence& evidence);
    double (*bound)(const Evidence& evidence);
    const char* reason;
};

/// A scene that does not need all there is.
struct FrugalScene {
    const char* name;
    Volume (*volume)();
    TransferFunction tf;
    bool lit = false;
    OrbitCamera camera{30.0, 20.0, 2.5};
    double fovDegrees = 40.0;
    std::vector<std::string> samplers; // that it needs
    WorkClaim claim;
};

std::vector<FrugalScene> frugalScenes();

/// How often a text of the program occurs although the variant is without it.
int textOutOfPlace(const ShaderVariant& variant);

} // namespace slabcast::stability
