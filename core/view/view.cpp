#include "core/view/view.h"

#include <cmath>

#include <glm/gtc/matrix_transform.hpp>

namespace slabcast {

Frustum symmetricFrustum(double verticalFovDegrees, double aspect) {
    const double top = std::tan(glm::radians(verticalFovDegrees) / 2.0);
    return {-top * aspect, top * aspect, -top, top};
}

namespace {

bool isFinite(const glm::dmat4& m) {
    for (int column = 0; column < 4; ++column) {
        for (int row = 0; row < 4; ++row) {
            if (!std::isfinite(m[column][row])) {
                return false;
            }
        }
    }
    return true;
}

/// NaN makes every comparison false.
bool isOpen(const Frustum& f) {
    return std::isfinite(f.left) && std::isfinite(f.right) && std::isfinite(f.bottom) &&
           std::isfinite(f.top) && f.left < f.right && f.bottom < f.top;
}

} // namespace

Result<Frustum> frustumOf(const glm::dmat4& clipFromView) {
    const glm::dmat4& m = clipFromView;
    const double w = -m[2][3]; // clip.w = w * depth
    const bool perspective = m[0][3] == 0.0 && m[1][3] == 0.0 && m[3][3] == 0.0 && w > 0.0;
    const bool upright = m[0][1] == 0.0 && m[1][0] == 0.0 && m[3][0] == 0.0 && m[3][1] == 0.0;
    if (!isFinite(m) || !perspective || !upright) {
        return fail(ErrorCode::InvalidArgument,
                    "the projection is not a perspective one in GL's conventions (an orthographic "
                    "matrix, one that turns the picture, or NaN): give what glFrustum would");
    }
    // ndc.x = m00 * x/depth - m20 (with w = -z): solve for ndc.x = -1 and +1, likewise y.
    const Frustum f{(m[2][0] - w) / m[0][0], (m[2][0] + w) / m[0][0], (m[2][1] - w) / m[1][1],
                    (m[2][1] + w) / m[1][1]};
    if (!isOpen(f)) {
        return fail(ErrorCode::InvalidArgument,
                    "the projection's frustum is empty or mirrored: x to the right, y up");
    }
    return f;
}

Result<void> check(const View& view) {
    const glm::dmat4& m = view.viewFromModel;
    const glm::dmat3 axes(m);
    const double lengths = glm::length(axes[0]) * glm::length(axes[1]) * glm::length(axes[2]);
    const double volume = std::abs(glm::determinant(axes));
    constexpr double kFlat = 1e-6; // of the box that axes at right angles would span
    const bool affine = m[0][3] == 0.0 && m[1][3] == 0.0 && m[2][3] == 0.0 && m[3][3] == 1.0;
    if (!isFinite(m) || !affine || !(volume > kFlat * lengths)) {
        return fail(ErrorCode::InvalidArgument,
                    "viewFromModel is no rotation, translation and uniform scale: it holds NaN, "
                    "flattens space or projects");
    }
    if (!isOpen(view.frustum)) {
        return fail(ErrorCode::InvalidArgument,
                    "the view's frustum is empty: left < right and bottom < top are needed, as "
                    "tangents at unit depth");
    }
    if (!(view.nearDepth >= 0.0) || !std::isfinite(view.nearDepth)) {
        return fail(ErrorCode::InvalidArgument,
                    "the view's near plane lies behind the eye: give nearDepth from 0 on");
    }
    return {};
}

glm::dmat4 viewFromModel(const OrbitCamera& camera, const BoundingSphere& sphere) {
    const double az = glm::radians(camera.azimuthDegrees);
    const double el = glm::radians(camera.elevationDegrees);
    const glm::dvec3 outward(std::sin(az) * std::cos(el), -std::cos(az) * std::cos(el),
                             std::sin(el));
    // An explicit basis instead of lookAt: no cross product with "up", so the poles are like any
    // other place.
    const glm::dvec3 right(std::cos(az), std::sin(az), 0.0);
    const glm::dvec3 up = glm::cross(outward, right);
    const glm::dmat3 viewFromModelRotation = glm::transpose(glm::dmat3(right, up, outward));
    // The centre lies exactly on the axis: -distance along z, free of cancellation from far away.
    const glm::dvec3 centreInView(0.0, 0.0, -camera.distanceRadii * sphere.radiusMm);
    glm::dmat4 result(viewFromModelRotation);
    result[3] = glm::dvec4(centreInView - viewFromModelRotation * sphere.centreMm, 1.0);
    return result;
}

std::array<View, 2> stereoViews(const View& centre, double eyeDistance, double convergence) {
    std::array<View, 2> eyes{centre, centre};
    for (int eye = 0; eye < 2; ++eye) {
        const double offset = (eye == 0 ? -0.5 : 0.5) * eyeDistance;
        eyes[eye].viewFromModel =
            glm::translate(glm::dmat4(1.0), {-offset, 0.0, 0.0}) * centre.viewFromModel;
        eyes[eye].frustum.left -= offset / convergence;
        eyes[eye].frustum.right -= offset / convergence;
    }
    return eyes;
}

} // namespace slabcast
