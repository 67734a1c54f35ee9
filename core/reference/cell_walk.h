#pragma once

#include <algorithm>
#include <limits>

#include "core/view/lattice.h"

namespace slabcast {

/// Visits the interpolation cells that a ray meets between entry and exit, front to back, as
/// visit(cell, from, to, layers): from and to in the cell's coordinates, [0,1]^3, and how many of
/// the ray's layers lie between. Cell k of an axis lies between the centres of the voxels k and
/// k + 1; those at the ends, -1 and dims - 1, reach half a voxel beyond the last centre. Stops
/// where visit returns false.
/// Every boundary is computed from its index, so no rounding adds up; a ray along a face stays on
/// one side of it.
/// Tested by: field_cubic_test.cpp. Source: Amanatides and Woo 1987.
template <class Visit>
void walkCells(const LatticeRay& ray, glm::ivec3 dims, const Visit& visit) {
    if (!(ray.entry < ray.exit)) {
        return;
    }
    const glm::dvec3 origin = ray.centre * glm::dvec3(dims) - 0.5; // in voxels
    const glm::dvec3 pace = ray.step * glm::dvec3(dims);
    const auto placeAt = [&](double offset) { return origin + offset * pace; };
    glm::ivec3 cell(
        glm::clamp(glm::floor(placeAt(ray.entry)), glm::dvec3(-1.0), glm::dvec3(dims - 1)));
    const auto leaves = [&](int axis) {
        const int plane = cell[axis] + (pace[axis] > 0.0 ? 1 : 0);
        return pace[axis] == 0.0 ? std::numeric_limits<double>::infinity()
                                 : (plane - origin[axis]) / pace[axis];
    };
    glm::dvec3 next(leaves(0), leaves(1), leaves(2));
    double begin = ray.entry;
    while (begin < ray.exit) {
        const int side = next.y < next.x ? 1 : 0;
        const int axis = next.z < next[side] ? 2 : side;
        const double end = std::min(next[axis], ray.exit);
        if (end > begin) {
            const auto inCell = [&](double offset) {
                return glm::clamp(placeAt(offset) - glm::dvec3(cell), 0.0, 1.0);
            };
            if (!visit(cell, inCell(begin), inCell(end), end - begin)) {
                return;
            }
            begin = end;
        }
        cell[axis] += pace[axis] > 0.0 ? 1 : -1;
        next[axis] = leaves(axis);
    }
}

} // namespace slabcast
