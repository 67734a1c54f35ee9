// Free or not, from marks: 0 where occupied, else 1.
#include "build/precision.glsl"
#include "build/bytes.glsl"
layout(local_size_x = 4, local_size_y = 8, local_size_z = 4) in;
layout(binding = 0) uniform usampler3D marks;
layout(r32ui, binding = 0) writeonly uniform uimage3D counts;
uniform ivec3 blocks;
uniform ivec3 texels;

void main() {
    ivec3 at = ivec3(gl_GlobalInvocationID);
    if (any(greaterThanEqual(at, texels))) {
        return;
    }
    uint word = 0x01010101u ^ texelFetch(marks, at, 0).r;
    imageStore(counts, at, uvec4(withoutPadding(word, at.x, blocks.x)));
}
