// Of loops: a look goes through an octree's levels.
const int kCoarsest = 31;  // beyond any tree
int nextLevel = kCoarsest; // that the next look begins at

float freeThrough(Ray ray, Segment segment, float first) {
    vec3 place = blocksAt(ray, segment, first);
    ivec3 leaf = ivec3(place);
    int level = min(nextLevel, octree.x);
    bool found = nodeIsFree(leaf, level);
    while (!found && level > 0) {
        --level;
        found = nodeIsFree(leaf, level);
    }
    nextLevel = found ? level + octreeRise : octreeRise - 1;
    vec3 halfEdge = vec3(float(1 << level) * 0.5);
    vec3 centre = vec3((leaf >> level) << level) + halfEdge;
    return freeWhere(found, first, layersAhead(ray, place, centre, halfEdge));
}
