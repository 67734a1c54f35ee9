// Every layer is weighed where it is, those at the ends of the stay too.
Segment composited(Segment segment) {
    return segment;
}
float layersInGroups(Segment segment);
float layersOf(Segment segment) {
    return layersInGroups(segment);
}
void addEntry(inout Sum sum, Ray ray, Segment segment) {}
void addExit(inout Sum sum, Ray ray, Segment segment) {}
