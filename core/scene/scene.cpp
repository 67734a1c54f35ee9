#include "core/scene/scene.h"

#include <algorithm>
#include <atomic>
#include <functional>

#include "core/skip/cell_visibility.h"

namespace slabcast {

namespace {

int nextGeneration() {
    static std::atomic<int> last{0};
    return ++last;
}

} // namespace

Scene Scene::create(Volume volume, TexelFormat format, double filterErrorOfFullScale) {
    Scene scene;
    scene.volumeName_ = volume.name;
    scene.geometry_ = volume.geometry;
    scene.integerData_ = !isFloatingPoint(volume.type) && volume.rescaleSlope == 1.0;
    scene.statistics_ = computeStatistics(volume);
    scene.texels_ = std::make_shared<Texels>(encodeTexels(volume, scene.statistics_, format));
    scene.texelsGeneration_ = nextGeneration();
    scene.filterErrorSampled_ = filterErrorOfFullScale * fullScaleSampled(format);
    return scene;
}

Result<void> Scene::setLook(const Look& look, const SkipOptions& skip, int maxTableSize) {
    Result<TransferFunction> tf = validated(look.tf);
    if (!tf) {
        return tl::unexpected(tf.error());
    }
    look_ = look;
    look_.tf = std::move(*tf);
    if (look_.shading && look_.shading->gradientFloorPerMm <= 0.0) {
        look_.shading->gradientFloorPerMm = defaultGradientFloorPerMm();
    }
    live_.reset();
    lookGeneration_ = nextGeneration();
    maxTableSize_ = maxTableSize;
    buildTable();
    classified_.reset();
    if (look_.classification == Classification::Pre) {
        ClassifySettings settings;
        if (look_.shading) {
            settings.light = BakedLight{look_.bakedLightDirection, *look_.shading};
        }
        classified_ = classify(*texels_, geometry_, table(), settings);
    }
    skip_ = noSkip();
    return skip.structure == SkipStructure::None
               ? Result<void>{}
               : buildSkip([&](const SkipSource& s) { return slabcast::buildSkip(s, skip); });
}

void Scene::buildTable() {
    const VolumeStatistics& s = statistics_;
    if (look_.classification == Classification::Preintegrated) {
        preintegrated_ = makePreintegratedTable(look_.tf, s.min, s.max, integerData_, look_.space,
                                                std::min(maxTableSize_, kMaxPreintegratedSize));
        table_ = {};
    } else {
        table_ = makeTable(look_.tf, s.min, s.max, integerData_, look_.space, maxTableSize_);
        preintegrated_.reset();
    }
}

void Scene::needCodes() {
    if (!codes_) {
        codes_ = std::make_shared<const TexelCodes>(encodeCodes(*texels_));
    }
}

CellVisibility Scene::visibility() const {
    return cellVisibility(*codes_, *texels_, table(), filterErrorSampled_);
}

Result<void> Scene::buildSkip(const SkipBuild& build) {
    SLABCAST_EXPECTS(!live_, lookGeneration_);
    const auto from = [&](const TexelCodes& codes, const CellVisibility& visible) {
        return build({codes, *texels_, visible, geometry_}).map([&](BuiltSkip&& built) {
            skip_ = std::move(built);
        });
    };
    if (classified_) {
        const TexelCodes alpha = alphaCodes(*classified_);
        return from(alpha, cellVisibilityOfAlpha(alpha));
    }
    needCodes();
    return from(*codes_, visibility());
}

Result<void> Scene::startEditing(const LiveOptions& options) {
    if (classified_) {
        return fail(ErrorCode::InvalidArgument,
                    "pre-classified texels hold the transfer function, which cannot be edited in "
                    "them: take post or pre-integrated classification");
    }
    needCodes();
    return LiveSkip::start({codes_, texels_, geometry_}, options, visibility(), skip())
        .map([&](LiveSkip&& live) {
            live_ = std::move(live);
            skip_ = noSkip();
        });
}

Result<void> Scene::edit(TransferFunction tf) {
    SLABCAST_EXPECTS(live_.has_value(), lookGeneration_);
    return validated(std::move(tf)).map([&](TransferFunction&& valid) {
        look_.tf = std::move(valid);
        lookGeneration_ = nextGeneration();
        buildTable();
        live_->edit(visibility());
    });
}

LiveProgress Scene::work(double budgetMs) {
    SLABCAST_EXPECTS(live_.has_value(), lookGeneration_);
    return live_->work(budgetMs);
}

void Scene::stopEditing() {
    if (live_) {
        skip_ = live_->current();
        live_.reset();
    }
}

std::vector<const BuiltSkip*> Scene::residentSkips() const {
    if (live_) {
        return {&live_->always(), &live_->settled(), &live_->incoming()};
    }
    return {&skip_};
}

std::vector<Scene> Scene::withEachServing() const {
    SLABCAST_EXPECTS(live_.has_value(), lookGeneration_);
    std::vector<Scene> scenes;
    for (LiveSkip& live : live_->eachServing()) {
        scenes.push_back(*this);
        scenes.back().live_ = std::move(live);
    }
    return scenes;
}

SceneFacts Scene::facts() const {
    SceneFacts facts;
    facts.sphere = geometry_.boundingSphere();
    facts.smallestVoxelEdgeMm = geometry_.smallestVoxelEdgeMm();
    facts.exactField = isExact(texels_->format);
    facts.skip = skip().options;
    facts.occupiedFraction = skip().occupiedFraction;
    const std::vector<glm::vec4>& texels = table().texels;
    facts.oneMaterial =
        std::adjacent_find(texels.begin(), texels.end(), std::not_equal_to<>()) == texels.end();
    for (const glm::vec4& texel : texels) {
        facts.maxExtinctionPerMm = std::max(facts.maxExtinctionPerMm,
                                            static_cast<double>(texel.a) * table().extinctionPerMm);
    }
    facts.wideTable = table_.wide;
    facts.visibleColorRange =
        visibleColorRange(look_.tf, statistics_.min, statistics_.max, look_.space);
    facts.anythingVisible =
        facts.maxExtinctionPerMm > 0.0 && (!skip().exists() || skip().occupiedFraction > 0.0);
    return facts;
}

double Scene::defaultGradientFloorPerMm() const {
    constexpr double kShareOfRangePerVoxel = 0.005;
    return kShareOfRangePerVoxel * (statistics_.max - statistics_.min) /
           geometry_.smallestVoxelEdgeMm();
}

} // namespace slabcast
