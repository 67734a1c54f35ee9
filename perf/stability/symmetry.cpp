#include "perf/stability/symmetry.h"

#include <algorithm>
#include <cmath>

#include <glm/gtc/matrix_transform.hpp>

namespace slabcast::stability {

double lopsided(glm::ivec3 v) {
    return 130.0 + 55.0 * std::sin(0.7 * v.x + 0.3) * std::cos(0.5 * v.y) +
           45.0 * std::sin(0.4 * v.z + 0.2 * v.x);
}

TransferFunction lopsidedTransfer(double opacityUnitMm) {
    return {.name = "lopsided",
            .opacityUnitMm = opacityUnitMm,
            .points = {{30.0, {0.1, 0.4, 0.9}, 0.02}, {230.0, {1.0, 0.7, 0.2}, 0.3}}};
}

glm::dmat3 obliqueAxes() {
    return glm::dmat3(glm::rotate(glm::dmat4(1.0), 0.6, glm::dvec3(0.48, 0.6, 0.64)));
}

Volume placedAt(Volume volume, glm::dvec3 originMm, const glm::dmat3& direction) {
    volume.geometry.originMm = originMm;
    volume.geometry.direction = direction;
    Result<Volume> placed = validated(std::move(volume));
    SLABCAST_EXPECTS(placed.has_value(), originMm.x);
    return std::move(*placed);
}

std::string Storage::name() const {
    std::string text;
    for (int k = 0; k < 3; ++k) {
        text += k == 0 ? "" : " ";
        text += flipped[k] < 0 ? '-' : '+';
        text += "xyz"[axis[k]];
    }
    return text;
}

std::vector<Storage> allStorages() {
    std::vector<Storage> all;
    glm::ivec3 axis(0, 1, 2);
    do {
        for (int signs = 0; signs < 8; ++signs) {
            const glm::ivec3 back(signs & 1, signs >> 1 & 1, signs >> 2);
            all.push_back({axis, 1 - 2 * back});
        }
    } while (std::next_permutation(&axis.x, &axis.x + 3));
    return all;
}

Volume storedAs(const Storage& storage, const VolumeGeometry& original,
                const std::function<double(glm::ivec3)>& formula) {
    glm::ivec3 dims;
    glm::dvec3 spacingMm;
    glm::dmat3 direction;
    glm::dvec3 originMm = original.originMm;
    for (int k = 0; k < 3; ++k) {
        const int from = storage.axis[k];
        dims[k] = original.dims[from];
        spacingMm[k] = original.spacingMm[from];
        direction[k] = original.direction[from] * double(storage.flipped[k]);
        if (storage.flipped[k] < 0) { // its first voxel is the original's last
            originMm += original.direction[from] * (spacingMm[k] * (dims[k] - 1));
        }
    }
    const auto stored = [&](glm::ivec3 v) {
        glm::ivec3 at;
        for (int k = 0; k < 3; ++k) {
            at[storage.axis[k]] = storage.flipped[k] < 0 ? dims[k] - 1 - v[k] : v[k];
        }
        return formula(at);
    };
    return placedAt(formulaVolume(dims, VoxelType::U8, stored, spacingMm), originMm, direction);
}

double shareOfBothBounds(const Picture& a, const ExpectedPicture& ofA, const Picture& b,
                         const ExpectedPicture& ofB, double more) {
    double worst = 0.0;
    for (std::size_t i = 0; i < a.pixels.size(); ++i) {
        if (ofA[i].atEdge || ofB[i].atEdge) {
            continue;
        }
        const glm::dvec4 off = glm::abs(glm::dvec4(a.pixels[i]) - glm::dvec4(b.pixels[i]));
        const double most = std::max({off.x, off.y, off.z, off.w});
        const double bound = ofA[i].bound + ofB[i].bound + more;
        const double share = most == 0.0 ? 0.0 : most / bound;
        worst = largerOf(worst, share);
    }
    return worst;
}

void symmetryCases(Bench& bench) {
    storedAxesCases(bench);
    mirrorCases(bench);
    unitScaleCases(bench);
}

} // namespace slabcast::stability
