#include "perf/model/paper_sampling.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/base/error.h"
#include "core/volume/texels.h"

namespace slabcast {

namespace {

constexpr int kLanes = 4; // of a quad

/// Squared distances along one line, by the lower envelope of parabolas (Felzenszwalb and
/// Huttenlocher 2012).
void transformLine(std::vector<float>& f, std::vector<float>& d, std::vector<int>& v,
                   std::vector<float>& z) {
    const int n = static_cast<int>(f.size());
    int k = 0;
    v[0] = 0;
    z[0] = -std::numeric_limits<float>::max();
    z[1] = std::numeric_limits<float>::max();
    const auto at = [&](int q) { return f[static_cast<std::size_t>(q)] + float(q) * float(q); };
    for (int q = 1; q < n; ++q) {
        float s = (at(q) - at(v[std::size_t(k)])) / float(2 * q - 2 * v[std::size_t(k)]);
        while (s <= z[std::size_t(k)]) {
            --k;
            s = (at(q) - at(v[std::size_t(k)])) / float(2 * q - 2 * v[std::size_t(k)]);
        }
        ++k;
        v[std::size_t(k)] = q;
        z[std::size_t(k)] = s;
        z[std::size_t(k) + 1] = std::numeric_limits<float>::max();
    }
    k = 0;
    for (int q = 0; q < n; ++q) {
        while (z[std::size_t(k) + 1] < float(q)) {
            ++k;
        }
        const float away = float(q - v[std::size_t(k)]);
        d[std::size_t(q)] = away * away + f[std::size_t(v[std::size_t(k)])];
    }
    f = d;
}

/// Squared distances to where `squared` is 0, along all three axes.
void transformCube(std::vector<float>& squared, int edge) {
    const auto e = static_cast<std::size_t>(edge);
    std::vector<float> line(e), out(e), bounds(e + 1);
    std::vector<int> parabolas(e);
    for (const std::size_t stride : {std::size_t{1}, e, e * e}) {
        for (std::size_t first = 0; first < e * e * e; ++first) {
            if (first / stride % e != 0) {
                continue;
            }
            for (std::size_t k = 0; k < e; ++k) {
                line[k] = squared[first + k * stride];
            }
            transformLine(line, out, parabolas, bounds);
            for (std::size_t k = 0; k < e; ++k) {
                squared[first + k * stride] = line[k];
            }
        }
    }
}

/// A ray of the view, in voxels, the volume's centre at the origin.
struct PaperRay {
    glm::dvec3 eye, perDepth; // eye + perDepth * depth is at that depth along the view axis
    glm::dvec3 along;         // one voxel long
};

class Counter {
public:
    Counter(const PaperVolume& volume, const PaperView& view, const PaperSettings& settings)
        : volume_(volume), settings_(settings), radius_(0.5 * std::sqrt(3.0) * volume.edge),
          distance_(view.eyeDistanceRadii * radius_),
          planes_((settings.totalLayers + settings.layersPerPlane - 1) / settings.layersPerPlane) {
        const double angle = glm::radians(view.azimuthDegrees);
        forward_ = {std::sin(angle), std::cos(angle), 0.0};
        right_ = {forward_.y, -forward_.x, 0.0};
    }

    /// Of the pixel at (x, y) of the disc's plane, in voxels.
    PaperRay rayAt(double x, double y) const {
        const glm::dvec3 toPlane = forward_ * distance_ + right_ * x + glm::dvec3(0, 0, y);
        return {-forward_ * distance_, toPlane / distance_, glm::normalize(toPlane)};
    }

    void count(const std::array<PaperRay, kLanes>& quad, PaperWork& work) const {
        const double thickness = settings_.layersPerPlane;
        for (int k = 0; k < planes_; ++k) {
            const double offset = (k + 0.5 - 0.5 * planes_) * thickness;
            countPlane(quad, offset, work);
        }
    }

private:
    bool inBox(glm::dvec3 p, double grown) const {
        const double half = 0.5 * volume_.edge + grown;
        return std::abs(p.x) <= half && std::abs(p.y) <= half && std::abs(p.z) <= half;
    }

    std::uint8_t distanceAt(glm::dvec3 p) const {
        const glm::ivec3 voxel(glm::floor(p + 0.5 * volume_.edge));
        return volume_.at(glm::clamp(voxel, glm::ivec3(0), glm::ivec3(volume_.edge - 1)));
    }

    void countPlane(const std::array<PaperRay, kLanes>& quad, double offset,
                    PaperWork& work) const {
        const double grown = 0.5 * (settings_.layersPerPlane - 1);
        std::array<glm::dvec3, kLanes> at{};
        std::array<bool, kLanes> active{};
        bool covered = false;
        bool any = false;
        for (std::size_t lane = 0; lane < kLanes; ++lane) {
            const PaperRay& ray = quad[lane];
            const glm::dvec3 point = ray.eye + ray.perDepth * (distance_ + offset);
            const bool drawn = glm::dot(point, point) <= radius_ * radius_;
            active[lane] = drawn && inBox(point, grown);
            at[lane] = point - ray.along * grown;
            covered |= drawn;
            any |= active[lane];
        }
        work.fragments += covered ? kLanes : 0;
        if (any) {
            work.segments += kLanes;
            countSegment(quad, at, active, work);
        }
    }

    void countSegment(const std::array<PaperRay, kLanes>& quad, std::array<glm::dvec3, kLanes> at,
                      const std::array<bool, kLanes>& active, PaperWork& work) const {
        std::array<int, kLanes> left{};
        for (int layer = 0; layer < settings_.layersPerPlane; ++layer) {
            bool leaps = false;
            bool tests = false;
            int fetching = 0;
            for (std::size_t lane = 0; lane < kLanes; ++lane) {
                if (active[lane] && left[lane] > 0) {
                    leaps = true;
                    --left[lane];
                } else if (active[lane]) {
                    tests = true;
                    if (inBox(at[lane], 0.0)) {
                        ++fetching;
                        left[lane] = settings_.skips ? distanceAt(at[lane]) : 0;
                    }
                }
                at[lane] += quad[lane].along;
            }
            work.layers += kLanes;
            work.leaps += leaps ? kLanes : 0;
            work.boxTests += tests ? kLanes : 0;
            work.fetches += fetching > 0 ? kLanes : 0;
            work.fetchesAlone += fetching;
        }
    }

    const PaperVolume& volume_;
    const PaperSettings& settings_;
    double radius_;
    double distance_; // of the eye, voxels
    int planes_;
    glm::dvec3 forward_{}, right_{};
};

} // namespace

PaperVolume paperVolume(const Volume& volume, const TransferFunction& tf) {
    const glm::ivec3 dims = volume.geometry.dims;
    SLABCAST_EXPECTS(dims.x == dims.y && dims.y == dims.z, dims.x);
    const VolumeStatistics statistics = computeStatistics(volume);
    const Texels texels = encodeTexels(volume, statistics, TexelFormat::R32fExact);
    const auto far = static_cast<float>(3 * dims.x * dims.x);
    std::vector<float> squared(static_cast<std::size_t>(dims.x) * dims.y * dims.z);
    const auto* values = reinterpret_cast<const float*>(texels.data.data());
    for (std::size_t k = 0; k < squared.size(); ++k) {
        const double value = texels.valueScale * double(values[k]) + texels.valueBias;
        squared[k] = evaluate(tf, value).opacity > 0.0 ? 0.0F : far;
    }
    transformCube(squared, dims.x);
    PaperVolume result{dims.x, std::vector<std::uint8_t>(squared.size())};
    std::transform(squared.begin(), squared.end(), result.distance.begin(), [](float one) {
        return static_cast<std::uint8_t>(std::min(std::sqrt(one), 255.0F));
    });
    return result;
}

PaperWork paperWork(const PaperVolume& volume, const PaperView& view,
                    const PaperSettings& settings) {
    SLABCAST_EXPECTS(view.discPixels >= 2 && view.everyQuad >= 1, view.discPixels);
    const Counter counter(volume, view, settings);
    const double radius = 0.5 * std::sqrt(3.0) * volume.edge;
    const double pixel = 2.0 * radius / view.discPixels;
    PaperWork work;
    double pixels = 0.0;
    const int stride = 2 * view.everyQuad;
    const int beyond = view.discPixels / 4; // near planes reach out of the disc
    for (int y = stride / 2 - beyond; y < view.discPixels + beyond; y += stride) {
        for (int x = stride / 2 - beyond; x < view.discPixels + beyond; x += stride) {
            const double px = (x + 1) * pixel - radius; // the quad's middle
            const double py = (y + 1) * pixel - radius;
            std::array<PaperRay, kLanes> quad{};
            for (std::size_t lane = 0; lane < kLanes; ++lane) {
                quad[lane] = counter.rayAt(px + (double(lane % 2) - 0.5) * pixel,
                                           py + (double(lane / 2) - 0.5) * pixel);
            }
            counter.count(quad, work);
            pixels += px * px + py * py <= radius * radius ? kLanes : 0;
        }
    }
    for (double PaperWork::*part : kPaperParts) {
        work.*part /= pixels;
    }
    return work;
}

} // namespace slabcast
