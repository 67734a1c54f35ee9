#include "core/draw/box_cache.h"

#include <cmath>

namespace slabcast {

const std::vector<VisibleBox>& BoxCache::boxesOf(const Scene& scene, double layerLengthMm) {
    const BuiltSkip& skip = scene.skip();
    const Key key{
        // A grid is of one transfer function; of an octree, each shows other nodes.
        .look = skip.octree ? scene.lookGeneration() : 0,
        .skip = skip.generation,
        // Up to a power of two: views of slightly different width share their boxes.
        .lengthMm = std::exp2(std::ceil(std::log2(layerLengthMm))),
    };
    if (key != key_) {
        boxes_ = skip.octree ? visibleBoxes(*skip.octree, skip.test, scene.geometry(), key.lengthMm)
                             : visibleBoxes(*skip.lengths, scene.geometry(), key.lengthMm);
        key_ = key;
    }
    return boxes_;
}

} // namespace slabcast
