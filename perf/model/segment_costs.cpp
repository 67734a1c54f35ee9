#include "perf/model/segment_costs.h"

#include <algorithm>
#include <map>
#include <string>

#include "core/base/number_text.h"
#include "core/plan/shader_axes.h"
#include "perf/mobile/compile_variants.h"

namespace slabcast {

namespace {

constexpr std::string_view kTable =
#include "perf/model/segment_costs.inc"
    ;

/// The whole of a shader.
struct WholeCosts {
    double slots = 0.0;
    double fetches = 0.0;
    double codeBytes = 0.0;
};

std::string_view upTo(char end, std::string_view& text) {
    const std::size_t length = std::min(text.find(end), text.size());
    const std::string_view part = text.substr(0, length);
    text.remove_prefix(std::min(length + 1, text.size()));
    return part;
}

/// By GPU and label: "g71,post/unroll8".
std::map<std::string, WholeCosts, std::less<>> parsed(std::string_view table) {
    std::map<std::string, WholeCosts, std::less<>> all;
    while (!table.empty()) {
        std::string_view line = upTo('\n', table);
        if (line.empty()) {
            continue;
        }
        std::string key(upTo(',', line));
        key += "," + std::string(upTo(',', line));
        const auto number = [&line] { return numberFrom(upTo(',', line)).value_or(0.0); };
        WholeCosts& costs = all[key];
        costs.slots = number();
        costs.fetches = number();
        costs.codeBytes = number();
    }
    return all;
}

const WholeCosts* find(std::string_view gpu, const ShaderVariant& variant) {
    static const auto all = parsed(kTable);
    ShaderVariant drawn = variant;
    drawn.counts = false;
    const auto found = all.find(std::string(gpu) + "," + labelOf(drawn));
    return found == all.end() ? nullptr : &found->second;
}

/// The same with so many layers written out, and perhaps without skipping.
const WholeCosts* findLike(std::string_view gpu, ShaderVariant variant, int layers, bool skips) {
    variant.unroll = layers;
    variant.skip = skips ? variant.skip : SkipForm::None;
    return find(gpu, variant);
}

PartCosts difference(const WholeCosts& more, const WholeCosts& less, double share) {
    return {std::max(0.0, more.slots - less.slots) * share,
            std::max(0.0, more.fetches - less.fetches) * share};
}

/// What is left of a whole after so many layers and looks.
PartCosts rest(const WholeCosts& whole, const PartCosts& layer, double layers,
               const PartCosts& look, double looks) {
    return {std::max(0.0, whole.slots - layer.slots * layers - look.slots * looks),
            std::max(0.0, whole.fetches - layer.fetches * layers - look.fetches * looks)};
}

/// Fragment, layer and look of a shader of groups of 8.
std::optional<SegmentCosts> partsOf(std::string_view gpu, const ShaderVariant& variant) {
    const bool skips = variant.skip != SkipForm::None;
    const WholeCosts* eight = findLike(gpu, variant, 8, skips);
    const WholeCosts* sixteen = findLike(gpu, variant, 16, skips);
    const WholeCosts* plainEight = findLike(gpu, variant, 8, false);
    const WholeCosts* plainSixteen = findLike(gpu, variant, 16, false);
    if (eight == nullptr || sixteen == nullptr || plainEight == nullptr ||
        plainSixteen == nullptr) {
        return std::nullopt;
    }
    SegmentCosts costs;
    costs.layer = difference(*plainSixteen, *plainEight, 1.0 / 8.0);
    if (skips) {
        const PartCosts group = difference(*sixteen, *eight, 1.0);
        costs.look = {std::max(0.0, group.slots - 8.0 * costs.layer.slots),
                      std::max(0.0, group.fetches - 8.0 * costs.layer.fetches)};
    }
    costs.fragment = rest(*eight, costs.layer, 8.0, costs.look, 1.0);
    const double perLayer = (sixteen->codeBytes - eight->codeBytes) / 8.0;
    costs.codeBytes = eight->codeBytes + perLayer * (variant.unroll - 8.0);
    return costs;
}

/// What a box costs a fragment beside none.
PartCosts boxOf(std::string_view gpu, ShaderVariant variant) {
    variant.interval = Interval::Box;
    const std::optional<SegmentCosts> box = partsOf(gpu, variant);
    variant.interval = Interval::None;
    const std::optional<SegmentCosts> none = partsOf(gpu, variant);
    return box && none ? PartCosts{box->fragment.slots - none->fragment.slots,
                                   box->fragment.fetches - none->fragment.fetches}
                       : PartCosts{};
}

/// Of layers of one length those at a ray's ends stand apart, behind a branch: what a box costs
/// beside cutting the ray, which is all that it costs where every layer has its own length.
PartCosts endsOf(std::string_view gpu, const ShaderVariant& variant) {
    if (variant.lengths != Lengths::Baked || variant.interval != Interval::Box) {
        return {};
    }
    ShaderVariant cut = variant;
    cut.lengths = Lengths::PerRay;
    cut.lattice = LatticeKind::Planar;
    const PartCosts both = boxOf(gpu, variant);
    const PartCosts cutting = boxOf(gpu, cut);
    return {std::max(0.0, both.slots - std::max(0.0, cutting.slots)),
            std::max(0.0, both.fetches - std::max(0.0, cutting.fetches))};
}

PartCosts without(const PartCosts& all, const PartCosts& part) {
    return {std::max(0.0, all.slots - part.slots), std::max(0.0, all.fetches - part.fetches)};
}

} // namespace

int layersPerGroup(const ShaderVariant& variant) {
    return axes::kForm[axes::formOf(variant)].layersPerGroup;
}

std::optional<SegmentCosts> segmentCosts(std::string_view gpu, const ShaderVariant& asked) {
    ShaderVariant variant = asked;
    // Mesa 22's Adreno cannot fetch the target: there the same without stands for it.
    variant.fetchesTarget = asked.fetchesTarget && findLike(gpu, asked, 8, true) != nullptr;
    const WholeCosts* whole = find(gpu, variant);
    // Of a slice or two all is done for every fragment.
    if ((variant.unroll == 1 || variant.unroll == 2) && whole != nullptr) {
        SegmentCosts costs;
        costs.fragment = {whole->slots, std::max(0.0, whole->fetches - variant.unroll)};
        costs.codeBytes = whole->codeBytes;
        return costs;
    }
    std::optional<SegmentCosts> costs = partsOf(gpu, variant);
    if (!costs || (whole == nullptr && variant.unroll == 0)) {
        return std::nullopt;
    }
    // Other lengths are as these; a loop is as one group and what it takes to go round.
    if (whole != nullptr) {
        costs->codeBytes = whole->codeBytes;
    }
    if (variant.unroll == 0) {
        costs->turn = difference(*whole, *findLike(gpu, variant, 8, true), 1.0);
    } else if (whole != nullptr) {
        const double groups = double(variant.unroll) / layersPerGroup(variant);
        costs->fragment = rest(*whole, costs->layer, variant.unroll, costs->look, groups);
    }
    costs->ends = endsOf(gpu, variant);
    costs->fragment = without(costs->fragment, costs->ends);
    return costs;
}

} // namespace slabcast
