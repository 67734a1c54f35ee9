// Where a device may hold 16 bits: nowhere; this is what is drawn. half.glsl is the other.
#define inOpacity(x) (x)
#define inSum(x) (x)
#define inColour(x) (x)
#define inExtinction(x) (x)
#define inLight(x) (x)
