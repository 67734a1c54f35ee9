#include "perf/mobile/reachable_variants.h"

#include <functional>
#include <utility>
#include <vector>

#include "core/plan/frame_plan.h"
#include "core/plan/shader_axes.h"

namespace slabcast {

namespace {

using Change = std::function<void(Settings&)>;

/// One choice each that differs from the default settings.
std::vector<Change> settingsChanges() {
    std::vector<Change> changes = {
        [](Settings&) {},
        [](Settings& s) { s.classification = Classification::Pre; },
        [](Settings& s) { s.classification = Classification::Preintegrated; },
        [](Settings& s) { s.skip = SkipStructure::None; },
        [](Settings& s) { s.lattice = LatticeKind::Planar; },
        [](Settings& s) { s.lattice = LatticeKind::Shells; },
        [](Settings& s) { s.jitter = true; },
        [](Settings& s) { s.totalLayers = 1; },
        [](Settings& s) { s.planes = 1; },
        [](Settings& s) { s.form = SegmentForm::Loop; },
        [](Settings& s) { s.tighten = false; },
        [](Settings& s) { s.target = TargetFormat::Rgba16f; },
        [](Settings& s) { s.space = CompositingSpace::Linear; },
        [](Settings& s) { s.shaded = true; },
        [](Settings& s) {
            s.shaded = true;
            s.normals = Normals::Baked;
        },
        [](Settings& s) { s.order = BlendOrder::FrontToBack; },
        [](Settings& s) { s.termination.reset(); },
    };
    for (const int length : kUnrollLengths) {
        changes.push_back([length](Settings& s) { s.layersPerPlane = length; });
    }
    return changes;
}

/// Every form of skipping, filtered or exact, as thin and as dense as decides anything, with clear
/// faces or not, and on devices whose filter may read a table or not.
std::vector<SceneFacts> factsOfAllKinds(bool extremes) {
    const SkipOptions structures[] = {
        {.structure = SkipStructure::None},
        {.structure = SkipStructure::Proximity},
        {.structure = SkipStructure::Chebyshev},
        {.structure = SkipStructure::BooleanOctree},
        {.structure = SkipStructure::BitfieldOctree, .bits = 128},
        {.structure = SkipStructure::MinMaxOctree},
    };
    std::vector<SceneFacts> all;
    for (const SkipOptions& skip : structures) {
        for (const bool exact : {false, true}) {
            for (const double extinction : {1e-6, 10.0}) {
                for (const int kind : {0, 1, 2, 3}) {
                    const bool usual = skip.structure == SkipStructure::Proximity;
                    if (extremes && kind != 0 && !(kind == 3 && extinction > 1.0 && usual)) {
                        continue;
                    }
                    SceneFacts facts;
                    facts.sphere = {glm::dvec3(0.0), 222.0};
                    facts.exactField = exact;
                    facts.skip = skip;
                    facts.occupiedFraction = 0.5;
                    facts.maxExtinctionPerMm = extinction;
                    facts.facesAreClear = kind % 2 == 1;
                    facts.filtersTable = kind / 2 == 1;
                    if (kind / 2 == 1) { // pre-classified texels are made for this spacing
                        facts.classifiedLengthMm = facts.smallestVoxelEdgeMm;
                    }
                    all.push_back(facts);
                }
            }
        }
    }
    return all;
}

/// Whatever the scene and the device.
void planAll(const Settings& settings, const std::vector<SceneFacts>& facts,
             std::set<ShaderVariant>& reached) {
    for (const SceneFacts& of : facts) {
        for (const int device : {0, 1, 2, 3}) {
            gl::Caps caps;
            caps.isSoftware = device % 2 == 1;
            caps.framebufferFetch = device / 2 == 1;
            if (const Result<FramePlan> made = plan(of, settings, caps, {})) {
                ShaderVariant variant = made->variant;
                reached.insert(variant);
                variant.counts = true;
                reached.insert(variant);
            }
        }
    }
}

} // namespace

std::set<ShaderVariant> reachableVariants(int choices, bool extremes) {
    std::set<ShaderVariant> reached;
    const std::vector<Change> changes = settingsChanges();
    const std::vector<SceneFacts> facts = factsOfAllKinds(extremes);
    const std::function<void(const Settings&, std::size_t, int)> choose =
        [&](const Settings& settings, std::size_t from, int left) {
            if (left == 0) {
                planAll(settings, facts, reached);
                return;
            }
            for (std::size_t k = from; k < changes.size(); ++k) {
                Settings changed = settings;
                changes[k](changed);
                choose(changed, k + 1, left - 1);
            }
        };
    choose({}, 0, choices);
    return reached;
}

std::set<ShaderVariant> validVariants() {
    std::vector<ShaderVariant> variants(1);
    for (const AxisInfo& axis : kAxes) {
        std::vector<ShaderVariant> next;
        for (const ShaderVariant& variant : variants) {
            for (std::size_t value = 0; value < axis.count; ++value) {
                axis.choose(next.emplace_back(variant), value);
            }
        }
        variants = std::move(next);
    }
    std::erase_if(variants, [](const ShaderVariant& variant) { return !variant.valid(); });
    return {variants.begin(), variants.end()};
}

} // namespace slabcast
