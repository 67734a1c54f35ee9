void jitterRay(vec2 fragCoord, inout Ray ray) {}
