// Two halves of a word: the least of some values, and above it the greatest.
const uint kNoRange = 0x0000ffffu;

uint leastOf(uint range) {
    return range & 0xffffu;
}

uint greatestOf(uint range) {
    return range >> 16;
}

uint joined(uint a, uint b) {
    return min(leastOf(a), leastOf(b)) | max(greatestOf(a), greatestOf(b)) << 16;
}
