// What tells materials apart beside the value, where nothing does.
const int kLabel = 0; // of the region that a sample lies in
const int kSide = 0;  // of the clip plane: before it
