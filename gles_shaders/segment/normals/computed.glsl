// The gradient by central differences of the trilinear field, half a voxel to each side, carried to
// patient space. Not mediump: differences of neighbouring values would lose their digits.
vec4 gradientAt(vec3 uvw) {
    vec3 h = 0.5 / fieldSize();
    vec3 difference = vec3(
        sampleField(uvw + vec3(h.x, 0.0, 0.0)) - sampleField(uvw - vec3(h.x, 0.0, 0.0)),
        sampleField(uvw + vec3(0.0, h.y, 0.0)) - sampleField(uvw - vec3(0.0, h.y, 0.0)),
        sampleField(uvw + vec3(0.0, 0.0, h.z)) - sampleField(uvw - vec3(0.0, 0.0, h.z)));
    countFetches(6 * kFetchesPerSample);
    vec3 gradient = vec3(dot(gradientRow[0].xyz, difference), dot(gradientRow[1].xyz, difference),
                         dot(gradientRow[2].xyz, difference));
    float square = dot(gradient, gradient);
    return vec4(gradient, square * inversesqrt(max(square, 1.0e-30)));
}
