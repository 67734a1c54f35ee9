// Codes of floats: 65,536 bins of even width. Arithmetic finds a bin near by, the table of the
// bins' least floats the one.
layout(binding = 0) uniform sampler3D voxels;
layout(binding = 2) uniform sampler2D codeStarts; // 256 x 256
uniform vec2 codeEstimate; // least float of all, codes per float

float startOf(int code) {
    return texelFetch(codeStarts, ivec2(code & 255, code >> 8), 0).r;
}

uint codeAt(ivec3 voxel) {
    const int kLast = 65535;
    float value = texelFetch(voxels, voxel, 0).r;
    float estimate = (value - codeEstimate.x) * codeEstimate.y;
    int code = int(clamp(estimate, 0.0, float(kLast)));
    while (code > 0 && value < startOf(code)) {
        --code;
    }
    while (code < kLast && value >= startOf(code + 1)) {
        ++code;
    }
    return uint(code);
}
