// What is drawn: nothing is rounded here; where it is declared mediump, a device may. half.glsl is
// the other.
#define inOpacity(x) (x)
#define inSum(x) (x)
#define inColour(x) (x)
#define inExtinction(x) (x)
#define inLight(x) (x)
