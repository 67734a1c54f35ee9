// Draws: the segment's premultiplied colour.
void countLayer() {}
void countFetches(int n) {}
void countSkipFetch() {}
void countStretch(bool isFree) {}

void writeResult(vec4 sum, ivec2 range) {
    colour = sum;
}
