#include "perf/stability/bench.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/base/parallel.h"
#include "core/gl/api.h"
#include "core/reference/continuous.h"
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

Result<Scene> Bench::scene(const Volume& volume, const Appearance& appearance,
                           const SkipOptions& skip, bool exact) const {
    const TextureChoice choice = device_.texturesFor(volume.type, computeStatistics(volume), exact);
    return Scene::create(volume, choice).and_then([&](Scene&& scene) -> Result<Scene> {
        if (Result<void> shown = show(scene, appearance, skip); !shown) {
            return tl::unexpected(shown.error());
        }
        return std::move(scene);
    });
}

Result<FramePlan> Bench::plan(const Scene& scene, const Settings& settings) const {
    return slabcast::plan(scene.facts(), settings, caps(), {});
}

Result<Drawn> Bench::draw(const Scene& scene, const Settings& settings, const View& view,
                          glm::ivec2 size) {
    const Result<FramePlan> decided = plan(scene, settings);
    return decided ? draw(scene, *decided, view, size) : tl::unexpected(decided.error());
}

Result<Drawn> Bench::draw(const Scene& scene, const FramePlan& plan, const View& view,
                          glm::ivec2 size) {
    const GLenum format = plan.target == TargetFormat::Rgba8 ? GL_RGBA8 : GL_RGBA16F;
    if (Result<void> made = target_.resize(size.x, size.y, {format}); !made) {
        return tl::unexpected(made.error());
    }
    target_.begin();
    const TargetEncoding encoding =
        plan.space == CompositingSpace::Display ? TargetEncoding::Encoded : TargetEncoding::Linear;
    const ViewTarget where{view, target_.framebuffer(), {0, 0, size.x, size.y}, encoding};
    if (Result<void> ready = renderer_.prepare(scene, plan, {&where, 1}); !ready) {
        return tl::unexpected(ready.error());
    }
    if (Result<void> done = renderer_.draw(scene, plan, {&where, 1}); !done) {
        return tl::unexpected(done.error());
    }
    return Drawn{plan, {size, target_.read()}};
}

Result<Picture> Bench::drawFinely(const Scene& scene, const FramePlan& plan, const View& view,
                                  glm::ivec2 size) {
    SLABCAST_EXPECTS(plan.target == TargetFormat::Rgba16f, plan.target);
    if (caps().floatBlend) {
        return drawInFloat32(renderer_, scene, plan, view, size);
    }
    return draw(scene, plan, view, size).map([](Drawn&& drawn) {
        return std::move(drawn.picture);
    });
}

Bench::FinestTarget Bench::finest() const {
    return caps().floatBlend ? FinestTarget{"float32", 0x1p-24} : FinestTarget{"rgba16f", 0x1p-11};
}

Result<WorkCounters> Bench::countWork(const Scene& scene, const FramePlan& plan, const View& view,
                                      glm::ivec2 size) {
    const ViewTarget where{view, 0, {0, 0, size.x, size.y}};
    if (Result<void> ready = renderer_.prepare(scene, plan, {&where, 1}); !ready) {
        return tl::unexpected(ready.error());
    }
    return renderer_.countWork(scene, plan, {&where, 1});
}

void Bench::record(Case measured) {
    if (!names_.insert(measured.name).second) {
        contractBreach(__func__, ("no other case is called " + measured.name).c_str(), 0.0);
    }
    if (measured.failure.empty() && !measured.couldFail()) {
        measured.failure = "the bound is full scale or more: no picture could exceed it";
    }
    if (watcher_) {
        watcher_(measured);
    }
    cases_.push_back(std::move(measured));
}

void Bench::record(Case c, const Result<double>& measured) {
    if (!measured) {
        recordFailure(std::move(c), measured.error());
        return;
    }
    c.measured = *measured;
    record(std::move(c));
}

void Bench::examine(Case c, const Scene& scene, const Settings& settings, const View& view,
                    glm::ivec2 size,
                    const std::function<void(Case& c, const Drawn& drawn)>& judge) {
    const Result<Drawn> drawn = draw(scene, settings, view, size);
    if (!drawn) {
        recordFailure(std::move(c), drawn.error());
        return;
    }
    judge(c, *drawn);
    record(std::move(c));
}

void Bench::recordFailure(Case unmeasured, const Error& error) {
    unmeasured.measured = std::nan("");
    unmeasured.failure = error.detail;
    record(std::move(unmeasured));
}

Result<Picture> drawInFloat32(Renderer& renderer, const Scene& scene, const FramePlan& plan,
                              const View& view, glm::ivec2 size) {
    gl::ColorTargets target;
    if (Result<void> made = target.resize(size.x, size.y, {GL_RGBA32F}); !made) {
        return tl::unexpected(made.error());
    }
    target.begin();
    const ViewTarget where{view, target.framebuffer(), {0, 0, size.x, size.y}};
    if (Result<void> ready = renderer.prepare(scene, plan, {&where, 1}); !ready) {
        return tl::unexpected(ready.error());
    }
    if (Result<void> done = renderer.draw(scene, plan, {&where, 1}); !done) {
        return tl::unexpected(done.error());
    }
    return Picture{size, target.read()};
}

double largerOf(double largest, double next) {
    return next <= largest ? largest : next;
}

double largestDifference(const Picture& picture, std::span<const glm::dvec4> reference) {
    SLABCAST_EXPECTS(picture.pixels.size() == reference.size(), reference.size());
    double largest = 0.0;
    for (std::size_t i = 0; i < reference.size(); ++i) {
        const glm::dvec4 off = glm::abs(glm::dvec4(picture.pixels[i]) - reference[i]);
        const double most = std::max({off.x, off.y, off.z, off.w});
        largest = largerOf(largest, most);
    }
    return largest;
}

std::vector<glm::dvec4> continuousPicture(const Scene& scene, const View& view, glm::ivec2 size) {
    return renderContinuous({.texels = &scene.texels(),
                             .geometry = scene.geometry(),
                             .tf = scene.look().tf,
                             .space = scene.provided()->space,
                             .view = view,
                             .viewport = {0, 0, size.x, size.y}});
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
    const auto shareAt = [&](int x, int y) {
        const PixelReference expected = reference.at(glm::dvec2(x, y) + 0.5);
        if (expected.atEdge) {
            return 0.0;
        }
        const std::size_t i = static_cast<std::size_t>(y) * size.x + x;
        const glm::dvec4 off = glm::abs(glm::dvec4(drawn.picture.pixels[i]) - expected.color);
        return std::max({off.x, off.y, off.z, off.w}) / (expected.bound + blending);
    };
    std::vector<double> worstOfRow(size.y, 0.0);
    parallelFor(size.y, 1, [&](std::int64_t begin, std::int64_t end) {
        for (int y = static_cast<int>(begin); y < end; ++y) {
            for (int x = 0; x < size.x; ++x) {
                worstOfRow[y] = largerOf(worstOfRow[y], shareAt(x, y));
            }
        }
    });
    return std::accumulate(worstOfRow.begin(), worstOfRow.end(), 0.0, largerOf);
}

} // namespace slabcast::stability
