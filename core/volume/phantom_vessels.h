#pragma once

#include <glm/glm.hpp>

namespace slabcast {

/// Signed distance to the wall of a branching vessel tree inside [-1,1]^3, negative inside. Exact
/// up to `reach` from the wall; `reach` itself where all of the tree is further away.
/// Eight generations; radii halve their cube at each fork (Murray 1926). Tested by:
/// phantoms_test.cpp
double vesselDistance(glm::dvec3 point, double reach);

} // namespace slabcast
