// Blinn-Phong with a head light: light and eye are in one direction, so the half vector is too.
// Where the gradient is too small to point anywhere the colour stays unlit. `full`: what colour is 1
// times: 1, or the opacity of a premultiplied one. What mixes colour and light is mediump, and
// nothing else of a segment: its rounding stays below half an 8-bit step, and it is all that 16 bits
// make cheaper (perf/README.md). What goes in is rounded once each, into a variable: an operation
// with one highp operand is highp. A device that does round promises that skipping changes nothing
// only to that rounding.
#include NORMALS_FILE

vec3 shade(vec3 colour, float full, vec3 uvw, Ray ray) {
    vec4 gradient = gradientAt(uvw);
    vec3 toEye = -normalize(vec3(dot(patientRow[0].xyz, ray.step), dot(patientRow[1].xyz, ray.step),
                                 dot(patientRow[2].xyz, ray.step)));
    float square = max(dot(gradient.xyz, gradient.xyz), 1.0e-30);
    float facing = abs(dot(gradient.xyz, toEye)) * inversesqrt(square);
    mediump vec3 plain = inLight(colour);
    mediump float whole = inLight(full);
    mediump float diffuse = inLight(material.x + material.y * facing);
    mediump float highlight = inLight(full * (material.z * pow(facing, material.w)));
    mediump float trust = inLight(smoothstep(1.0, 2.0, gradient.w));
    mediump vec3 lit = inLight(inLight(plain * diffuse) + highlight);
    mediump vec3 change = inLight(min(lit, vec3(whole)) - plain);
    mediump vec3 shaded = inLight(plain + inLight(change * trust));
    return shaded;
}
