#pragma once

#include <array>
#include <functional>

#include "core/reference/discrete.h"
#include "core/scene/scene.h"

namespace slabcast::stability {

/// All that a picture's samples are made of. Borrows the texels.
struct SampleSetup {
    const Texels* texels = nullptr;
    VolumeGeometry geometry;
    TransferFunction tf;
    View view;
    Lattice lattice;
};

std::vector<glm::dvec4> samplesOf(const SampleSetup& setup, glm::ivec2 size);

/// What a transfer function does as one of its numbers grows, by that number's logarithm.
struct TransferSlope {
    double opacity = 0.0;
    double color = 0.0;      // of any channel
    double extinction = 0.0; // of itself
};
using TransferSlopes = std::function<TransferSlope(const TransferFunction& tf, double value)>;

struct PixelChange {
    double bound = 0.0;
    bool covered = false;   // the volume is in it, before or after
    bool meetsStep = false; // a sample may pass a step of the transfer function: no bound holds
};

/// What a small change of an input may do to a pixel, by derivatives. With all colours in [0, 1], a
/// layer whose opacity is off by a and whose colour by c moves the pixel by at most T (a + alpha
/// c), T being what the layers before it let through. Along the chain: a sample moves in the box as
/// the rays say, its value by the field's steepest slopes in the cells at both ends, opacity and
/// colour by the steepest ramp that it may lie on and by the transfer function's own change, and
/// the layer's length as the rays say.
class ChangeBound {
public:
    /// `relative`: by how much the input has grown, of itself. `slopes`: empty where the transfer
    /// function is the same.
    ChangeBound(const SampleSetup& before, const SampleSetup& after, glm::ivec2 size,
                double relative, TransferSlopes slopes);
    PixelChange at(glm::dvec2 fragCoord) const;

private:
    double valueChange(glm::dvec3 from, glm::dvec3 to) const;
    glm::dvec2 steepest(double low, double high) const; // of opacity and colour, by value
    bool mayPassStep(double value, double change) const;
    double valueAt(glm::dvec3 uvw) const;

    const SampleSetup& before_;
    const SampleSetup& after_;
    RayFrame frameBefore_;
    RayFrame frameAfter_;
    double relative_;
    TransferSlopes slopes_;
    std::function<double(glm::dvec3 uvw)> field_;
    std::function<std::array<double, 8>(glm::ivec3 cell)> corners_;
};

} // namespace slabcast::stability
