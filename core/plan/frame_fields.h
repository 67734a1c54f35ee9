#pragma once

/// What all stages of a view share, in the order of memory: the members of FrameBlock and of the
/// shaders' uniform block come from this list, FIELD(type, name, number). std140: vectors of four
/// alone, so that an element takes 16 bytes on either side. Tested by: frame_block_gl_test.cpp
// clang-format off
#define SLABCAST_FRAME_FIELDS(FIELD)                                                               \
    /* xyz: uvw where the central ray crosses the sphere's depth; w: total / 2 */                  \
    FIELD(vec4, centre0, 1)                                                                        \
    /* per pixel to the right; w: offset of the near plane (planar lattice) */                     \
    FIELD(vec4, centreX, 1)                                                                        \
    /* per pixel up; w: near depth in spacings of the layers (shells) */                           \
    FIELD(vec4, centreY, 1)                                                                        \
    /* xyz: uvw per layer of the central ray, or for shells per spacing of depth; w: halvings of   \
       light in a layer as long as the spacing, per unit of extinction in the table; or such       \
       layers per reference length of pre-classified texels */                                     \
    FIELD(vec4, step0, 1)                                                                          \
    /* per pixel to the right; w: distance of the sphere's centre in spacings (shells) */          \
    FIELD(vec4, stepX, 1)                                                                          \
    /* per pixel up; w: 1 / spacing, view units (shells) */                                        \
    FIELD(vec4, stepY, 1)                                                                          \
    /* xy: (x, y) / depth of the central ray; zw: per pixel */                                     \
    FIELD(vec4, tangent, 1)                                                                        \
    /* x: see missed; z: depth of the sphere's centre; w: its distance */                          \
    FIELD(vec4, sphere, 1)                                                                         \
    /* sphere.x + (xy + zw * p) . p of a pixel p: square of the distance of the sphere's centre    \
       less that of the ray's place at its depth, over the spacing */                              \
    FIELD(vec4, missed, 1)                                                                         \
    /* xy: centre in pixels; z: layers per plane; w: termination */                                \
    FIELD(vec4, viewport, 1)                                                                       \
    /* place in the table: of one that is fetched (sampled - y) * x, in texels; of one that is     \
       filtered sampled * x + y, from 0 to 1; w: last texel */                                     \
    FIELD(vec4, tableMap, 1)                                                                       \
    /* of a pre-integrated table: its first and last texel */                                      \
    FIELD(vec4, tableEnds, 2)                                                                      \
    /* xyz: blocks or leaves per unit of uvw; w: counts of free length per spacing */              \
    FIELD(vec4, skipMap, 1)                                                                        \
    /* xy: sampled value of an exact texel = dot(texel.rg, xy) */                                  \
    FIELD(vec4, decode, 1)                                                                         \
    /* rows: patient-space gradient from differences per voxel, in units of the floor; w of 0: the \
       steepest that baked normals hold, in floors */                                              \
    FIELD(vec4, gradientRow, 3)                                                                    \
    /* rows: patient-space direction from one in uvw */                                            \
    FIELD(vec4, patientRow, 3)                                                                     \
    /* ambient, diffuse, specular, shininess */                                                    \
    FIELD(vec4, material, 1)                                                                       \
    /* first plane, layers per plane, planes per outline */                                        \
    FIELD(ivec4, counts, 1)                                                                        \
    /* xyz: number of blocks or leaves - 1; w: levels that a walk through an octree goes up after  \
       a free node */                                                                              \
    FIELD(ivec4, skipBlocks, 1)                                                                    \
    /* level of the initial nodes, from the leaves; nodes per texel, log2; fold, see               \
       segment/skip/levels.glsl; bits per node */                                                  \
    FIELD(ivec4, octree, 1)                                                                        \
    /* what of a node's bits or codes the transfer function makes visible */                       \
    FIELD(uvec4, nodeTest, 1)                                                                      \
    /* xy: the viewport's corner in pixels */                                                      \
    FIELD(ivec4, jitter, 1)                                                                        \
    /* x: number of the level's first texel in the texture */                                      \
    FIELD(ivec4, octreeLevels, 16)
// clang-format on
