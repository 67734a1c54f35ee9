/// A segment that became as good as opaque is opaque, in the colour that it had gathered: off by no
/// more than the opacity that it lacked, as it would be unclosed, but what lies behind is of like
/// colour more often than black. One that gathered nothing adds nothing.
vec4 closed(vec4 sum) {
    precise vec3 colour = sum.rgb / sum.a;
    return terminated(sum.a) && sum.a > 0.0 ? vec4(colour, 1.0) : sum;
}
