#pragma once

#include <array>

#include <glm/glm.hpp>

#include "core/plan/frame_plan.h"
#include "core/skip/skip_layout.h"
#include "core/view/lattice.h"

namespace slabcast {

/// The uniform block of gles_shaders/frame.glsl, std140: vec4 and ivec4 only, in its order. Change
/// both.
struct FrameBlock {
    glm::vec4 centre0, centreX, centreY;
    glm::vec4 direction0, directionX, directionY;
    glm::vec4 tangent;
    glm::vec4 sphere;
    glm::vec4 miss;
    glm::vec4 viewport;
    glm::vec4 tableMap;
    std::array<glm::vec4, 2> tableEnds;
    glm::vec4 skipMap;
    glm::vec4 decode;
    std::array<glm::vec4, 3> gradientRow;
    std::array<glm::vec4, 3> patientRow;
    glm::vec4 material;
    glm::ivec4 counts;
    glm::ivec4 skipBlocks;
    glm::ivec4 octree;
    glm::uvec4 nodeTest;
    glm::ivec4 jitter;
    std::array<glm::ivec4, kMaxOctreeLevels> octreeLevels;
};
static_assert(sizeof(FrameBlock) == 16 * (27 + kMaxOctreeLevels));

class Scene;

/// Rounds a view's float64 coefficients to what the shaders take. Pure.
FrameBlock makeFrameBlock(const RayFrame& frame, const Scene& scene, const FramePlan& plan);

} // namespace slabcast
