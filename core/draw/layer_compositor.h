#pragma once

#include "core/draw/fullscreen_pass.h"

namespace slabcast {

/// How a layer's colours become the target's.
enum class LayerConversion : std::uint8_t { None = 0, Encode = 1, Decode = 2 };

/// Blends a layer over the bound framebuffer's viewport at (x, y), once.
class LayerCompositor {
public:
    Result<void> create() {
        return pass_.create("composite", "pass/composite.frag", {"layerOrigin", "conversion"});
    }
    bool exists() const { return pass_.exists(); }
    void composite(GLuint texture, int x, int y, LayerConversion conversion) const;
    void forget() {
        pass_.forget();
        conversion_ = LayerConversion::None;
    }

private:
    FullscreenPass pass_;
    mutable LayerConversion conversion_ = LayerConversion::None; // that the program was told last
};

} // namespace slabcast
