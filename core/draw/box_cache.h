#pragma once

#include <vector>

#include "core/draw/visible_boxes.h"
#include "core/scene/scene.h"

namespace slabcast {

/// The visible boxes of the scene that was asked for last.
class BoxCache {
public:
    /// Boxes for layers of this length or shorter. Cost: that of visibleBoxes() where the structure
    /// is another one, of an octree also where the TF is. Contract: the scene has a skip structure.
    const std::vector<VisibleBox>& boxesOf(const Scene& scene, double layerLengthMm);

private:
    /// What boxes are made for.
    struct Key {
        int look = -1;
        int skip = -1;
        double lengthMm = 0.0;
        bool operator==(const Key&) const = default;
    };
    Key key_;
    std::vector<VisibleBox> boxes_;
};

} // namespace slabcast
