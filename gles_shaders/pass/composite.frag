// Puts a layer of our own over the caller's target, once, in the target's encoding.
precision highp float;
precision highp int;
precision highp sampler2D;
uniform sampler2D layer;
uniform ivec2 layerOrigin;
uniform int conversion; // 0: as it is; 1: linear to sRGB-encoded; 2: sRGB-encoded to linear
layout(location = 0) out vec4 colour;

vec3 encoded(vec3 c) {
    vec3 curved = 1.055 * pow(max(c, 0.0031308), vec3(1.0 / 2.4)) - 0.055;
    return mix(curved, 12.92 * c, lessThanEqual(c, vec3(0.0031308)));
}

vec3 decoded(vec3 c) {
    vec3 curved = pow((max(c, 0.04045) + 0.055) / 1.055, vec3(2.4));
    return mix(curved, c / 12.92, lessThanEqual(c, vec3(0.04045)));
}

void main() {
    vec4 c = texelFetch(layer, ivec2(gl_FragCoord.xy) - layerOrigin, 0);
    vec3 straight = c.rgb / max(c.a, 1.0e-6);
    vec3 converted = conversion == 1   ? encoded(straight)
                     : conversion == 2 ? decoded(straight)
                                       : straight;
    colour = conversion == 0 ? c : vec4(converted * c.a, c.a);
}
