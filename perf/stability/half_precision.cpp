#include <algorithm>
#include <cmath>

#include "perf/stability/bench.h"
#include "perf/stability/volumes.h"

namespace slabcast::stability {

namespace {

constexpr double kUnit = 0x1p-11; // unit roundoff of fp16
constexpr glm::ivec2 kSize(64, 64);

struct HalfScene {
    const char* name;
    std::function<double(glm::ivec3)> formula; // 0 to 20,000
    TransferFunction tf;
    double layerSpacingVoxels;
};

TransferFunction rampTransfer(double least, double most) {
    return {.name = "ramp",
            .points = {{0.0, {0.9, 0.3, 0.1}, least}, {20000.0, {0.1, 0.5, 1.0}, most}}};
}

double waves(glm::ivec3 v) {
    return 10000.0 +
           9900.0 * std::sin(v.x * 0.4) * std::cos(v.y * 0.3) * std::sin(v.z * 0.35 + 1.0);
}

/// Neighbouring texels of these tables are within a factor of two of each other: a bound on what
/// rounding their interpolation does to extinction needs that. 16 bits, since a filter of 8-bit
/// texels may give nothing between two table texels.
std::vector<HalfScene> scenes(bool reduced) {
    std::vector<HalfScene> all = {
        {"translucent", waves, rampTransfer(0.02, 0.2), 0.5},
        {"opaque", waves, rampTransfer(0.5, 0.999), 1.0},
        {"faint, 1,300 layers", waves, rampTransfer(2e-3, 4e-3), 1.0 / 16.0}};
    if (reduced) {
        all.resize(1);
    }
    return all;
}

/// What one group may do to a pixel. With T the transmittance before a layer and a its opacity, the
/// sum of T a over a ray is its opacity A: an error of e in every layer's own share moves the pixel
/// by e A, and by as much again through what the layers cover.
struct Ray {
    double layers;          // on the longest ray
    double layersOfSegment; // at most
    double opacity;         // A, the picture's largest
};

double opacityBound(const Ray& ray) {
    return 2.0 * (33.0 * kUnit * ray.opacity + ray.layers * 0x1p-25);
}
double sumBound(const Ray& ray) {
    const double halfStep = std::ldexp(1.0, std::ilogb(ray.opacity) - 11); // of the largest sum
    const double ofSegment = ray.layersOfSegment * halfStep + 2.0 * kUnit * ray.opacity;
    return (ray.layersOfSegment < ray.layers ? 2.0 : 1.0) * ofSegment;
}
double extinctionBound(const Ray& ray) {
    return 12.0 * kUnit * ray.opacity;
}
double colorBound(const Ray& ray) {
    return 4.0 * kUnit * ray.opacity;
}
double lightBound(const Ray& ray) {
    return 11.0 * (kUnit * ray.opacity + ray.layers * 0x1p-25);
}
/// Toward zero each rounding errs by twice as much.
double sumCutOffBound(const Ray& ray) {
    return 2.0 * sumBound(ray);
}
double everyBound(const Ray& ray) {
    return opacityBound(ray) + sumBound(ray) + extinctionBound(ray) + colorBound(ray) +
           lightBound(ray);
}
/// Half a step of 8 bits.
double unseenBound(const Ray& /*ray*/) {
    return 1.0 / 510.0;
}

/// Which programs hold a group's operations.
enum class Text {
    PerRay,       // colour and extinction, by the filter of the table where the device's serves
    FetchedTable, // by two fetches
    Baked,        // premultiplied colour and opacity: shells
};

struct Group {
    const char* name;
    int bits;
    Text text;
    bool shaded;
    double (*bound)(const Ray& ray);
    const char* reason;
};

constexpr const char* kLightReason =
    "eleven roundings of values up to 1, or up to the layer's opacity: 11 (u A + layers 2^-25)";
constexpr const char* kDeclaredReason = "what the shaders declare mediump must stay below half a "
                                        "step of 8 bits, to nearest and cut off";

constexpr Group kGroups[] = {
    {"opacity", kHalfOpacity, Text::PerRay, false, opacityBound,
     "from a depth of 1/32 on, 1 - exp(-d) is off by 2u, which is at most 33u of itself; below, "
     "its "
     "series by 4u of itself; and by half of fp16's smallest step: 2 (33u A + layers 2^-25)"},
    {"sum", kHalfSum, Text::PerRay, false, sumBound,
     "each of a segment's n layers rounds the sum by half a step of A at most, and its own share "
     "twice: n step/2 + 2u A; as much again through what the segment covers, where others follow"},
    {"sum (cut off)", kHalfSum + kHalfCutOff, Text::PerRay, false, sumCutOffBound,
     "as the sum, and twice as much, since no rounding is to nearest"},
    {"extinction", kHalfExtinction, Text::FetchedTable, false, extinctionBound,
     "texels within a factor of two interpolate to 6u of the extinction, and so of the opacity: "
     "2 x 6u A"},
    {"colour", kHalfColor, Text::FetchedTable, false, colorBound,
     "texels interpolate to 3u, whose product with the opacity adds u: 4u A"},
    {"light", kHalfLight, Text::PerRay, true, lightBound, kLightReason},
    {"light of premultiplied colours", kHalfLight, Text::Baked, true, lightBound, kLightReason},
    {"all", kHalfAll, Text::FetchedTable, true, everyBound, "the sum of the five groups' bounds"},
    {"declared mediump (light)", kHalfDeclared, Text::PerRay, true, unseenBound, kDeclaredReason},
    {"declared mediump (as this device does it)", 0, Text::PerRay, true, unseenBound,
     kDeclaredReason},
    {"declared mediump (light; cut off)", kHalfDeclared + kHalfCutOff, Text::PerRay, true,
     unseenBound, kDeclaredReason},
    {"declared mediump (light of premultiplied colours; cut off)", kHalfDeclared + kHalfCutOff,
     Text::Baked, true, unseenBound, kDeclaredReason}};

/// `exactly`: whose programs round nothing; `rounding`: whose round the group.
void measure(Bench& bench, Renderer& exactly, Renderer& rounding, const Scene& scene,
             const HalfScene& setup, const Group& group, const Method& method) {
    Settings settings = settingsOf(method);
    settings.layerSpacingVoxels = setup.layerSpacingVoxels;
    settings.form = SegmentForm::Loop;
    settings.shaded = group.shaded;
    settings.lattice = group.text == Text::Baked ? LatticeKind::Shells : LatticeKind::Planar;
    const std::string methodName = method.name;
    Case result{.family = "half-precision",
                .name = std::string(group.name) + ", " + setup.name + ", " +
                        methodName.substr(0, methodName.find(',')),
                .quantity = "largest difference from float32, of full scale",
                .reason = std::string(group.reason) + "; u = 2^-11, A the largest opacity"};
    const View view = orbitView(scene, {30.0, 20.0, 2.5}, 40.0, kSize);
    const Result<FramePlan> plan = bench.plan(scene, settings);
    if (!plan) {
        return bench.recordFailure(result, plan.error());
    }
    const Result<Picture> exact = drawInFloat32(exactly, scene, *plan, view, kSize);
    const Result<Picture> half = drawInFloat32(rounding, scene, *plan, view, kSize);
    if (!exact || !half) {
        return bench.recordFailure(result, exact ? half.error() : exact.error());
    }
    const std::vector<glm::dvec4> meant(exact->pixels.begin(), exact->pixels.end());
    Ray ray{.layers = double(plan->lattice.total),
            .layersOfSegment = double(plan->layersPerPlane),
            .opacity = 0.0};
    for (const glm::dvec4& pixel : meant) {
        ray.opacity = std::max(ray.opacity, pixel.a);
    }
    result.measured = largestDifference(*half, meant);
    if (group.bits != 0 && result.measured == 0.0) {
        return bench.recordFailure(result, {ErrorCode::Internal,
                                            "rounding changes nothing: these programs hold no "
                                            "operation of the group"});
    }
    result.bound = group.bound(ray);
    result.pictures = {{"float32", *exact}, {"fp16", *half}};
    bench.record(std::move(result));
}

void measureGroup(Bench& bench, Renderer& exactly, Renderer& rounding, const Group& group) {
    for (const HalfScene& setup : scenes(bench.reduced())) {
        const Volume volume = formulaVolume(glm::ivec3(48), VoxelType::U16, setup.formula);
        Appearance look{.tf = setup.tf};
        if (group.shaded) {
            look.shading = ShadingParameters{};
        }
        const Result<Scene> scene =
            bench.scene(volume, look, {SkipStructure::None}, group.text == Text::FetchedTable);
        if (!scene) {
            bench.recordFailure(
                {.family = "half-precision", .name = named({group.name, setup.name})},
                scene.error());
            continue;
        }
        for (const Method& method : methods()) {
            if (method.target == TargetFormat::Rgba16f) {
                measure(bench, exactly, rounding, *scene, setup, group, method);
            }
        }
    }
}

} // namespace

void halfPrecisionCases(Bench& bench) {
    if (!bench.caps().floatBlend) {
        return bench.recordFailure(
            {.family = "half-precision", .name = "float32 target"},
            {ErrorCode::DeviceUnsupported, "this device does not blend float32 targets"});
    }
    const auto renderer = [&](int groups) {
        return Renderer::create(Device(bench.caps(), {}), {.halfGroups = groups});
    };
    // Of a device that has them, the bench's own renderer draws what is mediump in 16 bits.
    Result<Renderer> exactly = renderer(kHalfNowhere);
    for (const Group& group : kGroups) {
        Result<Renderer> rounding = renderer(group.bits);
        if (!exactly || !rounding) {
            bench.recordFailure({.family = "half-precision", .name = group.name},
                                exactly ? rounding.error() : exactly.error());
            continue;
        }
        measureGroup(bench, *exactly, *rounding, group);
    }
}

} // namespace slabcast::stability
