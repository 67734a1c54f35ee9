// Work is summed by additive blending into two float32 targets.
layout(location = 0) out highp vec4 work0; // fragments, layers in the segment, evaluated,
                                           // skip fetches
layout(location = 1) out highp vec4 work1; // volume fetches, stretches, those of them not free
