#pragma once

#include <vector>

#include <glm/glm.hpp>

#include "core/skip/free_lengths.h"
#include "core/skip/octree.h"
#include "core/volume/volume.h"

namespace slabcast {

/// A box in uvw that may hold visible samples.
struct VisibleBox {
    glm::dvec3 low{0.0};
    glm::dvec3 high{1.0};
};

/// The occupied blocks, merged to boxes of eight voxels or more so that there are 16,384 places for
/// one at most. Boxes on the volume's faces reach half a layer further: there a layer's sample may
/// lie outside, clamped. Depends on the TF and the layer length, not on the view. Cost: O(blocks),
/// all cores.
/// Tested by: proxy_stack_test.cpp
std::vector<VisibleBox> visibleBoxes(const FreeLengths& lengths, const VolumeGeometry& geometry,
                                     double layerLengthMm);

/// The same of an octree's leaves that are not free, from the coarsest level down. Cost: O(nodes of
/// the boxes' size that are not free), of leaves where an octree has no such level.
std::vector<VisibleBox> visibleBoxes(const Octree& octree, const NodeTest& test,
                                     const VolumeGeometry& geometry, double layerLengthMm);

/// The same again and again: allocates where there are more boxes to be than ever before, which is
/// said by the volume, not by the TF.
class BoxFinder {
public:
    void find(const FreeLengths& lengths, const VolumeGeometry& geometry, double layerLengthMm);
    void find(const Octree& octree, const NodeTest& test, const VolumeGeometry& geometry,
              double layerLengthMm);
    const std::vector<VisibleBox>& boxes() const { return boxes_; }

private:
    std::vector<VisibleBox> boxes_;
    std::vector<std::uint8_t> occupied_;
};

} // namespace slabcast
