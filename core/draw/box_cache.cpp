#include "core/draw/box_cache.h"

#include <cmath>

namespace slabcast {

BoxCache::Key BoxCache::keyOf(const Scene& scene, double layerLengthMm) {
    const BuiltSkip& skip = scene.skip();
    return {
        // A grid is of one transfer function; of an octree, each shows other nodes.
        .look = skip.octree ? scene.lookGeneration() : 0,
        .skip = skip.generation,
        // Up to a power of two: views of slightly different width share their boxes.
        .lengthMm = std::exp2(std::ceil(std::log2(layerLengthMm))),
    };
}

void BoxCache::prepare(const Scene& scene, double layerLengthMm) {
    const BuiltSkip& skip = scene.skip();
    if (!serve(scene, layerLengthMm)) {
        const Key key = keyOf(scene, layerLengthMm);
        if (skip.octree) {
            finder_.find(*skip.octree, skip.test, scene.geometry(), key.lengthMm);
        } else {
            finder_.find(*skip.lengths, scene.geometry(), key.lengthMm);
        }
        key_ = key;
    }
}

bool BoxCache::serve(const Scene& scene, double layerLengthMm) const {
    const Key key = keyOf(scene, layerLengthMm);
    return key.look == key_.look && key.skip == key_.skip && key.lengthMm <= key_.lengthMm;
}

} // namespace slabcast
