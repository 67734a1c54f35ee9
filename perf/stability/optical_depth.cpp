#include <algorithm>
#include <cmath>

#include "core/reference/continuous.h"
#include "core/reference/discrete.h"
#include "perf/stability/expected.h"
#include "perf/stability/volumes.h"

namespace slabcast::stability {

namespace {

constexpr const char* kFamily = "optical-depth";
constexpr int kEdge = 16; // voxels of 1 mm: a ray along an axis meets 16 whole layers
constexpr int kLeastExponent = -8;
constexpr int kMostExponent = 8;
constexpr glm::ivec2 kSize(5, 5);
constexpr glm::dvec2 kMiddle(2.5, 2.5); // whose ray runs along the axis
constexpr glm::dvec3 kColor(1.0, 0.5, 0.25);

/// A medium, its optical depth across the volume and what that makes of alpha.
struct Depth {
    double nominal = 0.0;
    double extinction = 0.0; // 11 bits, which the table's fp16 holds
    double depth() const { return extinction * kEdge; }
    double alpha() const { return -std::expm1(-depth()); }
};

Depth depthNear(double nominal) {
    int exponent = 0;
    const double mantissa = std::frexp(nominal / kEdge, &exponent);
    return {nominal, std::ldexp(std::round(std::ldexp(mantissa, 11)), exponent - 11)};
}

std::vector<Depth> depths(int perDecade) {
    std::vector<Depth> all;
    for (int i = kLeastExponent * perDecade; i <= kMostExponent * perDecade; ++i) {
        all.push_back(depthNear(std::pow(10.0, double(i) / perDecade)));
    }
    return all;
}

/// Half opaque over whatever length that takes.
Appearance appearanceOf(const Depth& depth) {
    return {.tf = uniformTransfer(0.5, kColor, -std::log1p(-0.5) / depth.extinction)};
}

View viewOf(const Scene& scene) {
    return orbitView(scene, {0.0, 0.0, 6.0}, 10.0, kSize);
}

Settings settingsFor(TargetFormat target, int layersPerPlane) {
    return settingsOf({.name = "", .layersPerPlane = layersPerPlane, .target = target});
}

// --- What alpha may be off by, of itself ---

/// 16 layers or cells: per layer three roundings of the sum, and a dozen of depth and exponential.
double float64Bound(const Depth&) {
    return (3.0 * kEdge + 12.0) * 0x1p-53;
}

/// A ray ends where less than the tolerance would still show: from a depth of 29.9 on.
constexpr double kTolerance = 1e-13;
double integralBound(const Depth& depth) {
    return float64Bound(depth) + (depth.depth() > 29.0 ? kTolerance : 0.0);
}

/// GLES gives exp() 3 + 2 |x| units in the last place; below 1/32 a series takes its place, whose
/// relative error is 2^-23. Lengths and depths are rounded six times, the sum three times a layer.
double float32Bound(const Depth& depth) {
    const double layer = depth.depth() / kEdge;
    const double ofSum = (3.0 * kEdge + 8.0) * 0x1p-24;
    if (layer < 0.03) {
        return ofSum;
    }
    const double ofExp = (3.0 + 2.0 * layer) * 0x1p-23 * std::exp(-layer) + 0x1p-25;
    return ofSum + ofExp / -std::expm1(-layer);
}

/// A step of what is stored, for a device may take either neighbour: 2^-10 of itself, or 2^-24
/// where digits are lost.
double halfBound(const Depth& depth) {
    return float32Bound(depth) + std::max(0x1p-10, 0x1p-24 / depth.alpha());
}

double byteBound(const Depth& depth) {
    return float32Bound(depth) + 1.0 / 510.0 / depth.alpha();
}

// --- Ways to evaluate ---

using Ray = Result<glm::dvec4>;

Ray middleOf(const Result<Picture>& picture) {
    if (!picture) {
        return tl::unexpected(picture.error());
    }
    return glm::dvec4(picture->pixels[picture->pixels.size() / 2]);
}

Ray bySamples(Bench& bench, const Scene& scene) {
    const Result<FramePlan> plan = bench.plan(scene, settingsFor(TargetFormat::Rgba16f, 1));
    if (!plan) {
        return tl::unexpected(plan.error());
    }
    const DiscreteInput input{.texels = &scene.texels(),
                              .geometry = scene.geometry(),
                              .transfer = scene.look().tf,
                              .view = viewOf(scene),
                              .viewport = {0, 0, kSize.x, kSize.y},
                              .lattice = plan->lattice};
    const std::vector<glm::dvec4> pixels = renderDiscrete(input);
    return pixels[pixels.size() / 2];
}

Ray byIntegral(Bench&, const Scene& scene) {
    return integrateRay({.texels = &scene.texels(),
                         .geometry = scene.geometry(),
                         .tf = scene.look().tf,
                         .view = viewOf(scene),
                         .viewport = {0, 0, kSize.x, kSize.y},
                         .tolerance = kTolerance},
                        kMiddle);
}

Ray inFloat32(Bench& bench, const Scene& scene) {
    const Result<FramePlan> plan =
        bench.plan(scene, settingsFor(TargetFormat::Rgba16f, kAllLayers));
    return plan ? middleOf(bench.drawFinely(scene, *plan, viewOf(scene), kSize))
                : tl::unexpected(plan.error());
}

template <TargetFormat kTarget, int kLayersPerPlane>
Ray drawn(Bench& bench, const Scene& scene) {
    return middleOf(bench.draw(scene, settingsFor(kTarget, kLayersPerPlane), viewOf(scene), kSize)
                        .map([](const Drawn& result) { return result.picture; }));
}

struct Way {
    const char* name;
    Ray (*evaluate)(Bench& bench, const Scene& scene);
    double (*bound)(const Depth& depth); // none: of many planes, whose roundings add up
    double step;                         // at 1, which is all that alpha may fall by
    const char* reason;
};

constexpr Way kWays[] = {
    {"float64 samples", bySamples, float64Bound, 60.0 * 0x1p-53,
     "alpha = 1 - exp(-depth), of which no digit is lost by a difference from 1: three roundings "
     "of 2^-53 a layer and a dozen"},
    {"float64 integral", byIntegral, integralBound, 60.0 * 0x1p-53 + kTolerance,
     "alpha = 1 - exp(-depth), of which no digit is lost by a difference from 1: three roundings "
     "of 2^-53 a cell and a dozen; and 1e-13 where the ray ends before what would show less"},
    {"float32", inFloat32, float32Bound, 56.0 * 0x1p-24,
     "three roundings of 2^-24 a layer and eight; from a layer's depth of 1/32 on also that of "
     "exp(), 3 + 2 |x| units in the last place by GLES 3.2, beside the layer's opacity"},
    {"rgba16f", drawn<TargetFormat::Rgba16f, kAllLayers>, halfBound, 0x1p-10,
     "as float32, and one step of fp16: 2^-10 of itself, and 2^-24 where that is more"},
    {"rgba8", drawn<TargetFormat::Rgba8, kAllLayers>, byteBound, 1.0 / 255.0,
     "as float32, and half a step of 8 bits, 1/510, which is all of a depth below 1/510"},
    {"rgba16f, slicing", drawn<TargetFormat::Rgba16f, 1>, nullptr, 0.0, ""},
    {"rgba8, slicing", drawn<TargetFormat::Rgba8, 1>, nullptr, 0.0, ""}};

/// Alpha against the closed form, at every decade.
void recordAccuracy(Bench& bench, const Way& way, const Depth& depth, const Ray& ray) {
    Case c{.family = kFamily,
           .name = named({"depth " + number(depth.nominal), way.name}),
           .quantity = "error of alpha, of itself",
           .bound = way.bound(depth),
           .reason = way.reason};
    if (!ray) {
        return bench.recordFailure(std::move(c), ray.error());
    }
    c.measured = std::abs(ray->a - depth.alpha()) / depth.alpha();
    c.series = Series{.group = way.name,
                      .panel = "",
                      .x = depth.nominal,
                      .y = c.measured,
                      .xLabel = "optical depth",
                      .yLabel = "error of alpha, of itself",
                      .bound = c.bound};
    bench.record(std::move(c));
}

/// Over all depths: nothing that is no number, negative or above 1; and that alpha only rises.
class Course {
public:
    explicit Course(const Way& way) : way_(way) {}

    void add(const Ray& ray) {
        if (!ray) {
            error_ = ray.error();
            return;
        }
        for (int k = 0; k < 4; ++k) {
            outside_ += !((*ray)[k] >= 0.0 && (*ray)[k] <= 1.0); // NaN is neither
        }
        if (ray->a < last_) {
            fall_ = largerOf(fall_, (last_ - ray->a) / last_);
        }
        last_ = ray->a;
    }

    void record(Bench& bench) const {
        record(bench, {.family = kFamily,
                       .name = named({"all depths", "range", way_.name}),
                       .quantity = "components that are no number, negative or above 1",
                       .reason = "an opacity is a share, and a colour a part of it",
                       .measured = double(outside_)});
        if (way_.bound != nullptr) {
            record(bench,
                   {.family = kFamily,
                    .name = named({"all depths", "rising", way_.name}),
                    .quantity = "largest fall of alpha from one depth to the next, of itself",
                    .bound = way_.step,
                    .reason = "alpha rises by far more than it is rounded by until it is nearly 1, "
                              "where it may fall by rounding: a step of the format, or as much as "
                              "the sum of the layers is rounded",
                    .measured = fall_});
        }
    }

private:
    void record(Bench& bench, Case c) const {
        error_ ? bench.recordFailure(std::move(c), *error_) : bench.record(std::move(c));
    }

    const Way& way_;
    std::optional<Error> error_;
    int outside_ = 0;
    double fall_ = 0.0;
    double last_ = 0.0;
};

} // namespace

void opticalDepthCases(Bench& bench) {
    const int perDecade = bench.reduced() ? 2 : 10;
    Result<Scene> scene = bench.scene(
        formulaVolume(glm::ivec3(kEdge), VoxelType::U8, [](glm::ivec3) { return 100.0; }),
        appearanceOf(depthNear(1.0)), {.structure = SkipStructure::None});
    if (!scene) {
        return bench.recordFailure({.family = kFamily, .name = "medium"}, scene.error());
    }
    const std::vector<Depth> all = depths(perDecade);
    for (const Way& way : kWays) {
        if (way.evaluate == inFloat32 && !bench.caps().floatBlend) {
            continue; // rgba16f is the finest
        }
        Course course(way);
        for (std::size_t i = 0; i < all.size(); ++i) {
            const Result<void> shown =
                show(*scene, appearanceOf(all[i]), {.structure = SkipStructure::None});
            const Ray ray = shown ? way.evaluate(bench, *scene) : tl::unexpected(shown.error());
            course.add(ray);
            if (way.bound != nullptr && i % std::size_t(perDecade) == 0) {
                recordAccuracy(bench, way, all[i], ray);
            }
        }
        course.record(bench);
    }
}

} // namespace slabcast::stability
