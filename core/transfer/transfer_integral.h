#pragma once

#include <vector>

#include <glm/glm.hpp>

#include "core/transfer/transfer_function.h"

namespace slabcast {

/// Integrals of a continuous TF over values, of (extinction x colour, extinction): colour in the
/// compositing space, extinction in 1/mm. The TF is cut where it is no longer smooth or steep in a
/// logarithm, and every piece is taken by Gauss and Legendre's rule of eight points, whose relative
/// error there is below 1e-11. Sums of positive terms only, so that a faint material keeps its
/// digits beside a dense one. Built in O(points).
/// Tested by: preintegrated_test.cpp
class TransferIntegral {
public:
    TransferIntegral(const TransferFunction& tf, CompositingSpace space);

    /// Mean over an interval along which the field runs linearly from one value to the other, in
    /// either direction; at one value what the TF is there. Values within +-1e300.
    glm::dvec4 mean(double front, double back) const;

private:
    struct Piece {
        double low, high;
        TransferSample atLow, atHigh;
        glm::dvec4 whole{0.0}; // its integral
    };
    void addSegment(const TransferPoint& left, const TransferPoint& right);
    void addPiece(double low, double high, const TransferSample& atLow,
                  const TransferSample& atHigh);
    glm::dvec4 material(const TransferSample& sample) const;
    glm::dvec4 between(const Piece& piece, double low, double high) const;

    TransferFunction tf_;
    CompositingSpace space_;
    std::vector<Piece> pieces_; // by value, without gaps
};

} // namespace slabcast
