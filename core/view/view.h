#pragma once

#include <array>

#include <glm/glm.hpp>

#include "core/base/error.h"
#include "core/volume/volume.h"

namespace slabcast {

/// The edges of what a view sees, as tangents at unit depth: left < right, bottom < top. Any
/// off-axis frustum.
struct Frustum {
    double left = -1.0;
    double right = 1.0;
    double bottom = -1.0;
    double top = 1.0;
};

/// Symmetric, from a vertical field of view.
Frustum symmetricFrustum(double verticalFovDegrees, double aspect);
/// Of a perspective matrix in GL's conventions, as an app or OpenXR runtime hands it over. Far is
/// not used. Fails: InvalidArgument (an orthographic or mirrored matrix, NaN). Tested by:
/// view_test.cpp
Result<Frustum> frustumOf(const glm::dmat4& clipFromView);

/// One eye. View space looks along -z; "depth" is -z, "distance" is from the eye.
struct View {
    glm::dmat4 viewFromModel{
        1.0}; // viewFromWorld * worldFromModel: rotation, translation, uniform scale
    Frustum frustum;
    double nearDepth = 0.0; // view units; nothing nearer is drawn. 0: from the eye on
};

/// Whether a picture can be made of it. Fails: InvalidArgument (NaN or infinite numbers, a matrix
/// that moves no space onto space, an empty frustum, a near plane behind the eye). Tested by:
/// view_test.cpp
Result<void> check(const View& view);

/// Rectangle of the target in pixels, origin at its lower left.
struct Viewport {
    int x = 0;
    int y = 0;
    int width = 0;
    int height = 0;
};

/// The eye at centre + distance x radius x (sin AZ cos EL, -cos AZ cos EL, sin EL) in patient space
/// (LPS, mm), looking at the centre, z up. Azimuth 0 sees the face. At the poles the picture's top
/// is the patient's front or back.
struct OrbitCamera {
    double azimuthDegrees = 0.0;
    double elevationDegrees = 10.0;
    double distanceRadii = 2.5;
};

glm::dmat4 viewFromModel(const OrbitCamera& camera, const BoundingSphere& sphere);

/// Two parallel eyes, the left one first, with off-axis frusta that meet at the depth
/// `convergence`. `eyeDistance` and `convergence` are in view units, which are mm where
/// viewFromModel does not scale. Each is a View like any other: drawn alone it gives the same
/// image.
std::array<View, 2> stereoViews(const View& centre, double eyeDistance, double convergence);

} // namespace slabcast
