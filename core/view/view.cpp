#include "core/view/view.h"

#include <cmath>

#include <glm/gtc/matrix_transform.hpp>

namespace slabcast {

Frustum symmetricFrustum(double verticalFovDegrees, double aspect) {
    const double top = std::tan(glm::radians(verticalFovDegrees) / 2.0);
    return {-top * aspect, top * aspect, -top, top};
}

Frustum frustumOf(const glm::dmat4& clipFromView) {
    // ndc.x = m00 * x/depth - m20 (with w = -z): solve for ndc.x = -1 and +1, likewise y.
    const double m00 = clipFromView[0][0];
    const double m11 = clipFromView[1][1];
    const double m20 = clipFromView[2][0];
    const double m21 = clipFromView[2][1];
    return {(m20 - 1.0) / m00, (m20 + 1.0) / m00, (m21 - 1.0) / m11, (m21 + 1.0) / m11};
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
