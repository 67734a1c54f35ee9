#include "perf/stage.h"

#include <algorithm>

#include <glm/gtc/matrix_transform.hpp>

#include "core/base/stopwatch.h"
#include "core/draw/ratio_tuner.h"
#include "core/gl/api.h"

namespace slabcast {

namespace {

/// Planes converge here, in bounding-sphere radii: at the volume's centre.
double convergenceDepth(const OrbitCamera& camera, const BoundingSphere& sphere) {
    return std::max(camera.distanceRadii, 0.1) * sphere.radiusMm;
}

/// Turned about the vertical axis through the volume's centre.
glm::dmat4 turned(double degrees, const BoundingSphere& sphere) {
    const glm::dmat4 there = glm::translate(glm::dmat4(1.0), sphere.centreMm);
    const glm::dmat4 back = glm::translate(glm::dmat4(1.0), -sphere.centreMm);
    return there * glm::rotate(glm::dmat4(1.0), glm::radians(degrees), glm::dvec3(0.0, 0.0, 1.0)) *
           back;
}

Settings settingsFor(Classification classification, const StageDesc& desc) {
    Settings settings = desc.settings;
    settings.classification = classification;
    return settings;
}

/// What the texels take where they are classified so. Fails: as checkFits() and forecastMemory().
Result<MemoryForecast> checkMemory(const VolumeInfo& info, TexelFormat format,
                                   Classification classification, const StageDesc& desc,
                                   const gl::Caps& caps) {
    const Needs needs = needsOf(settingsFor(classification, desc));
    return checkFits(info.dims, uploadedBytesPerVoxel(format, needs), caps, desc.gpuBudgetBytes)
        .and_then([&] { return forecastMemory(info.dims, info.type, format, needs); });
}

} // namespace

Result<Stage> Stage::open(Device device, Volume volume, const VolumeStatistics& statistics,
                          StageDesc desc, Watcher watcher) {
    VolumeInfo info{.name = volume.name,
                    .type = volume.type,
                    .unit = volume.unit,
                    .dims = volume.geometry.dims,
                    .spacingMm = volume.geometry.spacingMm,
                    .bytes = static_cast<std::int64_t>(volume.voxels.size()),
                    .modality = likelyModality(volume, statistics)};
    TextureChoice choice = device.texturesFor(volume.type, statistics, desc.exactTexels,
                                              longestTexelStep(statistics, desc.tf));
    const auto check = [&] {
        return checkMemory(info, choice.texels, desc.settings.classification, desc, device.caps());
    };
    Result<MemoryForecast> forecast = check();
    if (!forecast && !desc.exactTexels) { // finer than the format's own steps, where that fits
        choice = device.texturesFor(volume.type, statistics);
        forecast = check();
    }
    info.formatReason = choice.reason;
    if (!forecast) {
        return tl::unexpected(forecast.error());
    }
    info.forecast = *forecast;
    Result<Renderer> renderer = Renderer::create(device);
    if (!renderer) {
        return tl::unexpected(renderer.error());
    }
    std::optional<Texels> values;
    const auto encode = [&] {
        const ProgressLine line(watcher, "making texels of the voxels");
        if (desc.keepValues && !keepsEveryVoxel(choice.texels, volume.type)) {
            values = encodeTexels(volume, statistics, TexelFormat::R32fExact);
        }
        return Scene::create(std::move(volume), statistics, choice);
    };
    Result<Scene> scene = encode();
    if (!scene) {
        return tl::unexpected(scene.error());
    }
    Stage stage(std::move(device), std::move(desc), std::move(watcher), std::move(*scene),
                std::move(*renderer));
    stage.info_ = std::move(info);
    stage.values_ = std::move(values);
    const Classification classification = stage.desc_.settings.classification;
    if (Result<void> set = stage.setLook(stage.desc_.tf, classification); !set) {
        return tl::unexpected(set.error());
    }
    return stage;
}

Result<void> Stage::setLook(TransferFunction tf, Classification classification) {
    const ProgressLine line(watcher_, "finding what the transfer function makes visible");
    Look look{.tf = std::move(tf)};
    // Towards the eye: a baked head light stands where the eye is at the first frame.
    const glm::dmat3 rotation(viewFromModel(desc_.camera, scene().geometry().boundingSphere()));
    look.bakedLightDirection = glm::transpose(rotation) * glm::dvec3(0.0, 0.0, 1.0);
    return scene_.setLook(std::move(look)).and_then([&] {
        return renderer_.provide(scene_, needsOf(settingsFor(classification, desc_)));
    });
}

double Stage::filterErrorSampled() const {
    const TexelFormat format = scene_.texels().format;
    return device_.filterErrorOfFullScale(format) * fullScaleSampled(format);
}

Result<Scene> Stage::variation(const TransferFunction& tf, const SkipOptions& skip) const {
    Scene varied = scene();
    Look look = varied.look();
    look.tf = tf;
    Needs needs = *scene().provided();
    needs.skip = skip;
    Result<void> set =
        varied.setLook(std::move(look)).and_then([&] { return varied.provide(needs); });
    if (!set) {
        return tl::unexpected(set.error());
    }
    return varied;
}

Result<void> Stage::reclassify(Classification classification) {
    if (scene().provided()->classification == classification) {
        return {};
    }
    const Result<MemoryForecast> forecast =
        checkMemory(info_, scene_.texels().format, classification, desc_, device_.caps());
    if (!forecast) {
        return tl::unexpected(forecast.error());
    }
    info_.forecast = *forecast;
    return setLook(scene().look().tf, classification);
}

bool leavesRatioOpen(const Settings& settings) {
    return !settings.planes && !settings.layersPerPlane;
}

Result<std::vector<RatioMeasurement>> Stage::timeRatios(const Settings& settings) {
    if (!leavesRatioOpen(settings) || !scene().facts().anythingVisible) {
        return std::vector<RatioMeasurement>{};
    }
    const ProgressLine line(watcher_, "measuring ratios on this device");
    return measureRatios(renderer_, scene(), settings, device_.caps(), views(0.0));
}

Result<FramePlan> Stage::decide(const Settings& settings,
                                std::span<const RatioMeasurement> measured) const {
    Result<FramePlan> made = slabcast::plan(scene().facts(), settings, device_.caps(), measured);
    if (made && watcher_.say) {
        const std::vector<ReasonText> texts = explained(*made);
        for (std::size_t k = 0; k < texts.size(); ++k) {
            if (isWarning(made->reasons[k].id)) {
                watcher_.say(texts[k].why);
            }
        }
    }
    return made;
}

Result<FramePlan> Stage::plan(const Settings& settings) const {
    return slabcast::plan(scene().facts(), settings, device_.caps(), {});
}

Result<void> Stage::prepare(const FramePlan& plan) {
    space_ = plan.space;
    const GLenum format = plan.target == TargetFormat::Rgba8 ? GL_RGBA8 : GL_RGBA16F;
    if (Result<void> made = target_.resize(desc_.size.x, desc_.size.y, {format}); !made) {
        return made;
    }
    return renderer_.prepare(scene(), plan, views(0.0));
}

std::vector<ViewTarget> Stage::views(double turnDegrees) const {
    const BoundingSphere sphere = scene().geometry().boundingSphere();
    const int eyes = desc_.stereoIpdMm ? 2 : 1;
    const int width = desc_.size.x / eyes;
    const int height = desc_.size.y;
    View centre;
    centre.viewFromModel = viewFromModel(desc_.camera, sphere) * turned(turnDegrees, sphere);
    centre.frustum = symmetricFrustum(desc_.fovDegrees, static_cast<double>(width) / height);
    const TargetEncoding encoding =
        space_ == CompositingSpace::Display ? TargetEncoding::Encoded : TargetEncoding::Linear;
    if (eyes == 1) {
        return {{centre, target_.framebuffer(), {0, 0, width, height}, encoding}};
    }
    const auto pair =
        stereoViews(centre, *desc_.stereoIpdMm, convergenceDepth(desc_.camera, sphere));
    return {{pair[0], target_.framebuffer(), {0, 0, width, height}, encoding},
            {pair[1], target_.framebuffer(), {width, 0, width, height}, encoding}};
}

Result<double> Stage::drawTimed(const FramePlan& plan, double turnDegrees) {
    glm::vec4 clear(0.0F);
    if (desc_.background) {
        const glm::dvec3 stored = space_ == CompositingSpace::Display
                                      ? *desc_.background
                                      : linearFromSrgb(*desc_.background);
        clear = glm::vec4(glm::dvec4(stored, 1.0));
    }
    return drawOn(clear, plan, turnDegrees);
}

Result<double> Stage::drawOn(glm::vec4 clear, const FramePlan& plan, double turnDegrees) {
    target_.begin(clear);
    gl::Finish();
    const Stopwatch watch;
    Result<void> drawn = renderer_.draw(scene(), plan, views(turnDegrees));
    if (!drawn) {
        return tl::unexpected(drawn.error());
    }
    gl::Finish();
    return watch.ms();
}

Result<std::vector<glm::dvec4>> Stage::drawOnNothing(const FramePlan& plan) {
    if (const Result<double> drawn = drawOn(glm::vec4(0.0F), plan, 0.0); !drawn) {
        return tl::unexpected(drawn.error());
    }
    const std::vector<glm::vec4> pixels = target_.read();
    return std::vector<glm::dvec4>(pixels.begin(), pixels.end());
}

Result<WorkCounters> Stage::countWork(const FramePlan& plan) {
    return renderer_.countWork(scene(), plan, views(0.0));
}

Result<std::vector<PixelWork>> Stage::workPerPixel(const FramePlan& plan) {
    const glm::ivec2 size = desc_.size;
    std::vector<PixelWork> picture(static_cast<std::size_t>(size.x) * size.y);
    for (const ViewTarget& target : views(0.0)) {
        const Result<std::vector<PixelWork>> work = renderer_.workPerPixel(scene(), plan, target);
        if (!work) {
            return work;
        }
        const Viewport& v = target.viewport;
        for (int y = 0; y < v.height; ++y) {
            const auto row = work->begin() + static_cast<std::ptrdiff_t>(y) * v.width;
            const int fromTop = size.y - 1 - (v.y + y);
            std::copy(row, row + v.width,
                      picture.begin() + static_cast<std::ptrdiff_t>(fromTop) * size.x + v.x);
        }
    }
    return picture;
}

std::vector<glm::vec4> Stage::picture(bool encoded) const {
    std::vector<glm::vec4> pixels = target_.read();
    const bool convert = encoded != (space_ == CompositingSpace::Display);
    for (glm::vec4& pixel : pixels) {
        const double alpha = static_cast<double>(pixel.a);
        glm::dvec3 straight = alpha > 0.0 ? glm::dvec3(pixel) / alpha : glm::dvec3(0.0);
        if (convert) {
            straight = encoded ? srgbFromLinear(straight) : linearFromSrgb(straight);
        }
        pixel = glm::vec4(glm::dvec4(encoded ? straight : straight * alpha, alpha));
    }
    std::vector<glm::vec4> flipped;
    flipped.reserve(pixels.size());
    for (int y = target_.height() - 1; y >= 0; --y) {
        const auto row = pixels.begin() + static_cast<std::ptrdiff_t>(y) * target_.width();
        flipped.insert(flipped.end(), row, row + target_.width());
    }
    return flipped;
}

} // namespace slabcast
