#pragma once

#include "core/gl/api.h"
#include "core/plan/frame_plan.h"

namespace slabcast {

/// Factors of what is drawn and of what is there, and what is made of both.
struct Blending {
    GLenum source;
    GLenum destination;
    GLenum equation = GL_FUNC_ADD;
    bool operator==(const Blending&) const = default;
};

inline constexpr Blending kOver{GL_ONE, GL_ONE_MINUS_SRC_ALPHA}; // premultiplied
inline constexpr Blending kUnder{GL_ONE_MINUS_DST_ALPHA, GL_ONE};
inline constexpr Blending kSum{GL_ONE, GL_ONE};

/// Blending in some way and nothing else of what GL does to fragments, whatever was enabled
/// before the making of it: no test, no mask, no culling. What is drawn or cleared after that is
/// drawn as it is.
class BlendSwitch {
public:
    explicit BlendSwitch(Blending first);
    /// Another way, where it is another.
    void to(Blending blending);

private:
    Blending now_;
};

/// Of the plan's planes: follows from how its layers are combined (kAccumulateRules) and its order.
Blending planeBlending(const FramePlan& plan);

} // namespace slabcast
