// Layers of equal view depth, as in the core paper.
Ray rayOnLattice(EyeRay eye) {
    precise vec3 step = eye.direction * direction0.w;
    precise float layerLengthMm = direction0.w * eye.lengthPerDepth * directionY.w;
    Ray ray;
    ray.centre = eye.centre;
    ray.step = step;
    ray.layerLengthMm = layerLengthMm;
    ray.entry = centreX.w;
    ray.exit = kFar;
    return ray;
}
