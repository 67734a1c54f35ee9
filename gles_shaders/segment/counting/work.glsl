// Counts: the work of the same walk instead of its colour.
int countedLayers = 0;
int countedFetches = 0;
int countedSkipFetches = 0;
int countedStretches = 0;
int countedOccupied = 0;

void countLayer() { ++countedLayers; }
void countFetches(int n) { countedFetches += n; }
void countSkipFetch() { ++countedSkipFetches; }
void countStretch(bool isFree) {
    ++countedStretches;
    countedOccupied += isFree ? 0 : 1;
}

void writeResult(vec4 sum, ivec2 range) {
    work0 = vec4(1, range.y - range.x, countedLayers, countedSkipFetches);
    work1 = vec4(countedFetches, countedStretches, countedOccupied, sum.a);
}
