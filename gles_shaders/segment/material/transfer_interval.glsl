// Mean colour and extinction of an interval of values: from the transfer function's pre-integrated
// table. See core/transfer/preintegrated.h.
precision highp sampler2D;
uniform sampler2D transferTable;

/// Mean of an interval by the table, and by its ends where the TF is constant beyond them.
vec4 meanBetween(float front, float back, int label, int side) {
    float last = tableMap.w;
    vec2 place = clamp(vec2(front, back), 0.0, last);
    vec4 within = textureLod(transferTable, (place + 0.5) / (last + 1.0), 0.0);
    float low = min(front, back);
    float high = max(front, back);
    float below = max(min(high, 0.0) - low, 0.0);
    float above = max(high - max(low, last), 0.0);
    precise vec4 mean = (within * abs(place.y - place.x) + tableEnds[0] * below +
                         tableEnds[1] * above) / (high - low);
    // Beyond an end exactly that end's texel: the filter's weights could let its neighbour in.
    vec4 same = low >= last ? tableEnds[1] : high <= 0.0 ? tableEnds[0] : within;
    return low < high ? mean : same;
}
