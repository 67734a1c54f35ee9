#include "core/draw/proxy_stack.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

namespace slabcast {

namespace {

/// Outlines are conservative already; these absorb float32 vertices, and the rasteriser's snapping
/// to 1/256 pixel.
constexpr double kGrow = 1.0 + 1e-4;
constexpr double kGrowPixels = 1.0 / 128.0;

struct Circle {
    glm::dvec2 centre{0.0};
    double radius = 0.0;
};

/// How far jitter may move a layer, view units.
double jitterReach(const RayFrame& frame) {
    return frame.lattice.jittered ? frame.spacing / 2.0 : 0.0;
}

/// Depths or distances, after the lattice's kind, that plane `p` covers.
struct Slab {
    double front;
    double back;
};

double latticeOrigin(const RayFrame& frame) {
    return frame.lattice.kind == LatticeKind::Planar ? frame.sphereCentre.z : frame.sphereDistance;
}

Slab slabOf(const RayFrame& frame, int plane, int layersPerPlane) {
    const double half = frame.lattice.total / 2.0;
    const double first = static_cast<double>(plane) * layersPerPlane;
    const double last = std::min(first + layersPerPlane, static_cast<double>(frame.lattice.total));
    return {latticeOrigin(frame) + (first - half) * frame.spacing - jitterReach(frame),
            latticeOrigin(frame) + (last - half) * frame.spacing + jitterReach(frame)};
}

Outline viewportOutline(const Frustum& f) {
    // sqrt(2): the 10-gon is drawn around the unit circle, which must hold the viewport's corners.
    return {{(f.left + f.right) / 2.0, (f.bottom + f.top) / 2.0},
            glm::dvec2(f.right - f.left, f.top - f.bottom) * (std::numbers::sqrt2 / 2.0 * kGrow)};
}

/// Circle around what a cone of half angle `spread` about the sphere's direction shows at unit
/// depth; none where the cone reaches 90 degrees off the axis. The image is an ellipse whose long
/// axis is the radial one.
std::optional<Circle> circleOfCone(const RayFrame& frame, double spread) {
    const glm::dvec2 lateral(frame.sphereCentre);
    const double offAxis = std::atan2(glm::length(lateral), frame.sphereCentre.z);
    if (offAxis + spread > glm::radians(89.0)) {
        return std::nullopt;
    }
    const double inner = std::tan(offAxis - spread);
    const double outer = std::tan(offAxis + spread);
    const glm::dvec2 radial =
        glm::length(lateral) > 0.0 ? glm::normalize(lateral) : glm::dvec2(1.0, 0.0);
    return Circle{radial * ((inner + outer) / 2.0), (outer - inner) / 2.0};
}

/// The sphere's silhouette; none from inside the sphere.
std::optional<Circle> silhouette(const RayFrame& frame) {
    return frame.sphereDistance > frame.radius
               ? circleOfCone(frame, std::asin(frame.radius / frame.sphereDistance))
               : std::nullopt;
}

/// Circle around the union of the sphere's discs over a slab of depths. A disc at depth z appears
/// at lateral/z with radius r(z)/z: bounded by the largest r seen from the nearest z, and the path
/// of the centre between.
std::optional<Circle> planarSlabCircle(const RayFrame& frame, const Slab& slab) {
    const double c = frame.sphereCentre.z;
    const double front = std::max(slab.front, c - frame.radius);
    const double back = std::min(slab.back, c + frame.radius);
    if (front > back) {
        return Circle{}; // rounding at the ends of the stack
    }
    const double nearest = std::clamp(c, front, back) - c;
    const double discRadius =
        std::sqrt(std::max(0.0, frame.radius * frame.radius - nearest * nearest));
    const glm::dvec2 lateral(frame.sphereCentre);
    const double travel = glm::length(lateral) * (1.0 / front - 1.0 / back) / 2.0;
    return Circle{lateral * ((1.0 / front + 1.0 / back) / 2.0), discRadius / front + travel};
}

/// As above for a slab of distances: the widest cone about the sphere's direction that the slab's
/// part of it needs.
std::optional<Circle> shellSlabCircle(const RayFrame& frame, const Slab& slab) {
    const double e = frame.sphereDistance;
    const double r = frame.radius;
    const double front = std::max(slab.front, e - r);
    const double back = std::min(slab.back, e + r);
    if (front > back) {
        return Circle{};
    }
    const double tangency =
        e > r ? std::sqrt(e * e - r * r) : 0.0; // the silhouette touches at this distance
    const double widest = std::clamp(tangency, front, back);
    const double cosine = (widest * widest + e * e - r * r) / (2.0 * widest * e);
    return cosine <= -1.0 || e == 0.0 ? std::nullopt
                                      : circleOfCone(frame, std::acos(std::min(cosine, 1.0)));
}

Outline sphereOutline(const RayFrame& frame, const Frustum& frustum, const Slab& slab) {
    // Shells of nearDepth reach less far in depth, so the test on the front serves both kinds.
    const double closest = std::max(frame.nearDepth, 1e-6 * frame.radius);
    if (slab.back <= frame.nearDepth || slab.back <= 0.0) {
        return {};
    }
    if (slab.front <= closest) {
        return viewportOutline(frustum);
    }
    std::optional<Circle> circle = frame.lattice.kind == LatticeKind::Planar
                                       ? planarSlabCircle(frame, slab)
                                       : shellSlabCircle(frame, slab);
    const std::optional<Circle> outer = silhouette(frame);
    if (!circle || (outer && outer->radius < circle->radius)) {
        circle = outer;
    }
    if (!circle) {
        return viewportOutline(frustum);
    }
    const Outline whole = viewportOutline(frustum);
    const glm::dvec2 halfView =
        glm::dvec2(frustum.right - frustum.left, frustum.top - frustum.bottom) / 2.0;
    const glm::dvec2 farthestCorner = glm::abs(circle->centre - whole.centre) + halfView;
    if (glm::length(farthestCorner) <= circle->radius) {
        return whole; // the same pixels without the seams that clipping a huge polygon may leave
    }
    const bool clearOfView =
        std::abs(circle->centre.x - whole.centre.x) > circle->radius * kGrow + whole.halfSize.x ||
        std::abs(circle->centre.y - whole.centre.y) > circle->radius * kGrow + whole.halfSize.y;
    return clearOfView ? Outline{} : Outline{circle->centre, glm::dvec2(circle->radius * kGrow)};
}

/// Takes the empty planes at both ends away and grows the others for the rasteriser.
void trim(ProxyStack& stack, const RayFrame& frame) {
    std::vector<Outline>& outlines = stack.outlines;
    const auto drawn = [](const Outline& o) { return !o.empty(); };
    for (Outline& o : outlines) {
        o.halfSize += drawn(o) ? frame.tangentPerPixel * kGrowPixels : glm::dvec2(0.0);
    }
    const auto first = std::find_if(outlines.begin(), outlines.end(), drawn);
    const auto last =
        std::find_if(outlines.rbegin(), std::make_reverse_iterator(first), drawn).base();
    stack.firstPlane = static_cast<int>(first - outlines.begin());
    outlines.erase(last, outlines.end());
    outlines.erase(outlines.begin(), outlines.begin() + stack.firstPlane);
}

struct Rectangle {
    glm::dvec2 low{std::numeric_limits<double>::infinity()};
    glm::dvec2 high{-std::numeric_limits<double>::infinity()};

    void include(glm::dvec2 l, glm::dvec2 h) {
        low = glm::min(low, l);
        high = glm::max(high, h);
    }
    Outline outline() const {
        return low.x < high.x && low.y < high.y
                   ? Outline{(low + high) / 2.0, (high - low) / 2.0 * kGrow}
                   : Outline{};
    }
};

/// A box as a view sees it: range of depth or distance, and rectangle in tangent space.
struct Appearance {
    double front = std::numeric_limits<double>::infinity();
    double back = -std::numeric_limits<double>::infinity();
    Rectangle rectangle;
    bool reachesEye = false;
    bool hidden =
        false; // by the near plane or behind the eye, with every layer that is sampled in it
};

Appearance appearance(const RayFrame& frame, const glm::dmat4& viewFromUvw, const VisibleBox& box) {
    const glm::dvec3 base = glm::dvec3(viewFromUvw * glm::dvec4(box.low, 1.0));
    const glm::dmat3 axes(viewFromUvw);
    const glm::dvec3 size = box.high - box.low;
    const glm::dvec3 centre = base + axes * (size * 0.5);
    const double closest = std::max(frame.nearDepth, 1e-6 * frame.radius);

    Appearance result;
    double farthest = 0.0;
    double reach = 0.0;
    for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec3 pick(corner & 1, corner >> 1 & 1, corner >> 2 & 1);
        const glm::dvec3 v = base + axes * (size * pick);
        const double depth = -v.z;
        result.front = std::min(result.front, depth);
        result.back = std::max(result.back, depth);
        farthest = std::max(farthest, glm::length(v));
        reach = std::max(reach, glm::length(v - centre));
        if (depth > closest) {
            result.rectangle.include(glm::dvec2(v) / depth, glm::dvec2(v) / depth);
        }
    }
    result.reachesEye = result.front <= closest;
    // A layer that the near plane cuts may be sampled before it, and shows up to half its depth
    // beyond its sample.
    result.hidden = result.back + frame.spacing / 2.0 <= std::max(frame.nearDepth, 0.0);
    if (frame.lattice.kind == LatticeKind::Shells) {
        // What lies behind the eye is sampled by the layer around the eye alone.
        result.front = result.front < 0.0 ? 0.0 : std::max(0.0, glm::length(centre) - reach);
        result.back = farthest;
    }
    return result;
}

} // namespace

void sphereStack(const RayFrame& frame, const Frustum& frustum, int planes, int layersPerPlane,
                 ProxyStack& stack) {
    stack.outlines.resize(static_cast<std::size_t>(planes));
    for (int p = 0; p < planes; ++p) {
        stack.outlines[p] = sphereOutline(frame, frustum, slabOf(frame, p, layersPerPlane));
    }
    trim(stack, frame);
}

void tightStack(const RayFrame& frame, const Frustum& frustum, const glm::dmat4& viewFromUvw,
                std::span<const VisibleBox> boxes, int planes, int layersPerPlane,
                ProxyStack& stack) {
    // Until all boxes are in, an outline holds its rectangle's corners.
    const Rectangle nothing;
    stack.outlines.assign(static_cast<std::size_t>(planes), {nothing.low, nothing.high});
    const glm::dvec2 viewLow(frustum.left, frustum.bottom);
    const glm::dvec2 viewHigh(frustum.right, frustum.top);
    const double half = frame.lattice.total / 2.0;
    // Layers that end before this show nothing: the near plane or the eye, as float32 may place it.
    const double nearest =
        std::max(frame.nearDepth, 0.0) - frame.spacing * (1e-3 + 0x1p-22 * frame.lattice.total);
    for (const VisibleBox& box : boxes) {
        const Appearance seen = appearance(frame, viewFromUvw, box);
        if (seen.hidden) {
            continue;
        }
        const glm::dvec2 low = seen.reachesEye ? viewLow : glm::max(seen.rectangle.low, viewLow);
        const glm::dvec2 high =
            seen.reachesEye ? viewHigh : glm::min(seen.rectangle.high, viewHigh);
        if (low.x > high.x || low.y > high.y) {
            continue;
        }
        const auto planeAt = [&](double place) {
            const double layer = (place - latticeOrigin(frame)) / frame.spacing + half;
            return static_cast<int>(
                std::clamp(std::floor(layer / layersPerPlane), 0.0, planes - 1.0));
        };
        const double shown = std::max(seen.front, nearest);
        const int last = planeAt(seen.back + jitterReach(frame));
        for (int p = planeAt(shown - jitterReach(frame)); p <= last; ++p) {
            Outline& corners = stack.outlines[p];
            corners.centre = glm::min(corners.centre, low);
            corners.halfSize = glm::max(corners.halfSize, high);
        }
    }
    for (Outline& o : stack.outlines) {
        o = Rectangle{o.centre, o.halfSize}.outline();
    }
    trim(stack, frame);
}

ProxyStack sphereStack(const RayFrame& frame, const Frustum& frustum, int planes,
                       int layersPerPlane) {
    ProxyStack stack;
    sphereStack(frame, frustum, planes, layersPerPlane, stack);
    return stack;
}

ProxyStack tightStack(const RayFrame& frame, const Frustum& frustum, const glm::dmat4& viewFromUvw,
                      std::span<const VisibleBox> boxes, int planes, int layersPerPlane) {
    ProxyStack stack;
    tightStack(frame, frustum, viewFromUvw, boxes, planes, layersPerPlane, stack);
    return stack;
}

Outline joined(std::span<const Outline> planes) {
    if (planes.size() == 1) {
        return planes.front();
    }
    Rectangle rectangle;
    for (const Outline& o : planes) {
        if (!o.empty()) {
            rectangle.include(o.centre - o.halfSize, o.centre + o.halfSize);
        }
    }
    return rectangle.outline();
}

std::span<const Outline> group(const ProxyStack& stack, std::size_t index, int planesPerOutline) {
    const std::size_t begin = index * static_cast<std::size_t>(planesPerOutline);
    const std::size_t end =
        std::min(begin + static_cast<std::size_t>(planesPerOutline), stack.outlines.size());
    return std::span(stack.outlines).subspan(begin, end - begin);
}

} // namespace slabcast
