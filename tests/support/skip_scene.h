#pragma once

#include <algorithm>
#include <cmath>

#include <glm/glm.hpp>

#include "core/skip/cell_visibility.h"
#include "core/transfer/transfer_function.h"
#include "core/volume/texels.h"
#include "core/volume/volume.h"

namespace slabcast::test {

/// A small volume of 8-bit codes that are their own sampled values, with a table laid by hand.
struct SkipScene {
    VolumeGeometry geometry;
    Texels texels; // scale and bias only
    TexelCodes codes;
    TransferTable table;

    std::uint16_t& code(glm::ivec3 voxel) {
        return codes.codes[(voxel.z * geometry.dims.y + voxel.y) * geometry.dims.x + voxel.x];
    }
    std::uint16_t code(glm::ivec3 voxel) const { return const_cast<SkipScene*>(this)->code(voxel); }
    CellVisibility visibility(double filterErrorSampled = 0.0) const {
        return cellVisibility(codes, texels, table, filterErrorSampled);
    }
};

/// Table texel k at value k, zero but for the texels first to last.
inline TransferTable bandTable(int size, int first, int last) {
    TransferTable table{0.0, double(size - 1), std::vector<glm::vec4>(size, glm::vec4(0.0F))};
    for (int k = first; k <= last; ++k) {
        table.texels[k] = glm::vec4(1.0F, 1.0F, 1.0F, 0.5F);
    }
    return table;
}

inline SkipScene constantScene(glm::ivec3 dims, std::uint16_t background, TransferTable table) {
    SkipScene scene;
    scene.geometry.dims = dims;
    scene.texels.dims = dims;
    scene.codes.dims = dims;
    scene.codes.codes.assign(std::size_t(dims.x) * dims.y * dims.z, background);
    for (int c = 0; c < 256; ++c) {
        scene.codes.lowSampled.push_back(float(c));
        scene.codes.highSampled.push_back(float(c));
    }
    scene.table = std::move(table);
    return scene;
}

/// Data value of the trilinear field at a point in voxel coordinates, clamped to the edge.
inline double fieldAt(const SkipScene& scene, glm::dvec3 point) {
    const glm::dvec3 base = glm::floor(point - 0.5);
    const glm::dvec3 weight = point - 0.5 - base;
    double sampled = 0.0;
    for (int corner = 0; corner < 8; ++corner) {
        const glm::ivec3 upper(corner & 1, (corner >> 1) & 1, corner >> 2);
        const glm::dvec3 share = glm::mix(1.0 - weight, weight, glm::dvec3(upper));
        const glm::ivec3 voxel =
            glm::clamp(glm::ivec3(base) + upper, glm::ivec3(0), scene.geometry.dims - 1);
        sampled += share.x * share.y * share.z * scene.code(voxel);
    }
    return scene.texels.valueScale * sampled + scene.texels.valueBias;
}

} // namespace slabcast::test
