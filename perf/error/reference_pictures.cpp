#include "perf/error/reference_pictures.h"

#include <algorithm>
#include <cmath>

#include "core/reference/continuous.h"
#include "perf/number.h"

namespace slabcast {

namespace {

constexpr double kMaxFactor = 65536.0;

/// Calls `render(view, viewport)` for every eye and puts what it returns in its place.
template <class Render>
std::vector<glm::dvec4> ofAllViews(const Stage& stage, Render render) {
    const glm::ivec2 size = stage.desc().size;
    std::vector<glm::dvec4> picture(static_cast<std::size_t>(size.x) * size.y, glm::dvec4(0.0));
    for (const ViewTarget& target : stage.views(0.0)) {
        const Viewport& v = target.viewport;
        const std::vector<glm::dvec4> part = render(target.view, v);
        for (int y = 0; y < v.height; ++y) {
            const auto row = part.begin() + static_cast<std::ptrdiff_t>(y) * v.width;
            std::copy(row, row + v.width,
                      picture.begin() + static_cast<std::ptrdiff_t>(v.y + y) * size.x + v.x);
        }
    }
    return picture;
}

/// As the look's transfer function is meant.
DiscreteTransfer exactTransfer(const Scene& scene) {
    const TransferFunction& tf = scene.look().tf;
    switch (scene.provided()->classification) {
    case Classification::Pre:
        return PreclassifiedExact{tf, scene.classified()->referenceLengthMm};
    case Classification::Preintegrated:
        return PreintegratedExact{tf};
    case Classification::Post:
        break;
    }
    return tf;
}

/// As the GPU holds it.
DiscreteTransfer heldTransfer(const Scene& scene) {
    switch (scene.provided()->classification) {
    case Classification::Pre:
        return scene.classified();
    case Classification::Preintegrated:
        return *scene.preintegrated();
    case Classification::Post:
        break;
    }
    return scene.table();
}

template <class Convert>
std::vector<glm::vec4> fromTheTop(glm::ivec2 size, Convert colorAt) {
    std::vector<glm::vec4> pixels;
    pixels.reserve(static_cast<std::size_t>(size.x) * size.y);
    for (int y = size.y - 1; y >= 0; --y) {
        for (int x = 0; x < size.x; ++x) {
            const glm::dvec3 color = colorAt(static_cast<std::size_t>(y) * size.x + x);
            pixels.emplace_back(glm::vec3(glm::clamp(color, 0.0, 1.0)), 1.0F);
        }
    }
    return pixels;
}

} // namespace

std::vector<glm::dvec4> continuousPicture(const Stage& stage) {
    const auto eyes = static_cast<double>(stage.views(0.0).size());
    double done = 0.0;
    ProgressLine progress(stage.watcher());
    return ofAllViews(stage, [&](const View& view, const Viewport& viewport) {
        std::vector<glm::dvec4> part =
            renderContinuous({.texels = &stage.values(),
                              .geometry = stage.scene().geometry(),
                              .tf = stage.scene().look().tf,
                              .space = stage.scene().provided()->space,
                              .view = view,
                              .viewport = viewport,
                              .tolerance = kReferenceTolerance},
                             [&](double share) {
                                 progress.show("integrating the exact picture: " +
                                               fixed(100.0 * (done + share) / eyes, 0) + " %");
                             });
        done += 1.0;
        return part;
    });
}

std::vector<glm::dvec4> discretePicture(const Stage& stage, const Lattice& lattice,
                                        TransferKind kind) {
    const Scene& scene = stage.scene();
    return ofAllViews(stage, [&](const View& view, const Viewport& viewport) {
        return renderDiscrete(
            {.texels = &stage.values(),
             .geometry = scene.geometry(),
             .transfer = kind == TransferKind::Table ? heldTransfer(scene) : exactTransfer(scene),
             .space = scene.provided()->space,
             .view = view,
             .viewport = viewport,
             .lattice = lattice});
    });
}

std::vector<glm::vec4> shown(const std::vector<glm::dvec4>& picture, glm::ivec2 size,
                             CompositingSpace space) {
    return fromTheTop(size, [&](std::size_t i) {
        const glm::dvec3 color(picture[i]);
        return space == CompositingSpace::Linear ? srgbFromLinear(glm::clamp(color, 0.0, 1.0))
                                                 : color;
    });
}

AmplifiedDifference amplified(const std::vector<glm::dvec4>& picture,
                              const std::vector<glm::dvec4>& reference, glm::ivec2 size) {
    const auto apart = [&](std::size_t i) {
        return glm::abs(glm::dvec3(picture[i] - reference[i]));
    };
    std::vector<double> largest(picture.size());
    for (std::size_t i = 0; i < picture.size(); ++i) {
        const glm::dvec3 d = apart(i);
        largest[i] = std::max({d.x, d.y, d.z});
    }
    const auto rank = largest.begin() +
                      static_cast<std::ptrdiff_t>(0.999 * static_cast<double>(largest.size() - 1));
    std::nth_element(largest.begin(), rank, largest.end());
    const double factor =
        *rank > 0.0 ? std::clamp(std::exp2(std::floor(-std::log2(*rank))), 1.0, kMaxFactor)
                    : kMaxFactor;
    return {fromTheTop(size, [&](std::size_t i) { return factor * apart(i); }), factor};
}

Json toJson(const PictureDifference& d) {
    Json all = {{"rmse", d.rmse},
                {"psnr", std::isfinite(d.psnr) ? Json(d.psnr) : Json()},
                {"max", d.max},
                {"mean_delta_e", d.meanDeltaE},
                {"p999_delta_e", d.p999DeltaE},
                {"bias", d.bias},
                {"deviation", d.deviation},
                {"visible_share", d.visibleShare},
                {"alpha_visible_share", d.visibleAlphaShare},
                {"alpha_rmse", d.channels[3].rmse},
                {"alpha_max", d.channels[3].max}};
    constexpr const char* kChannels[] = {"red", "green", "blue", "alpha"};
    for (std::size_t k = 0; k < d.channels.size(); ++k) {
        all[std::string(kChannels[k]) + "_bias"] = d.channels[k].bias;
        all[std::string(kChannels[k]) + "_deviation"] = d.channels[k].deviation;
    }
    return all;
}

} // namespace slabcast
