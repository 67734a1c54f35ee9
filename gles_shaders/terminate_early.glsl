bool terminated(float alpha) {
    return alpha > viewport.w;
}

/// A segment that was left early is opaque, in the colour that it had gathered: off by no more than
/// the opacity that it lacked, as it would be unclosed, but what lies behind is of like colour more
/// often than black.
vec4 closed(vec4 sum) {
    return terminated(sum.a) ? vec4(sum.rgb / sum.a, 1.0) : sum;
}
