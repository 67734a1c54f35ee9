// Layers that one look at the skip structure decides.
struct Stretch {
    int layers; // from the sample on, the sample included; 0: look again
    bool free;  // certain to be invisible
};

/// Layers that are evaluated in a row once one is: looking again after every block costs more than
/// a few layers too many, most of all where neighbouring fragments wait for each other. On the
/// skull 8 evaluate a tenth more layers in three quarters of the looks, and take two thirds of the
/// time (llvmpipe).
const int kLeastRun = 8;

/// Of `within` samples in a row known to be free or not: a layer is free whose samples all are.
Stretch stretchOf(int within, bool isFree) {
    int freeLayers = isFree ? within - kSharedEnds : 0;
    countStretch(freeLayers > 0);
    return freeLayers > 0 ? Stretch(freeLayers, true) : Stretch(max(within, kLeastRun), false);
}
