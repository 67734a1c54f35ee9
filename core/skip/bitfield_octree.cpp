#include "core/skip/bitfield_octree.h"

namespace slabcast {

namespace {

constexpr int kMaxBits = 128;
using NodeWords = std::array<std::uint32_t, kMaxBits / 32>;

/// Entry b: the bits below b.
std::array<NodeWords, kMaxBits + 1> bitsBelow() {
    std::array<NodeWords, kMaxBits + 1> below{};
    for (int b = 0; b < kMaxBits; ++b) {
        below[b + 1] = below[b];
        below[b + 1][b / 32] |= 1U << (b % 32);
    }
    return below;
}

} // namespace

BitfieldOctree bitfieldOctree(const Octree& minMax, ValueBins bins) {
    SLABCAST_EXPECTS(bins.count <= kMaxBits, bins.count);
    const auto below = bitsBelow();
    const int wordsPerNode = (bins.count + 31) / 32;
    // Bins rise with codes: those of a node's ends are its first and its last.
    const auto write = [&](NodeRange range, std::uint32_t* words) {
        const NodeWords& lacking = below[bins.binOfCode[range.least]];
        const NodeWords& upTo = below[bins.binOfCode[range.greatest] + 1];
        for (int w = 0; w < wordsPerNode; ++w) {
            words[w] = upTo[w] & ~lacking[w];
        }
    };
    Octree octree = derivedOctree(minMax,
                                  {.content = NodeContent::Bits,
                                   .leafEdgeVoxels = minMax.leafEdgeVoxels,
                                   .bitsPerNode = bins.count},
                                  write);
    return {std::move(octree), std::move(bins)};
}

Result<BitfieldOctree> buildBitfieldOctree(const TexelCodes& codes, ValueBins bins,
                                           const SkipOptions& options, const CancelToken* cancel) {
    SLABCAST_EXPECTS(bins.count == options.bits, bins.count);
    return buildMinMaxOctree(codes, options, cancel).map([&](const Octree& minMax) {
        return bitfieldOctree(minMax, std::move(bins));
    });
}

NodeTest bitfieldNodeTest(const ValueBins& bins, const CellVisibility& visibility) {
    SLABCAST_EXPECTS(bins.count <= kMaxBits, bins.count);
    const BinSet visible = visibleBins(bins, visibility);
    return {glm::uvec4(visible[0], visible[1], visible[2], visible[3])};
}

} // namespace slabcast
