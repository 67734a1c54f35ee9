// Marks the saturated pixels of a layer: leaves this triangle's depth there and nowhere else.
precision highp float;
precision highp int;
precision highp sampler2D;
uniform sampler2D layer;
uniform float saturatedAlpha;

void main() {
    if (texelFetch(layer, ivec2(gl_FragCoord.xy), 0).a <= saturatedAlpha) {
        discard;
    }
}
