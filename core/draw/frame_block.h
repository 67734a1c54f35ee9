#pragma once

#include <array>
#include <type_traits>

#include <glm/glm.hpp>

#include "core/plan/frame_fields.h"
#include "core/plan/frame_plan.h"
#include "core/skip/skip_layout.h"
#include "core/view/lattice.h"

namespace slabcast {

/// The shaders' uniform block: members as core/plan/frame_fields.h lists them.
struct FrameBlock {
    using vec4 = glm::vec4;
    using ivec4 = glm::ivec4;
    using uvec4 = glm::uvec4;
    template <class T, int number>
    using Field = std::conditional_t<number == 1, T, std::array<T, number>>;

#define SLABCAST_MEMBER(type, name, number) Field<type, number> name;
    SLABCAST_FRAME_FIELDS(SLABCAST_MEMBER)
#undef SLABCAST_MEMBER
};
static_assert(sizeof(FrameBlock::octreeLevels) == kMaxOctreeLevels * sizeof(glm::ivec4));

class Scene;

/// Rounds a view's float64 coefficients to what the shaders take. `tableWidth`: texels of a row of
/// the table's texture. Pure.
FrameBlock makeFrameBlock(const RayFrame& frame, const Scene& scene, const FramePlan& plan,
                          int tableWidth);

} // namespace slabcast
