// Levels as builders read and write them. `address`: number of the level's first texel, texels of
// its rows and slices, fold; without a fold the level is the texture.
#include "segment/skip/levels.glsl"

ivec3 texelOfLevel(ivec3 texel, ivec4 address) {
    int number = address.x + texel.x + texel.y * address.y + texel.z * address.z;
    return address.w == 0 ? texel : foldedTexel(number, address.w);
}
