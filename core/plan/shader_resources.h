#pragma once

#include <array>
#include <cstdint>

namespace slabcast {

/// The textures that segments read; the number is the texture unit.
enum class Sampler : std::uint8_t { Volume, Table, Skip, LayerBefore, Normals };

/// By unit: the names in the shaders. Tested by: renderer_work_gl_test.cpp
inline constexpr std::array<const char*, 5> kSamplerNames = {
    "volumeTexels",  // the scalars, or pre-classified colours
    "transferTable", // of a TF, by one value or by both ends of an interval
    "skipTexels",    // of the skip structure
    "layerBefore",   // what the planes before have made, for programs that count work
    "normalTexels",  // of normals that were baked
};

constexpr unsigned unitOf(Sampler sampler) {
    return static_cast<unsigned>(sampler);
}

/// Fetching what is in the target before a fragment.
inline constexpr const char* kFetchExtension = "GL_EXT_shader_framebuffer_fetch";

} // namespace slabcast
