// Blinn-Phong with a head light: light and eye are in one direction, so the half vector is too.
// Where the gradient is too small to point anywhere the colour stays unlit. Light is mediump, but
// not what is raised to a high power. `full`: what colour is 1 times: 1, or the opacity of a
// premultiplied one.
#include NORMALS_FILE

mediump vec3 shade(mediump vec3 colour, float full, vec3 uvw, Ray ray) {
    vec4 gradient = gradientAt(uvw);
    vec3 toEye = -normalize(vec3(dot(patientRow[0].xyz, ray.step), dot(patientRow[1].xyz, ray.step),
                                 dot(patientRow[2].xyz, ray.step)));
    float square = max(dot(gradient.xyz, gradient.xyz), 1.0e-30);
    float facing = abs(dot(gradient.xyz, toEye)) * inversesqrt(square);
    mediump float diffuse = inLight(material.x + inLight(material.y * inLight(facing)));
    mediump float highlight = inLight(full * inLight(material.z * pow(facing, material.w)));
    mediump vec3 lit = inLight(inLight(colour * diffuse) + highlight);
    mediump float trust = inLight(smoothstep(1.0, 2.0, gradient.w));
    mediump vec3 change = inLight(min(lit, vec3(full)) - colour);
    return inLight(colour + inLight(change * trust));
}
