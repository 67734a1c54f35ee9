// Layers of equal distance from the eye: of one length at any field of view.
Ray rayOnLattice(vec2 p) {
    float square = squaredLengthPerDepth(p);
    float perLength = inversesqrt(square); // depth
    precise float lengthPerDepth = square * perLength;
    // From the sphere's depth to its distance, in layers: the difference
    // sphere.w - sphere.z * length as a quotient without its cancellation, whose dividend the host
    // resolves to a polynomial of the pixel. Behind the eye nothing cancels, and the divisor may
    // vanish.
    precise vec2 perPixel = fma(missed.zw, p, missed.xy);
    precise float dividend = fma(perPixel.x, p.x, fma(perPixel.y, p.y, sphere.x));
    precise float toShell = dividend / fma(sphere.z, lengthPerDepth, sphere.w);
    if (!kEyeIsOutside) {
        precise float behind = (sphere.w - sphere.z * lengthPerDepth) * stepY.w;
        toShell = sphere.z > 0.0 ? toShell : behind;
    }
    Ray ray;
    precise vec3 step = affine(step0.xyz, stepX.xyz, stepY.xyz, p) * perLength;
    precise vec3 centre = fma(step, vec3(toShell),
                              affine(centre0.xyz, centreX.xyz, centreY.xyz, p));
    ray.step = step;
    ray.centre = centre;
    ray.layerLength = 1.0;
    ray.nearOffset = fma(centreY.w, lengthPerDepth, -stepX.w);
    return ray;
}
