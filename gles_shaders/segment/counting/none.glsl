// Draws: the segment's premultiplied colour.
void countLayers(int n) {}
void countFetches(int n) {}
void countSkipFetch() {}
void countLook(bool isFree) {}

void writeResult(vec4 sum, float layers) {
    colour = sum;
}
