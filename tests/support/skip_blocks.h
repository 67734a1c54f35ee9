#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include <glm/glm.hpp>

#include "core/skip/skip_structure.h"
#include "tests/support/property.h"
#include "tests/support/skip_scene.h"

// Grids of blocks by their words: every cell against every block, every block against every other.

namespace slabcast::test {

inline std::size_t indexOf(glm::ivec3 p, glm::ivec3 size) {
    return (std::size_t(p.z) * size.y + p.y) * size.x + p.x;
}

/// Calls visit(p) for all p with first <= p < end.
template <class Visit>
void forBox(glm::ivec3 first, glm::ivec3 end, Visit visit) {
    for (int z = first.z; z < end.z; ++z) {
        for (int y = first.y; y < end.y; ++y) {
            for (int x = first.x; x < end.x; ++x) {
                visit(glm::ivec3(x, y, z));
            }
        }
    }
}

/// Calls meets(index) for the blocks that a cell meets, cell by cell, of which `counts(least,
/// greatest)` is true of its corners' codes. All cells, half cells at the border (-1 and dims - 1)
/// included, against all blocks grown by one voxel, from their intervals alone.
template <class Counts, class Meets>
void forBlocksThatCellsMeet(const SkipScene& scene, int edge, Counts counts, Meets meets) {
    const glm::ivec3 dims = scene.geometry.dims;
    const glm::ivec3 blocks = blocksOf(dims, edge);
    forBox(glm::ivec3(-1), dims, [&](glm::ivec3 cell) {
        std::uint16_t least = 65535;
        std::uint16_t greatest = 0;
        forBox(cell, cell + 2, [&](glm::ivec3 corner) {
            const auto code = scene.code(glm::clamp(corner, glm::ivec3(0), dims - 1));
            least = std::min(least, code);
            greatest = std::max(greatest, code);
        });
        if (!counts(least, greatest)) {
            return;
        }
        const glm::dvec3 low = glm::max(glm::dvec3(cell) + 0.5, 0.0);
        const glm::dvec3 high = glm::min(glm::dvec3(cell) + 1.5, glm::dvec3(dims));
        forBox(glm::ivec3(0), blocks, [&](glm::ivec3 block) {
            const glm::dvec3 from = glm::dvec3(block * edge) - 1.0;
            const glm::dvec3 to = glm::dvec3((block + 1) * edge) + 1.0;
            if (glm::all(glm::lessThanEqual(low, to)) && glm::all(glm::lessThanEqual(from, high))) {
                meets(indexOf(block, blocks));
            }
        });
    });
}

/// 1 for the blocks that such a cell meets, else 0.
template <class Counts>
std::vector<std::uint8_t> blocksThatCellsMeet(const SkipScene& scene, int edge, Counts counts) {
    const glm::ivec3 blocks = blocksOf(scene.geometry.dims, edge);
    std::vector<std::uint8_t> met(std::size_t(blocks.x) * blocks.y * blocks.z);
    forBlocksThatCellsMeet(scene, edge, counts, [&](std::size_t block) { met[block] = 1; });
    return met;
}

inline std::vector<std::uint8_t> occupiedByTheWords(const SkipScene& scene,
                                                    const CellVisibility& visibility, int edge) {
    return blocksThatCellsMeet(scene, edge, [&](std::uint16_t least, std::uint16_t greatest) {
        return visibility.visible(least, greatest);
    });
}

/// Max-norm distances between all pairs; 255 beyond, and where there is no site.
inline std::vector<std::uint8_t> chebyshevByTheWords(const std::vector<std::uint8_t>& sites,
                                                     glm::ivec3 size) {
    std::vector<glm::ivec3> places;
    forBox(glm::ivec3(0), size, [&](glm::ivec3 p) {
        if (sites[indexOf(p, size)] != 0) {
            places.push_back(p);
        }
    });
    std::vector<std::uint8_t> distances;
    forBox(glm::ivec3(0), size, [&](glm::ivec3 p) {
        int nearest = 255;
        for (const glm::ivec3 site : places) {
            const glm::ivec3 away = glm::abs(site - p);
            nearest = std::min(nearest, std::max({away.x, away.y, away.z}));
        }
        distances.push_back(std::uint8_t(nearest));
    });
    return distances;
}

/// A few odd voxels in an even background: some free space, some blocks, bands between voxels.
inline SkipScene oddVoxels(int largestDim, int background, TransferTable table) {
    const auto dim = [&] { return anyInt(1, largestDim); };
    const glm::ivec3 dims(dim(), dim(), dim());
    SkipScene scene = constantScene(dims, std::uint16_t(background), std::move(table));
    const auto odd = anyPairs(intsInRange(0, int(scene.codes.codes.size())), intsInRange(0, 256));
    for (const auto& [voxel, code] : odd) {
        scene.codes.codes[voxel] = std::uint16_t(code);
    }
    return scene;
}

/// The same under a TF of one band.
inline SkipScene randomScene(int largestDim) {
    const int first = anyInt(2, 256);
    const int last = std::min(255, first + anyElement(0, 1, 5, 100));
    return oddVoxels(largestDim, anyElement(0, 0, 128, 255), bandTable(256, first, last));
}

inline int randomEdge() {
    return anyElement(1, 2, 4, 8);
}

} // namespace slabcast::test
