// Of loops: a look that goes through an octree's levels.
int nextLevel = 0; // of the next look, at least

/// A loop may go on to the nodes around that one: it begins above and goes down.
float freeThrough(Ray ray, Segment segment, float first, float last) {
    vec3 place = blocksAt(ray, segment, first);
    ivec3 leaf = ivec3(place);
    int least = levelOfBoth(leaf, ivec3(blocksAt(ray, segment, last)));
    int level = max(least, min(nextLevel, octree.x));
    bool found = false;
    while (!found && level >= least && level <= octree.x) {
        found = nodeIsFree(leaf, level);
        level -= found ? 0 : 1;
    }
    nextLevel = found ? level + octreeRise : octreeRise - 1;
    vec3 halfEdge = vec3(float(1 << level) * 0.5);
    vec3 centre = vec3((leaf >> level) << level) + halfEdge;
    return freeWhere(found, first + layersAhead(ray, place, centre, halfEdge));
}
