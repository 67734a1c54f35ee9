#pragma once

#include <span>

#include "perf/stability/change_bound.h"

namespace slabcast::stability {

/// A number that a picture is made from.
struct Input {
    const char* name;
    /// Grows by so much of itself; an eye by so much of its distance from the volume's centre.
    void (*grow)(SampleSetup& setup, double share);
    TransferSlope (*slopes)(const TransferFunction& tf, double value); // none: no part of the TF
    bool passesSteps; // samples and the TF's points move against each other: past a step they jump
};

/// Of the eye, of lengths and of the transfer function, whose second point, a step's both, is the
/// one that is changed. Contract: there are points on either side of it.
std::span<const Input> perturbedInputs();

} // namespace slabcast::stability
