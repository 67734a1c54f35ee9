// One offset per ray, of all its layers: grain, not bands.

/// Mirrors jitterOf() in core/view/lattice.cpp: interleaved gradient noise in integers, from -1/2
/// to 1/2.
float jitterOf(uvec2 pixel) {
    uint noise = ((pixel.x * 288237660u + pixel.y * 25070368u) >> 8) * 13564u;
    return float(noise >> 8) * (1.0 / 16777216.0) - 0.5;
}

void jitterRay(vec2 fragCoord, inout Ray ray) {
    precise float moved = jitterOf(uvec2(ivec2(fragCoord) - jitter.xy));
    precise vec3 centre = fma(ray.step, vec3(moved), ray.centre);
    precise float nearOffset = ray.nearOffset - moved;
    ray.centre = centre;
    ray.nearOffset = nearOffset;
}
