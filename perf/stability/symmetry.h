#pragma once

#include <vector>

#include "perf/stability/bench.h"
#include "perf/stability/expected.h"
#include "perf/stability/volumes.h"

namespace slabcast::stability {

/// Parts of the symmetry family.
void storedAxesCases(Bench& bench);
void mirrorCases(Bench& bench);
void unitScaleCases(Bench& bench);

inline constexpr const char* kSymmetryFamily = "symmetry";

/// Values of 30 to 230 without any symmetry of their own.
double lopsided(glm::ivec3 voxel);
/// From faint to dense between them.
TransferFunction lopsidedTransfer(double opacityUnitMm = 1.0);
/// Axes that lie along none of the patient's, at right angles to each other.
glm::dmat3 obliqueAxes();
/// The volume with another place in patient space. Contract: direction cosines that span it.
Volume placedAt(Volume volume, glm::dvec3 originMm, const glm::dmat3& direction);

/// The same field stored otherwise: along voxel axis k it runs along axis[k] of the original,
/// backwards where flipped[k] is -1.
struct Storage {
    glm::ivec3 axis{0, 1, 2};
    glm::ivec3 flipped{1};

    std::string name() const; // "+y -x +z"
};
/// All 48 signed permutations, the original first.
std::vector<Storage> allStorages();
/// `formula` on the original's grid, of which origin, spacing and direction cosines are given.
Volume storedAs(const Storage& storage, const VolumeGeometry& original,
                const std::function<double(glm::ivec3)>& formula);

/// Worst share of what two pictures may be apart: each is within its own bound of the same float64
/// samples. Rays that graze the box are left out. NaN where a pixel is.
double shareOfBothBounds(const Picture& a, const ExpectedPicture& ofA, const Picture& b,
                         const ExpectedPicture& ofB, double more);

} // namespace slabcast::stability
