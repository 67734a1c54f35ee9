// Layers of equal view depth, as in the core paper.
Ray rayOnLattice(vec2 p) {
    Ray ray;
    ray.centre = affine(centre0.xyz, centreX.xyz, centreY.xyz, p);
    ray.step = affine(step0.xyz, stepX.xyz, stepY.xyz, p);
    ray.layerLength = sqrt(squaredLengthPerDepth(p));
    ray.nearOffset = centreX.w;
    return ray;
}
