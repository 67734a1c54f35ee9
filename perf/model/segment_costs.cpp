#include "perf/model/segment_costs.h"

#include <algorithm>
#include <map>
#include <string>

#include "core/base/number_text.h"
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

} // namespace

int layersPerGroup(const ShaderVariant& variant) {
    switch (variant.unroll) {
    case 1:
    case 2:
        return variant.unroll;
    case 4:
    case 12:
        return 4;
    default:
        return 8;
    }
}

std::optional<SegmentCosts> segmentCosts(std::string_view gpu, const ShaderVariant& asked) {
    ShaderVariant variant = asked;
    // Mesa 22's Adreno cannot fetch the target: there the same without stands for it.
    variant.fetchesTarget = asked.fetchesTarget && findLike(gpu, asked, 8, true) != nullptr;
    const bool skips = variant.skip != SkipForm::None;
    const WholeCosts* whole = find(gpu, variant);
    const WholeCosts* eight = findLike(gpu, variant, 8, skips);
    const WholeCosts* sixteen = findLike(gpu, variant, 16, skips);
    const WholeCosts* plainEight = findLike(gpu, variant, 8, false);
    const WholeCosts* plainSixteen = findLike(gpu, variant, 16, false);
    if (variant.unroll == 1 && whole != nullptr) { // a slice: all of it is done for every fragment
        SegmentCosts costs;
        costs.fragment = {whole->slots, std::max(0.0, whole->fetches - 1.0)};
        costs.codeBytes = whole->codeBytes;
        return costs;
    }
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
    // Others are as these and longer; a loop is as one group and what it takes to go round.
    const double layers = variant.unroll;
    costs.codeBytes =
        eight->codeBytes + (sixteen->codeBytes - eight->codeBytes) * (layers - 8.0) / 8.0;
    if (variant.unroll == 0) {
        if (whole == nullptr) {
            return std::nullopt;
        }
        costs.turn = difference(*whole, *eight, 1.0);
        costs.codeBytes = whole->codeBytes;
    } else if (whole != nullptr) {
        costs.fragment =
            rest(*whole, costs.layer, layers, costs.look, layers / layersPerGroup(variant));
        costs.codeBytes = whole->codeBytes;
    }
    return costs;
}

} // namespace slabcast
