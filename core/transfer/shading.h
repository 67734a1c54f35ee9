#pragma once

namespace slabcast {

/// Blinn-Phong by the gradient of the data, two-sided. Where the gradient is too small to point
/// anywhere the unlit colour is kept: it fades in between `gradientFloor` and twice that.
struct ShadingParameters {
    double ambient = 0.25;
    double diffuse = 0.75;
    double specular = 0.25;
    double shininess = 32.0;
    double gradientFloorPerMm = 0.0; // data units per mm; 0: every gradient but none at all shades
};

/// 0 where the gradient says nothing, 1 where it is trusted: smoothstep from the floor to twice the
/// floor.
double shadingWeight(const ShadingParameters& parameters, double gradientPerMm);

/// Ambient + diffuse * |n.l|, which do not depend on the eye. Tested by: preclassified_test.cpp
double diffuseLight(const ShadingParameters& parameters, double cosine);

} // namespace slabcast
