// Counts: the work of the same walk instead of its colour.
int countedLayers = 0;
int countedFetches = 0;
int countedSkipFetches = 0;
int countedLooks = 0;
int countedOccupied = 0;

void countLayers(int n) { countedLayers += n; }
void countFetches(int n) { countedFetches += n; }
void countSkipFetch() { ++countedSkipFetches; }
void countLook(bool isFree) {
    ++countedLooks;
    countedOccupied += isFree ? 0 : 1;
}

void writeResult(vec4 sum, float layers) {
    work0 = vec4(1, layers, countedLayers, countedSkipFetches);
    work1 = vec4(countedFetches, countedLooks, countedOccupied, sum.a);
}
