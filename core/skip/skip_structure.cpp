#include "core/skip/skip_structure.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace slabcast {

namespace {

constexpr std::array kBlockEdges{1, 2, 4, 8, 16, 32};
constexpr std::array kDistanceEdges{1, 2, 4, 8};
constexpr std::array kLeafEdges{2, 4, 8, 16, 32, 64};
constexpr std::array kBits{8, 16, 32, 64, 128};
constexpr std::array kPartitions{16, 32, 64, 128, 256};

constexpr SkipStructureInfo kStructures[] = {
    {SkipStructure::None, "none", false, {}},
    {SkipStructure::Blocks, "blocks", true, kBlockEdges},
    {SkipStructure::Proximity, "proximity", true, kDistanceEdges},
    {SkipStructure::Chebyshev, "chebyshev", true, kDistanceEdges},
    {SkipStructure::Partitioned, "partitioned", false, kDistanceEdges},
    {SkipStructure::BooleanOctree, "boolean-octree", true, kLeafEdges},
    {SkipStructure::MinMaxOctree, "minmax-octree", false, kLeafEdges},
    {SkipStructure::BitfieldOctree, "bitfield-octree", false, kLeafEdges},
};

constexpr const char* kForms[] = {"none",   "balls",       "boxes",
                                  "octree", "wide-octree", "range-octree"};

std::string listed(std::span<const int> values) {
    std::string text;
    for (std::size_t i = 0; i < values.size(); ++i) {
        text += (i == 0 ? "" : i + 1 == values.size() ? " or " : ", ") + std::to_string(values[i]);
    }
    return text;
}

Result<void> checkOffered(const std::string& what, int value, std::span<const int> offered) {
    if (std::find(offered.begin(), offered.end(), value) != offered.end()) {
        return {};
    }
    return fail(ErrorCode::InvalidArgument,
                what + " " + std::to_string(value) + ": not offered; use " + listed(offered));
}

} // namespace

std::span<const SkipStructureInfo> skipStructures() {
    return kStructures;
}

const SkipStructureInfo& infoOf(SkipStructure structure) {
    const auto index = static_cast<std::size_t>(structure);
    SLABCAST_EXPECTS(index < std::size(kStructures), index);
    return kStructures[index];
}

const char* name(SkipStructure structure) {
    return infoOf(structure).name;
}

const char* name(SkipForm form) {
    return kForms[static_cast<std::size_t>(form)];
}

const char* name(Traversal traversal) {
    return traversal == Traversal::TopDown ? "top-down" : "bidirectional";
}

bool isOctree(SkipStructure structure) {
    return structure >= SkipStructure::BooleanOctree;
}

Result<void> check(const SkipOptions& o) {
    if (o.structure == SkipStructure::None) {
        return {};
    }
    const std::string of = std::string(" of ") + name(o.structure);
    const char* edge = isOctree(o.structure) ? "leaf edge" : "block edge";
    if (Result<void> ok = checkOffered(edge + of, o.blockEdgeVoxels, infoOf(o.structure).edges);
        !ok) {
        return ok;
    }
    if (o.structure == SkipStructure::BitfieldOctree) {
        if (Result<void> ok = checkOffered("bits per node" + of, o.bits, kBits); !ok) {
            return ok;
        }
    }
    if (o.structure == SkipStructure::Partitioned) {
        if (Result<void> ok = checkOffered("partitions" + of, o.partitions, kPartitions); !ok) {
            return ok;
        }
    }
    if (o.initialLevel < 0) {
        return fail(ErrorCode::InvalidArgument, "initial level " + std::to_string(o.initialLevel) +
                                                    ": give 0, the root, or more");
    }
    if (o.valueRange && !((*o.valueRange)[0] < (*o.valueRange)[1] &&
                          std::isfinite((*o.valueRange)[0]) && std::isfinite((*o.valueRange)[1]))) {
        return fail(ErrorCode::InvalidArgument,
                    "value range of the bins: give two finite values, the lower one first");
    }
    return {};
}

SkipForm formOf(const SkipOptions& o) {
    switch (o.structure) {
    case SkipStructure::None:
        return SkipForm::None;
    case SkipStructure::Proximity:
        return SkipForm::Balls;
    case SkipStructure::Blocks:
    case SkipStructure::Chebyshev:
    case SkipStructure::Partitioned:
        return SkipForm::Boxes;
    case SkipStructure::BooleanOctree:
        return SkipForm::Octree;
    case SkipStructure::MinMaxOctree:
        return SkipForm::RangeOctree;
    case SkipStructure::BitfieldOctree:
        return o.bits > 32 ? SkipForm::WideOctree : SkipForm::Octree;
    }
    contractBreach(__func__, "a skip structure", static_cast<double>(o.structure));
}

} // namespace slabcast
