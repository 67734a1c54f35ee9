#include "core/scene/scene.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <functional>

#include "core/skip/cell_visibility.h"

namespace slabcast {

namespace {

constexpr const char* kTexelsAreGone =
    "this is made from the texels, which the scene has let go (Scene::releaseTexels()): create it "
    "again from the volume";

constexpr int kLeastTableSize = 4; // makeTable()'s

Result<void> checkTableSize(int most) {
    return most >= kLeastTableSize
               ? Result<void>{}
               : fail(ErrorCode::InvalidArgument,
                      "a transfer table of at most " + std::to_string(most) +
                          " texels holds nothing: " + std::to_string(kLeastTableSize) +
                          " at least; take what Device::texturesFor() says");
}

Result<void> checkLight(const Look& look) {
    const ShadingParameters& s = look.shading;
    const double numbers[] = {s.ambient, s.diffuse, s.specular, s.shininess, s.gradientFloorPerMm};
    if (!std::all_of(std::begin(numbers), std::end(numbers),
                     [](double number) { return std::isfinite(number); })) {
        return fail(ErrorCode::InvalidArgument,
                    "shading holds what is no finite number: give ambient, diffuse, specular, "
                    "shininess and gradientFloorPerMm");
    }
    const double length = glm::length(look.bakedLightDirection);
    return std::isfinite(length) && length > 0.0
               ? Result<void>{}
               : fail(ErrorCode::InvalidArgument,
                      "the baked light points nowhere: give a direction that is not zero");
}

int nextGeneration() {
    static std::atomic<int> last{0};
    return ++last;
}

} // namespace

struct Scene::State {
    std::string volumeName;
    VolumeGeometry geometry;
    bool integerData = true;
    VolumeStatistics statistics;
    std::shared_ptr<const Texels> texels;
    double filterErrorSampled = 0.0;
    int maxTableSize = 0;
    bool filtersTable = false;
    std::shared_ptr<const TexelCodes> codes; // made when the first skip structure is
    Look look;
    std::optional<Needs> provided; // but for the structure
    TransferTable table;           // of no use beside a pre-integrated one
    std::optional<PreintegratedTable> preintegrated;
    std::optional<ClassifiedTexels> classified;
    std::shared_ptr<const NormalTexels> normals;
    BuiltSkip skip = noSkip(); // while the scene is not edited
    std::optional<LiveSkip> live;
    CellVisibility editedVisibility; // of the last edit: room for the next
    int texelsGeneration = 0;
    int lookGeneration = 0;
    int normalsGeneration = 0;

    Result<void> provideLook(const Needs& needs);
    Result<void> provideNormals(bool needed);
    double defaultGradientFloorPerMm() const;
    void buildTable();
    Result<void> needCodes();
    const TransferTable& servingTable() const {
        return preintegrated ? preintegrated->diagonal : table;
    }
    CellVisibility visibility() const; // of scalars. Contract: their codes were made
};

Scene::Scene(std::unique_ptr<State> state) : state_(std::move(state)) {}
Scene::Scene() : state_(std::make_unique<State>()) {}
Scene::Scene(const Scene& other) : state_(std::make_unique<State>(*other.state_)) {}
Scene::Scene(Scene&&) noexcept = default;
Scene& Scene::operator=(const Scene& other) {
    state_ = std::make_unique<State>(*other.state_);
    return *this;
}
Scene& Scene::operator=(Scene&&) noexcept = default;
Scene::~Scene() = default;

Result<Scene> Scene::create(Volume volume, const TextureChoice& choice) {
    const VolumeStatistics statistics = computeStatistics(volume);
    return create(std::move(volume), statistics, choice);
}

Result<Scene> Scene::create(Volume volume, const VolumeStatistics& statistics,
                            const TextureChoice& choice) {
    if (Result<void> ok = checkTableSize(choice.maxTableSize); !ok) {
        return tl::unexpected(ok.error());
    }
    auto state = std::make_unique<State>();
    state->volumeName = volume.name;
    state->geometry = volume.geometry;
    state->integerData = !isFloatingPoint(volume.type) && volume.rescaleSlope == 1.0;
    state->statistics = statistics;
    state->texels =
        std::make_shared<Texels>(encodeTexels(std::move(volume), statistics, choice.texels));
    state->texelsGeneration = nextGeneration();
    state->lookGeneration = nextGeneration();
    state->filterErrorSampled = choice.filterErrorOfFullScale * fullScaleSampled(choice.texels);
    state->maxTableSize = choice.maxTableSize;
    state->filtersTable = choice.filtersTable;
    return Scene(std::move(state));
}

Result<Scene> Scene::create(Volume volume, const Device& device, bool exact) {
    Result<Volume> valid = validated(std::move(volume));
    if (!valid) {
        return tl::unexpected(valid.error());
    }
    const VolumeStatistics statistics = computeStatistics(*valid);
    return create(std::move(*valid), statistics,
                  device.texturesFor(valid->type, statistics, exact));
}

Result<void> Scene::setLook(Look look) {
    Result<TransferFunction> tf = validated(std::move(look.tf));
    if (!tf) {
        return tl::unexpected(tf.error());
    }
    if (Result<void> ok = checkLight(look); !ok) {
        return ok;
    }
    look.tf = std::move(*tf);
    if (look.shading.gradientFloorPerMm <= 0.0) {
        look.shading.gradientFloorPerMm = state_->defaultGradientFloorPerMm();
    }
    state_->look = std::move(look);
    state_->live.reset(); // of a copy of an edited scene: its structures are under that one's TF
    state_->lookGeneration = nextGeneration();
    state_->provided.reset();
    state_->table = {};
    state_->preintegrated.reset();
    state_->classified.reset();
    state_->skip = noSkip();
    return {};
}

void Scene::State::buildTable() {
    const VolumeStatistics& s = statistics;
    if (provided->classification == Classification::Preintegrated) {
        preintegrated = makePreintegratedTable(look.tf, s.min, s.max, integerData, provided->space,
                                               std::min(maxTableSize, kMaxPreintegratedSize));
        table = {};
    } else {
        makeTable(look.tf, s.min, s.max, integerData, provided->space, maxTableSize, table);
        preintegrated.reset();
    }
}

/// Table and texels as the needs say. Light belongs to the texels that it is baked into.
Result<void> Scene::State::provideLook(const Needs& needs) {
    const bool pre = needs.classification == Classification::Pre;
    if (provided && provided->classification == needs.classification &&
        provided->space == needs.space && (!pre || provided->shaded == needs.shaded)) {
        provided->shaded = needs.shaded;
        return {};
    }
    if (look.tf.points.empty()) {
        return fail(ErrorCode::InvalidArgument, "no look was set: call Scene::setLook() first");
    }
    if (pre && texels->data.empty()) {
        return fail(ErrorCode::InvalidArgument, kTexelsAreGone);
    }
    classified.reset(); // before the next is made: two may not fit
    skip = noSkip();
    lookGeneration = nextGeneration();
    provided = needs;
    buildTable();
    if (pre) {
        ClassifySettings settings;
        if (needs.shaded) {
            settings.light = BakedLight{look.bakedLightDirection, look.shading};
        }
        classified = classify(*texels, geometry, servingTable(), settings);
    }
    return {};
}

/// They are of the texels and no look, but for a floor so high that it needs a wider scale.
Result<void> Scene::State::provideNormals(bool needed) {
    constexpr double kSteepestInFloors = 100.0;
    provided->normals = false; // until they are there
    if (!needed) {
        normals.reset();
        return {};
    }
    const double floor = look.shading.gradientFloorPerMm;
    const double wanted = std::max(kSteepestInFloors * defaultGradientFloorPerMm(), 2.0 * floor);
    const double steepest = wanted > 0.0 ? wanted : 1.0; // of constant data, which has no gradient
    if (!normals || normals->steepestPerMm != steepest) {
        normals.reset(); // before the next are made: two may not fit
        if (texels->data.empty()) {
            return fail(ErrorCode::InvalidArgument, kTexelsAreGone);
        }
        normals =
            std::make_shared<const NormalTexels>(bakeNormals(*texels, geometry, steepest, floor));
        normalsGeneration = nextGeneration();
    }
    provided->normals = true;
    return {};
}

Result<void> Scene::provide(const Needs& needs) {
    if (provides(needs)) {
        return {};
    }
    return state_->provideLook(needs)
        .and_then([&] { return state_->provideNormals(needs.normals); })
        .and_then([&] {
            state_->skip = noSkip();
            return needs.skip.structure == SkipStructure::None
                       ? Result<void>{}
                       : buildSkip([&](const SkipSource& s) {
                             return slabcast::buildSkip(s, needs.skip);
                         });
        });
}

std::optional<Needs> Scene::provided() const {
    std::optional<Needs> all = state_->provided;
    if (all) {
        all->skip = skip().options;
    }
    return all;
}

bool Scene::provides(const Needs& needs) const {
    const SkipOptions& built = skip().options;
    return state_->provided && state_->provided->classification == needs.classification &&
           state_->provided->space == needs.space && state_->provided->shaded == needs.shaded &&
           state_->provided->normals == needs.normals &&
           (built == needs.skip || (built.structure == SkipStructure::None &&
                                    needs.skip.structure == SkipStructure::None));
}

Result<void> Scene::State::needCodes() {
    if (codes) {
        return {};
    }
    if (texels->data.empty()) {
        return fail(ErrorCode::InvalidArgument, kTexelsAreGone);
    }
    codes = std::make_shared<const TexelCodes>(encodeCodes(*texels, texels));
    return {};
}

CellVisibility Scene::State::visibility() const {
    return cellVisibility(*codes, *texels, servingTable(), filterErrorSampled);
}

Result<void> Scene::buildSkip(const SkipBuild& build) {
    SLABCAST_EXPECTS(!state_->live && state_->provided, state_->lookGeneration);
    const auto from = [&](const TexelCodes& codes, const CellVisibility& visible) {
        return build({codes, *state_->texels, visible, state_->geometry})
            .map([&](BuiltSkip&& built) { state_->skip = std::move(built); });
    };
    if (state_->classified) {
        const TexelCodes alpha = alphaCodes(*state_->classified);
        return from(alpha, cellVisibilityOfAlpha(alpha));
    }
    return state_->needCodes().and_then([&] { return from(*state_->codes, state_->visibility()); });
}

Result<void> Scene::startEditing(const LiveOptions& options) {
    if (state_->classified) {
        return fail(ErrorCode::InvalidArgument,
                    "pre-classified texels hold the transfer function, which cannot be edited in "
                    "them: take post or pre-integrated classification");
    }
    return state_->needCodes().and_then([&] {
        return LiveSkip::start({state_->codes, state_->texels, state_->geometry}, options,
                               state_->visibility(), skip())
            .map([&](LiveSkip&& live) {
                state_->live = std::move(live);
                state_->skip = noSkip();
            });
    });
}

Result<void> Scene::edit(TransferFunction tf) {
    SLABCAST_EXPECTS(state_->live.has_value(), state_->lookGeneration);
    return validated(std::move(tf)).map([&](TransferFunction&& valid) {
        state_->look.tf = std::move(valid);
        state_->lookGeneration = nextGeneration();
        state_->buildTable();
        findVisibility(*state_->codes, *state_->texels, state_->servingTable(),
                       state_->filterErrorSampled, state_->editedVisibility);
        state_->live->edit(state_->editedVisibility);
    });
}

LiveProgress Scene::work(double budgetMs) {
    SLABCAST_EXPECTS(state_->live.has_value(), state_->lookGeneration);
    return state_->live->work(budgetMs);
}

void Scene::stopEditing() {
    if (state_->live) {
        state_->skip = state_->live->current();
        state_->live.reset();
    }
}

std::vector<Scene> Scene::withEachServing() const {
    SLABCAST_EXPECTS(state_->live.has_value(), state_->lookGeneration);
    std::vector<Scene> scenes;
    for (LiveSkip& live : state_->live->eachServing()) {
        scenes.push_back(*this);
        scenes.back().state_->live = std::move(live);
    }
    return scenes;
}

void Scene::releaseCodes() {
    state_->codes.reset();
}

void Scene::releaseTexels() {
    Texels described = *state_->texels;
    described.data = {};
    state_->texels = std::make_shared<const Texels>(std::move(described));
}

const std::string& Scene::name() const {
    return state_->volumeName;
}

const VolumeGeometry& Scene::geometry() const {
    return state_->geometry;
}

const VolumeStatistics& Scene::statistics() const {
    return state_->statistics;
}

const Look& Scene::look() const {
    return state_->look;
}

const Texels& Scene::texels() const {
    return *state_->texels;
}

const TransferTable& Scene::table() const {
    return state_->servingTable();
}

const ClassifiedTexels* Scene::classified() const {
    return state_->classified ? &*state_->classified : nullptr;
}

const NormalTexels* Scene::normals() const {
    return state_->normals.get();
}

int Scene::normalsGeneration() const {
    return state_->normalsGeneration;
}

const PreintegratedTable* Scene::preintegrated() const {
    return state_->preintegrated ? &*state_->preintegrated : nullptr;
}

const BuiltSkip& Scene::skip() const {
    return state_->live ? state_->live->current() : state_->skip;
}

const LiveSkip* Scene::live() const {
    return state_->live ? &*state_->live : nullptr;
}

int Scene::texelsGeneration() const {
    return state_->texelsGeneration;
}

int Scene::lookGeneration() const {
    return state_->lookGeneration;
}

std::vector<const BuiltSkip*> Scene::residentSkips() const {
    if (state_->live) {
        return {&state_->live->always(), &state_->live->settled(), &state_->live->incoming()};
    }
    return {&state_->skip};
}

SceneFacts Scene::facts() const {
    SceneFacts facts;
    facts.look = state_->lookGeneration;
    facts.sphere = state_->geometry.boundingSphere();
    facts.smallestVoxelEdgeMm = state_->geometry.smallestVoxelEdgeMm();
    facts.exactField = isExact(state_->texels->format);
    facts.skip = skip().options;
    facts.occupiedFraction = skip().occupiedFraction;
    facts.facesAreClear = skip().facesAreClear;
    facts.isEdited = state_->live.has_value();
    if (!state_->provided) {
        return facts;
    }
    const std::vector<glm::vec4>& texels = table().texels;
    facts.oneMaterial =
        std::adjacent_find(texels.begin(), texels.end(), std::not_equal_to<>()) == texels.end();
    for (const glm::vec4& texel : texels) {
        facts.maxExtinctionPerMm = std::max(facts.maxExtinctionPerMm,
                                            static_cast<double>(texel.a) * table().extinctionPerMm);
    }
    facts.wideTable = state_->table.wide;
    facts.filtersTable = state_->filtersTable && !state_->table.wide;
    if (state_->classified) {
        facts.classifiedLengthMm = state_->classified->referenceLengthMm;
    }
    if (state_->normals) {
        facts.normals = state_->normals->error;
    }
    facts.visibleColorRange = visibleColorRange(state_->look.tf, state_->statistics.min,
                                                state_->statistics.max, state_->provided->space);
    facts.anythingVisible =
        facts.maxExtinctionPerMm > 0.0 && (!skip().exists() || skip().occupiedFraction > 0.0);
    return facts;
}

double Scene::defaultGradientFloorPerMm() const {
    return state_->defaultGradientFloorPerMm();
}

double Scene::State::defaultGradientFloorPerMm() const {
    constexpr double kShareOfRangePerVoxel = 0.005;
    const ValueRange range = statistics.shown();
    return kShareOfRangePerVoxel * (range.max - range.min) / geometry.smallestVoxelEdgeMm();
}

} // namespace slabcast
