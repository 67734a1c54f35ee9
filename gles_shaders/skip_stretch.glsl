// Layers that one look at the skip structure decides.
struct Stretch {
    int layers; // from the sample on, the sample included
    bool free;  // certain to be invisible
};

/// Of `within` samples in a row known to be free or not: a layer is free whose samples all are.
Stretch stretchOf(int within, bool isFree) {
    int freeLayers = isFree ? within - kSharedEnds : 0;
    countStretch(freeLayers > 0);
    return Stretch(freeLayers > 0 ? freeLayers : within, freeLayers > 0);
}
