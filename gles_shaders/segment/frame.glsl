// What all stages of a view share. Mirrors core/frame/frame_block.h: change both.
precision highp float;
precision highp int;
precision highp sampler3D;
precision highp usampler3D;

layout(std140) uniform FrameBlock {
    vec4 centre0;        // xyz: uvw where the central ray crosses the sphere's depth; w: total / 2
    vec4 centreX;        // per pixel to the right; w: offset of the near plane (planar lattice)
    vec4 centreY;        // per pixel up; w: near depth (shells)
    vec4 direction0;     // xyz: uvw per unit of depth; w: spacing of the layers, view units
    vec4 directionX;     // w: 1 / spacing
    vec4 directionY;     // w: mm per view unit
    vec4 tangent;        // xy: of the central ray; zw: per pixel
    vec4 sphere;         // xyz: the sphere's centre (x, y, depth); w: its distance
    vec4 miss;           // at the sphere's depth, xy: from its centre to the central ray;
                         // zw: per pixel
    vec4 viewport;       // xy: centre in pixels; z: 1 for shells, 0 for planar; w: termination
    vec4 tableMap;       // xy: table texel = (sampled - y) * x; w: last texel;
                         // z: per mm, extinction where a table texel's alpha is 1, or
                         // 1 / reference length of pre-classified texels
    vec4 tableEnds[2];   // of a pre-integrated table: its first and last texel
    vec4 skipMap;        // xyz: blocks or leaves per unit of uvw; w: free length per count, mm
    vec4 decode;         // xy: sampled value of an exact texel = dot(texel.rg, xy)
    vec4 gradientRow[3]; // rows: patient-space gradient from differences per voxel; w of 0: floor
    vec4 patientRow[3];  // rows: patient-space direction from one in uvw
    vec4 material;       // ambient, diffuse, specular, shininess
    ivec4 counts;        // first plane, layers per plane, planes per outline
    ivec4 skipBlocks;    // xyz: number of blocks or leaves - 1; w: levels that a walk through an
                         // octree goes up after a free node
    ivec4 octree;        // level of the initial nodes, from the leaves; nodes per texel, log2;
                         // fold, see skip_levels.glsl; bits per node
    uvec4 nodeTest;      // what of a node's bits or codes the transfer function makes visible
    ivec4 jitter;        // xy: the viewport's corner in pixels; z: 1 where rays are jittered
    ivec4 octreeLevels[16]; // x: number of the level's first texel in the texture
};
#define firstPlane counts.x
#define layersPerPlane counts.y
#define octreeRise skipBlocks.w
#define planesPerOutline counts.z

layout(std140) uniform OutlineBlock {
    vec4 outlines[MAX_OUTLINES]; // xy: centre, zw: half size, normalised device coordinates
};
