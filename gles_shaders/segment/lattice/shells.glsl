// Layers of equal distance from the eye: of one length at any field of view.
Ray rayOnLattice(EyeRay eye) {
    // From the sphere's depth to its distance. The quotient is the difference
    // sphere.w - depth * length without its cancellation, nor that of depth * t - sphere.xy,
    // which the host resolves; behind the eye there is none, and the quotient's divisor may
    // vanish.
    precise vec2 missed = miss.xy + miss.zw * eye.pixel;
    precise float far = dot(missed, sphere.z * eye.slope + sphere.xy) /
                        (sphere.w + sphere.z * eye.lengthPerDepth);
    precise float toShell = sphere.z > 0.0 ? -far : sphere.w - sphere.z * eye.lengthPerDepth;
    precise vec3 perLength = eye.direction / eye.lengthPerDepth;
    precise vec3 centre = eye.centre + perLength * toShell;
    precise vec3 step = perLength * direction0.w;
    precise float layerLengthMm = direction0.w * directionY.w;
    precise float nearOffset = (centreY.w * eye.lengthPerDepth - sphere.w) * directionX.w;
    Ray ray;
    ray.centre = centre;
    ray.step = step;
    ray.layerLengthMm = layerLengthMm;
    ray.entry = nearOffset;
    ray.exit = kFar;
    return ray;
}
