// What all stages of a view share. FRAME_FIELDS: the list of core/plan/frame_fields.h, which says
// what each member holds.
precision highp float;
precision highp int;
precision highp sampler3D;
precision highp usampler3D;

layout(std140) uniform FrameBlock {
    FRAME_FIELDS
};
#define octreeRise skipBlocks.w
