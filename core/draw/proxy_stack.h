#pragma once

#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "core/draw/visible_boxes.h"
#include "core/view/lattice.h"

namespace slabcast {

/// What one plane's polygon covers, in tangent space (x/depth, y/depth): the unit polygon, a 10-gon
/// around the unit circle or the square [-1,1]^2, scaled by halfSize about centre. halfSize 0:
/// nothing to draw.
struct Outline {
    glm::dvec2 centre{0.0};
    glm::dvec2 halfSize{0.0};
    bool empty() const { return halfSize.x <= 0.0 || halfSize.y <= 0.0; }
};

/// The planes of a view that may touch anything, nearest first.
struct ProxyStack {
    int firstPlane = 0;            // the lattice's number of the first outline's plane
    std::vector<Outline> outlines; // empty where the view sees nothing
};

/// 10-gons around the bounding sphere's part in every slab: the eye-anchored static stack.
/// Covers, over each slab, the union of the sphere's discs, also of off-axis ones; the whole
/// viewport where a slab reaches the near plane or the eye. Slabs behind the near plane are
/// dropped. Cost: O(planes). Source: Tukora 2020, section 2.1. Tested by: proxy_stack_test.cpp
ProxyStack sphereStack(const RayFrame& frame, const Frustum& frustum, int planes,
                       int layersPerPlane);

/// Rectangles around what the boxes show in each slab; slabs that no box meets are empty.
/// Draws the same samples as sphereStack wherever they are visible. Cost: O(boxes x planes per box
/// + planes).
ProxyStack tightStack(const RayFrame& frame, const Frustum& frustum, const glm::dmat4& viewFromUvw,
                      std::span<const VisibleBox> boxes, int planes, int layersPerPlane);

/// The same in place of another stack, of as many planes without allocating.
void sphereStack(const RayFrame& frame, const Frustum& frustum, int planes, int layersPerPlane,
                 ProxyStack& stack);
void tightStack(const RayFrame& frame, const Frustum& frustum, const glm::dmat4& viewFromUvw,
                std::span<const VisibleBox> boxes, int planes, int layersPerPlane,
                ProxyStack& stack);

/// For stacks beyond the uniform block, whose planes share outlines. The planes of one outline; and
/// what it is: of several planes the rectangle around theirs, to be drawn with the square.
std::span<const Outline> group(const ProxyStack& stack, std::size_t index, int planesPerOutline);
Outline joined(std::span<const Outline> planes);

} // namespace slabcast
