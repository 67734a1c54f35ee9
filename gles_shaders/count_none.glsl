// Draws: the segment's premultiplied colour, to be blended over what is there.
layout(location = 0) out vec4 colour;

void countLayer() {}
void countFetches(int n) {}
void countSkipFetch() {}
void countStretch(bool isFree) {}

void writeResult(vec4 sum, ivec2 range) {
    colour = sum;
}
