// Levels of an octree lie one after the other in a texture, whose texels are counted along x, then
// y, then z. `fold`: log2 of its width and height. See core/skip/skip_layout.h.
ivec3 foldedTexel(int number, int fold) {
    int last = (1 << fold) - 1;
    return ivec3(number & last, number >> fold & last, number >> 2 * fold);
}
