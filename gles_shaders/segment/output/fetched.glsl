// The same, and the shader sees what is there. Blending is still fixed function, so that a segment
// that is left as it begins writes 0 and changes nothing.
#extension GL_EXT_shader_framebuffer_fetch : require
layout(location = 0) inout highp vec4 colour;

highp float opacityBefore() {
    return colour.a;
}
