#pragma once

#include "core/gl/api.h"
#include "core/plan/frame_plan.h"

namespace slabcast {

/// Factors of what is drawn and of what is there; both are added.
struct Blending {
    GLenum source;
    GLenum destination;
    bool operator==(const Blending&) const = default;
};

inline constexpr Blending kOver{GL_ONE, GL_ONE_MINUS_SRC_ALPHA}; // premultiplied
inline constexpr Blending kUnder{GL_ONE_MINUS_DST_ALPHA, GL_ONE};
inline constexpr Blending kSum{GL_ONE, GL_ONE};

/// Blending by some factors and nothing else of what GL does to fragments, whatever was enabled
/// before the making of it: no test, no mask, no culling. What is drawn or cleared after that is
/// drawn as it is.
class BlendSwitch {
public:
    explicit BlendSwitch(Blending first);
    /// Other factors, where they are others.
    void to(Blending blending);

private:
    Blending now_;
};

/// Planes over what is there, or under it.
Blending planeBlending(BlendOrder order);

} // namespace slabcast
