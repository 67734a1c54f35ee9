#include "perf/stability/bench.h"

#include <algorithm>
#include <cmath>

#include "core/gl/api.h"
#include "perf/stability/reference_picture.h"

namespace slabcast::stability {

std::span<const Method> methods() {
    static constexpr Method kMethods[] = {
        {"slicing, rgba8", 1, TargetFormat::Rgba8},
        {"hybrid, rgba8", 16, TargetFormat::Rgba8},
        {"ray casting, rgba8", kAllLayers, TargetFormat::Rgba8},
        {"slicing, rgba16f", 1, TargetFormat::Rgba16f},
        {"hybrid, rgba16f", 16, TargetFormat::Rgba16f},
        {"ray casting, rgba16f", kAllLayers, TargetFormat::Rgba16f}};
    return kMethods;
}

Settings settingsOf(const Method& method) {
    Settings settings;
    settings.layersPerPlane = method.layersPerPlane;
    settings.target = method.target;
    settings.skip = SkipStructure::None;
    settings.tighten = false;
    settings.termination.reset();
    return settings;
}

View orbitView(const Scene& scene, const OrbitCamera& camera, double fovDegrees, glm::ivec2 size) {
    return {.viewFromModel = viewFromModel(camera, scene.geometry().boundingSphere()),
            .frustum = symmetricFrustum(fovDegrees, static_cast<double>(size.x) / size.y)};
}

Result<Scene> Bench::scene(const Volume& volume, const Look& look, const SkipOptions& skip,
                           bool exact) const {
    const TexelFormat format =
        chooseTexelFormat(volume.type, computeStatistics(volume), exact, formats_, nullptr);
    const auto test = std::find_if(formats_.begin(), formats_.end(),
                                   [=](const TexelFormatTest& t) { return t.format == format; });
    Scene scene =
        Scene::create(volume, format, test == formats_.end() ? 0.0 : test->maxFilterError);
    const int maxTable = static_cast<int>(std::min<std::int64_t>(4096, caps_.maxTextureSize));
    if (Result<void> set = scene.setLook(look, skip, maxTable); !set) {
        return tl::unexpected(set.error());
    }
    return scene;
}

Result<FramePlan> Bench::plan(const Scene& scene, const Settings& settings) const {
    return slabcast::plan(scene.facts(), settings, caps_, {});
}

Result<Drawn> Bench::draw(const Scene& scene, const Settings& settings, const View& view,
                          glm::ivec2 size) {
    Result<FramePlan> decided = plan(scene, settings);
    if (!decided) {
        return tl::unexpected(decided.error());
    }
    const GLenum format = decided->target == TargetFormat::Rgba8 ? GL_RGBA8 : GL_RGBA16F;
    if (Result<void> made = target_.resize(size.x, size.y, {format}); !made) {
        return tl::unexpected(made.error());
    }
    target_.begin();
    const TargetEncoding encoding = decided->space == CompositingSpace::Display
                                        ? TargetEncoding::Encoded
                                        : TargetEncoding::Linear;
    const ViewTarget where{view, target_.framebuffer(), {0, 0, size.x, size.y}, encoding};
    if (Result<void> ready = renderer_.prepare(scene, *decided); !ready) {
        return tl::unexpected(ready.error());
    }
    if (Result<void> done = renderer_.draw(scene, *decided, {&where, 1}); !done) {
        return tl::unexpected(done.error());
    }
    return Drawn{std::move(*decided), {size, target_.read()}};
}

Result<WorkCounters> Bench::countWork(const Scene& scene, const FramePlan& plan, const View& view,
                                      glm::ivec2 size) {
    if (Result<void> ready = renderer_.prepare(scene, plan); !ready) {
        return tl::unexpected(ready.error());
    }
    const ViewTarget where{view, 0, {0, 0, size.x, size.y}};
    return renderer_.countWork(scene, plan, {&where, 1});
}

void Bench::recordFailure(Case unmeasured, const Error& error) {
    unmeasured.measured = std::nan("");
    unmeasured.failure = error.detail;
    record(std::move(unmeasured));
}

double largestDifference(const Picture& picture, std::span<const glm::dvec4> reference) {
    SLABCAST_EXPECTS(picture.pixels.size() == reference.size(), reference.size());
    double largest = 0.0;
    for (std::size_t i = 0; i < reference.size(); ++i) {
        const glm::dvec4 off = glm::abs(glm::dvec4(picture.pixels[i]) - reference[i]);
        const double most = std::max({off.x, off.y, off.z, off.w});
        largest = most <= largest ? largest : most; // NaN stays
    }
    return largest;
}

const char* const kPixelBoundReason =
    "float64 over the same samples; a pixel's own bound adds, layer by layer and weighted by the "
    "transmittance before it, the spread of the classification over what the texture filter "
    "(3/256 of the cell's range and one step of the format), float32 positions (2^-22 of the "
    "terms they are summed from) and the table's weights may do, and one rounding of the target "
    "per plane";

double shareOfPixelBound(const Scene& scene, const Drawn& drawn, const View& view) {
    const glm::ivec2 size = drawn.picture.size;
    const ReferencePicture reference(scene, drawn.plan, view, {0, 0, size.x, size.y});
    const double blending = blendingBound(drawn.plan);
    double worst = 0.0;
    for (int y = 0; y < size.y; ++y) {
        for (int x = 0; x < size.x; ++x) {
            const PixelReference expected = reference.at(glm::dvec2(x, y) + 0.5);
            if (expected.atEdge) {
                continue;
            }
            const std::size_t i = static_cast<std::size_t>(y) * size.x + x;
            const glm::dvec4 off = glm::abs(glm::dvec4(drawn.picture.pixels[i]) - expected.color);
            const double share =
                std::max({off.x, off.y, off.z, off.w}) / (expected.bound + blending);
            worst = share <= worst ? worst : share; // NaN stays
        }
    }
    return worst;
}

std::span<const Family> families() {
    static constexpr Family kFamilies[] = {
        {"stiff", "Stiff transfer functions and data", stiffCases},
        {"extreme-data", "Extreme data", extremeDataCases},
        {"extreme-views", "Extreme views", extremeViewCases},
        {"extreme-plans", "Extreme plans", extremePlanCases},
        {"in-time", "Swimming in time", inTimeCases},
        {"half-precision", "Half precision", halfPrecisionCases},
        {"left-out", "What a scene does not need", leftOutCases}};
    return kFamilies;
}

} // namespace slabcast::stability
