#include "core/volume/phantom_vessels.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace slabcast {
namespace {

constexpr std::size_t kGenerations = 8;
constexpr std::size_t kBranches = (std::size_t{1} << kGenerations) - 1;
constexpr glm::dvec3 kRootStart{0.0, 0.0, -0.85};
constexpr double kRootLength = 0.42;
constexpr double kRootRadius = 0.09;
constexpr double kLengthRatio = 0.78;
constexpr double kRadiusRatio = 0.7937005259840998; // 2^(-1/3), Murray's law for equal children
constexpr double kPlaneTurn = 2.399963229728653;    // golden angle: no two forks lie in one plane
constexpr std::array kForkAngles{0.44, -0.66};      // to either side of the parent, in radians

/// A capsule, and the box around it and everything that grows from it.
struct Branch {
    glm::dvec3 start{0.0};
    glm::dvec3 end{0.0};
    double radius = 0.0;
    glm::dvec3 low{0.0};
    glm::dvec3 high{0.0};
};

using Tree = std::array<Branch, kBranches>; // children of i: 2i+1 and 2i+2

/// Where a branch grows, and the side to which it will fork.
struct Growth {
    glm::dvec3 start;
    glm::dvec3 along;
    glm::dvec3 side;
    double length;
    double radius;
};

Growth child(const Growth& parent, glm::dvec3 end, double angle) {
    const double c = std::cos(angle);
    const double s = std::sin(angle);
    const glm::dvec3 along = parent.along * c + parent.side * s;
    const glm::dvec3 inPlane = parent.side * c - parent.along * s;
    const glm::dvec3 side =
        inPlane * std::cos(kPlaneTurn) + glm::cross(along, inPlane) * std::sin(kPlaneTurn);
    return {end, along, side, parent.length * kLengthRatio, parent.radius * kRadiusRatio};
}

void grow(Tree& tree, std::size_t index, const Growth& growth) {
    Branch& branch = tree[index];
    branch.start = growth.start;
    branch.end = growth.start + growth.along * growth.length;
    branch.radius = growth.radius;
    branch.low = glm::min(branch.start, branch.end) - growth.radius;
    branch.high = glm::max(branch.start, branch.end) + growth.radius;
    for (std::size_t k = 0; k < 2 && 2 * index + 2 < kBranches; ++k) {
        const std::size_t childIndex = 2 * index + 1 + k;
        grow(tree, childIndex, child(growth, branch.end, kForkAngles[k]));
        branch.low = glm::min(branch.low, tree[childIndex].low);
        branch.high = glm::max(branch.high, tree[childIndex].high);
    }
}

Tree grownTree() {
    Tree tree;
    grow(tree, 0, {kRootStart, {0.0, 0.0, 1.0}, {1.0, 0.0, 0.0}, kRootLength, kRootRadius});
    return tree;
}

double capsuleDistance(const Branch& branch, glm::dvec3 point) {
    const glm::dvec3 axis = branch.end - branch.start;
    const double t = glm::dot(point - branch.start, axis) / glm::dot(axis, axis);
    return glm::distance(point, branch.start + axis * std::clamp(t, 0.0, 1.0)) - branch.radius;
}

double subtreeDistance(const Tree& tree, std::size_t index, glm::dvec3 point, double reach) {
    if (index >= kBranches) {
        return reach;
    }
    const Branch& branch = tree[index];
    const glm::dvec3 outside = glm::max(branch.low - point, point - branch.high);
    if (std::max({outside.x, outside.y, outside.z}) > reach) {
        return reach;
    }
    return std::min({reach, capsuleDistance(branch, point),
                     subtreeDistance(tree, 2 * index + 1, point, reach),
                     subtreeDistance(tree, 2 * index + 2, point, reach)});
}

} // namespace

double vesselDistance(glm::dvec3 point, double reach) {
    static const Tree tree = grownTree();
    return subtreeDistance(tree, 0, point, reach);
}

} // namespace slabcast
