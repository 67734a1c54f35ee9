#include "core/frame/scene.h"

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
    scene.texels_ = encodeTexels(volume, scene.statistics_, format);
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
    lookGeneration_ = nextGeneration();
    buildTable(maxTableSize);
    classified_.reset();
    if (look_.classification == Classification::Pre) {
        ClassifySettings settings;
        if (look_.shading) {
            settings.light = BakedLight{look_.bakedLightDirection, *look_.shading};
        }
        classified_ = classify(texels_, geometry_, table(), settings);
    }
    skip_ = {.options = {.structure = SkipStructure::None}};
    return skip.structure == SkipStructure::None ? Result<void>{} : buildSkip(skip);
}

void Scene::buildTable(int maxTableSize) {
    const VolumeStatistics& s = statistics_;
    if (look_.classification == Classification::Preintegrated) {
        preintegrated_ = makePreintegratedTable(look_.tf, s.min, s.max, integerData_, look_.space,
                                                std::min(maxTableSize, kMaxPreintegratedSize));
        table_ = {};
    } else {
        table_ = makeTable(look_.tf, s.min, s.max, integerData_, look_.space, maxTableSize);
        preintegrated_.reset();
    }
}

Result<void> Scene::buildSkip(const SkipOptions& options) {
    const bool pre = classified_.has_value();
    if (!pre && !codes_) {
        codes_ = std::make_shared<TexelCodes>(encodeCodes(texels_));
    }
    const TexelCodes alpha = pre ? alphaCodes(*classified_) : TexelCodes{};
    const CellVisibility visibility =
        pre ? cellVisibilityOfAlpha(alpha)
            : cellVisibility(*codes_, texels_, table(), filterErrorSampled_);
    Result<BuiltSkip> built =
        slabcast::buildSkip({pre ? alpha : *codes_, visibility, geometry_}, options);
    if (!built) {
        return tl::unexpected(built.error());
    }
    skip_ = std::move(*built);
    return {};
}

SceneFacts Scene::facts() const {
    SceneFacts facts;
    facts.sphere = geometry_.boundingSphere();
    facts.smallestVoxelEdgeMm = geometry_.smallestVoxelEdgeMm();
    facts.exactField = isExact(texels_.format);
    facts.skip = skip_.options;
    facts.occupiedFraction = skip_.occupiedFraction;
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
        facts.maxExtinctionPerMm > 0.0 && (!skip_.exists() || skip_.occupiedFraction > 0.0);
    return facts;
}

double Scene::defaultGradientFloorPerMm() const {
    constexpr double kShareOfRangePerVoxel = 0.005;
    return kShareOfRangePerVoxel * (statistics_.max - statistics_.min) /
           geometry_.smallestVoxelEdgeMm();
}

} // namespace slabcast
