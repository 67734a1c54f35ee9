#pragma once

#include <vector>

#include "core/draw/visible_boxes.h"
#include "core/scene/scene.h"

namespace slabcast {

/// The visible boxes of the scene that was prepared last.
class BoxCache {
public:
    /// For layers of this length or shorter. Cost: that of visibleBoxes() where the structure is
    /// another one, of an octree also where the TF is. Contract: the scene has a skip structure.
    void prepare(const Scene& scene, double layerLengthMm);
    /// Whether the boxes hold all that is visible of this scene with layers of this length.
    bool serve(const Scene& scene, double layerLengthMm) const;
    const std::vector<VisibleBox>& boxes() const { return finder_.boxes(); }

private:
    /// What boxes are made for.
    struct Key {
        int look = -1;
        int skip = -1;
        double lengthMm = 0.0;
    };
    static Key keyOf(const Scene& scene, double layerLengthMm);

    Key key_;
    BoxFinder finder_;
};

} // namespace slabcast
