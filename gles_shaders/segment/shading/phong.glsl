// Blinn-Phong with a head light: light and eye are in one direction, so the half vector is too. The
// gradient is by central differences of the trilinear field, half a voxel to each side, carried to
// patient space; where it is too small to point anywhere the colour stays unlit. Light is mediump,
// but not what would lose its digits there: differences of neighbouring values, and what is raised
// to a high power. `full`: what colour is 1 times: 1, or the opacity of a premultiplied one.
mediump vec3 shade(mediump vec3 colour, float full, vec3 uvw, Ray ray) {
    vec3 h = 0.5 / fieldSize();
    vec3 difference = vec3(
        sampleField(uvw + vec3(h.x, 0.0, 0.0)) - sampleField(uvw - vec3(h.x, 0.0, 0.0)),
        sampleField(uvw + vec3(0.0, h.y, 0.0)) - sampleField(uvw - vec3(0.0, h.y, 0.0)),
        sampleField(uvw + vec3(0.0, 0.0, h.z)) - sampleField(uvw - vec3(0.0, 0.0, h.z)));
    countFetches(6 * kFetchesPerSample);
    vec3 gradient = vec3(dot(gradientRow[0].xyz, difference), dot(gradientRow[1].xyz, difference),
                         dot(gradientRow[2].xyz, difference));
    float steepness = length(gradient);
    vec3 toEye = -normalize(vec3(dot(patientRow[0].xyz, ray.step), dot(patientRow[1].xyz, ray.step),
                                 dot(patientRow[2].xyz, ray.step)));
    float facing = abs(dot(gradient, toEye)) / max(steepness, 1.0e-20);
    mediump float diffuse = inLight(material.x + inLight(material.y * inLight(facing)));
    mediump float highlight = inLight(full * inLight(material.z * pow(facing, material.w)));
    mediump vec3 lit = inLight(inLight(colour * diffuse) + highlight);
    mediump float trust = inLight(smoothstep(gradientRow[0].w, 2.0 * gradientRow[0].w, steepness));
    mediump vec3 change = inLight(min(lit, vec3(full)) - colour);
    return inLight(colour + inLight(change * trust));
}
