#include "platform/cli/draw.h"

#include <algorithm>

#include <fmt/core.h>
#include <glm/gtc/matrix_transform.hpp>

#include "core/base/stopwatch.h"
#include "core/draw/ratio_tuner.h"
#include "core/gl/api.h"
#include "platform/cli/progress.h"
#include "platform/cli/transfer_choice.h"

namespace slabcast {

namespace {

/// Planes converge here, in bounding-sphere radii: at the volume's centre.
double convergenceDepth(const SceneOptions& options, const BoundingSphere& sphere) {
    return std::max(options.camera.distanceRadii, 0.1) * sphere.radiusMm;
}

/// Turned about the vertical axis through the volume's centre.
glm::dmat4 turned(double degrees, const BoundingSphere& sphere) {
    const glm::dmat4 there = glm::translate(glm::dmat4(1.0), sphere.centreMm);
    const glm::dmat4 back = glm::translate(glm::dmat4(1.0), -sphere.centreMm);
    return there * glm::rotate(glm::dmat4(1.0), glm::radians(degrees), glm::dvec3(0.0, 0.0, 1.0)) *
           back;
}

} // namespace

Result<Stage> Stage::open(const SceneOptions& options) {
    Result<Session> session = openSession();
    if (!session) {
        return tl::unexpected(session.error());
    }
    Progress progress("reading " + options.input.volume);
    Result<LoadedScene> loaded =
        openScene(options.input, options.settings.classification, *session);
    if (!loaded) {
        return tl::unexpected(loaded.error());
    }
    Result<TransferFunction> tf = chooseTransferFunction(
        options.tf, {loaded->scene.statistics(), loaded->info.unit}, loaded->info.modality);
    if (!tf) {
        return tl::unexpected(tf.error());
    }
    Result<Renderer> renderer = Renderer::create(session->caps);
    if (!renderer) {
        return tl::unexpected(renderer.error());
    }
    Stage stage(options, std::move(*session), std::move(*loaded), std::move(*renderer));
    if (Result<void> set = stage.setLook(std::move(*tf), options.settings.classification); !set) {
        return tl::unexpected(set.error());
    }
    return stage;
}

Result<void> Stage::setLook(TransferFunction tf, Classification classification) {
    const Progress progress("finding what the transfer function makes visible");
    const Settings& s = options_.settings;
    Look look{.tf = std::move(tf), .space = s.space, .classification = classification};
    if (s.shaded) {
        look.shading = ShadingParameters{};
    }
    // Towards the eye: a baked head light stands where the eye is at the first frame.
    const glm::dmat3 rotation(viewFromModel(options_.camera, scene().geometry().boundingSphere()));
    look.bakedLightDirection = glm::transpose(rotation) * glm::dvec3(0.0, 0.0, 1.0);
    SkipOptions skip = options_.skip;
    skip.structure = s.skip.value_or(skip.structure);
    if (s.tighten && skip.structure == SkipStructure::None) {
        skip.structure = SkipStructure::Blocks; // for the planes alone
    }
    const SkipBuilder builder = options_.skipBuilder;
    const bool onGpu = skip.structure != SkipStructure::None &&
                       (builder == SkipBuilder::Gpu ||
                        (builder == SkipBuilder::Auto && !session_.caps.isSoftware));
    if (!onGpu) {
        return loaded_.scene.setLook(look, skip, maxTableSize());
    }
    constexpr SkipOptions kNotYet{.structure = SkipStructure::None};
    if (Result<void> set = loaded_.scene.setLook(look, kNotYet, maxTableSize()); !set) {
        return set;
    }
    Result<void> built = renderer_.buildSkip(loaded_.scene, skip);
    if (built || built.error().code != ErrorCode::DeviceUnsupported) {
        return built;
    }
    fmt::print(stderr, "slabcast: {}\n", built.error().detail);
    return loaded_.scene.setLook(look, skip, maxTableSize());
}

int Stage::maxTableSize() const {
    return static_cast<int>(std::min<std::int64_t>(4096, session_.caps.maxTextureSize));
}

Result<Scene> Stage::variation(const TransferFunction& tf, const SkipOptions& skip) const {
    Scene varied = scene();
    Look look = varied.look();
    look.tf = tf;
    if (Result<void> set = varied.setLook(look, skip, maxTableSize()); !set) {
        return tl::unexpected(set.error());
    }
    return varied;
}

Result<void> Stage::reclassify(Classification classification) {
    if (scene().look().classification == classification) {
        return {};
    }
    const Result<MemoryForecast> forecast =
        checkMemory(info(), scene().texels().format, classification, options_.input, session_.caps);
    if (!forecast) {
        return tl::unexpected(forecast.error());
    }
    loaded_.info.forecast = *forecast;
    return setLook(scene().look().tf, classification);
}

Result<FramePlan> Stage::decide(const Settings& settings) {
    std::vector<RatioMeasurement> measurements;
    if (!settings.planes && !settings.layersPerPlane && scene().facts().anythingVisible) {
        const Progress progress("measuring ratios on this device");
        Result<std::vector<RatioMeasurement>> measured =
            measureRatios(renderer_, scene(), settings, session_.caps, views(0.0));
        if (!measured) {
            return tl::unexpected(measured.error());
        }
        measurements = std::move(*measured);
    }
    return plan(scene().facts(), settings, session_.caps, measurements);
}

Result<void> Stage::prepare(const FramePlan& plan) {
    space_ = plan.space;
    const GLenum format = plan.target == TargetFormat::Rgba8 ? GL_RGBA8 : GL_RGBA16F;
    if (Result<void> made = target_.resize(options_.size.x, options_.size.y, {format}); !made) {
        return made;
    }
    return renderer_.prepare(scene(), plan, views(0.0));
}

std::vector<ViewTarget> Stage::views(double turnDegrees) const {
    const BoundingSphere sphere = scene().geometry().boundingSphere();
    const int eyes = options_.stereoIpdMm ? 2 : 1;
    const int width = options_.size.x / eyes;
    const int height = options_.size.y;
    View centre;
    centre.viewFromModel = viewFromModel(options_.camera, sphere) * turned(turnDegrees, sphere);
    centre.frustum = symmetricFrustum(options_.fovDegrees, static_cast<double>(width) / height);
    const TargetEncoding encoding =
        space_ == CompositingSpace::Display ? TargetEncoding::Encoded : TargetEncoding::Linear;
    if (eyes == 1) {
        return {{centre, target_.framebuffer(), {0, 0, width, height}, encoding}};
    }
    const auto pair =
        stereoViews(centre, *options_.stereoIpdMm, convergenceDepth(options_, sphere));
    return {{pair[0], target_.framebuffer(), {0, 0, width, height}, encoding},
            {pair[1], target_.framebuffer(), {width, 0, width, height}, encoding}};
}

Result<double> Stage::drawTimed(const FramePlan& plan, double turnDegrees) {
    glm::vec4 clear(0.0F);
    if (options_.background) {
        const glm::dvec3 stored = space_ == CompositingSpace::Display
                                      ? *options_.background
                                      : linearFromSrgb(*options_.background);
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
    const glm::ivec2 size = options_.size;
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

FrameTimes summarise(std::vector<double> ms) {
    std::sort(ms.begin(), ms.end());
    const auto at = [&ms](double quantile) {
        return ms.empty() ? 0.0
                          : ms[static_cast<std::size_t>(
                                quantile * static_cast<double>(ms.size() - 1) + 0.5)];
    };
    // Of an even number the mean of the middle two.
    const std::size_t middle = ms.size() / 2;
    const double median =
        ms.size() % 2 == 1 || ms.empty() ? at(0.5) : 0.5 * (ms[middle - 1] + ms[middle]);
    return {median, at(0.0), at(1.0), at(0.1), at(0.9), static_cast<int>(ms.size())};
}

nlohmann::json toJson(const gl::Caps& caps) {
    return {{"vendor", caps.vendor},
            {"renderer", caps.renderer},
            {"version", caps.driver},
            {"software", caps.isSoftware}};
}

nlohmann::json toJson(const VolumeInfo& info) {
    return {{"name", info.name},
            {"dims", {info.dims.x, info.dims.y, info.dims.z}},
            {"type", name(info.type)},
            {"unit", info.unit},
            {"spacingMm", {info.spacingMm.x, info.spacingMm.y, info.spacingMm.z}},
            {"bytes", info.bytes}};
}

nlohmann::json toJson(const FramePlan& plan) {
    nlohmann::json reasons = nlohmann::json::array();
    for (const ReasonText& reason : explained(plan)) {
        reasons.push_back({{"what", reason.what}, {"why", reason.why}});
    }
    return {{"planes", plan.planes},
            {"layersPerPlane", plan.layersPerPlane},
            {"layers", plan.lattice.total},
            {"layerSpacingMm", plan.lattice.spacingMm},
            {"lattice", name(plan.lattice.kind)},
            {"jitter", plan.lattice.jittered},
            {"variant", name(plan.variant)},
            {"tighten", plan.tighten},
            {"termination", plan.variant.terminates || plan.planesPerMark > 0
                                ? nlohmann::json(plan.terminationAlpha)
                                : nlohmann::json("off")},
            {"order", name(plan.order)},
            {"planesPerMark", plan.planesPerMark},
            {"target", name(plan.target)},
            {"space", name(plan.space)},
            {"drawsNothing", plan.drawsNothing},
            {"reasons", std::move(reasons)}};
}

nlohmann::json toJson(const FrameTimes& t) {
    if (t.count == 0) {
        return nullptr;
    }
    return {{"median", t.median}, {"min", t.min}, {"max", t.max},
            {"p10", t.p10},       {"p90", t.p90}, {"n", t.count}};
}

nlohmann::json toJson(const Result<WorkCounters>& counters) {
    if (!counters) {
        return nullptr;
    }
    return {{"fragments", counters->fragments},
            {"layers_evaluated", counters->layersEvaluated},
            {"layers_skipped", counters->layersSkipped},
            {"volume_fetches", counters->volumeFetches},
            {"skip_fetches", counters->skipFetches},
            {"stretches", counters->stretches},
            {"blocks_visited", counters->blocksVisited}};
}

} // namespace slabcast
