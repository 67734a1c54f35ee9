#include "core/skip/skip_structure.h"

#include <algorithm>
#include <set>
#include <string>

#include <gtest/gtest.h>

namespace slabcast {
namespace {

std::set<std::string> namesOfStructures() {
    std::set<std::string> names;
    for (const SkipStructureInfo& info : skipStructures()) {
        names.insert(info.name);
    }
    return names;
}

SkipOptions optionsOf(const SkipStructureInfo& info) {
    SkipOptions options{.structure = info.structure};
    if (!info.edges.empty()) {
        options.blockEdgeVoxels = info.edges.front();
    }
    return options;
}

bool refuses(const SkipOptions& options) {
    const Result<void> result = check(options);
    return !result && result.error().code == ErrorCode::InvalidArgument;
}

TEST(SkipStructure, IsListedUnderItsOwnName) {
    EXPECT_EQ(namesOfStructures(),
              (std::set<std::string>{"none", "blocks", "proximity", "chebyshev", "partitioned",
                                     "boolean-octree", "minmax-octree", "bitfield-octree"}));
    EXPECT_EQ(skipStructures().size(), 8U);
    for (std::size_t i = 0; i < skipStructures().size(); ++i) {
        const SkipStructureInfo& info = skipStructures()[i];
        EXPECT_EQ(std::size_t(info.structure), i);
        EXPECT_EQ(&infoOf(info.structure), &info);
        EXPECT_STREQ(name(info.structure), info.name);
        EXPECT_EQ(isOctree(info.structure), std::string(info.name).ends_with("-octree"));
    }
}

TEST(SkipStructure, FormsAndTraversalsHaveNamesOfTheirOwn) {
    std::set<std::string> names;
    for (const SkipForm form : {SkipForm::None, SkipForm::Balls, SkipForm::Boxes, SkipForm::Octree,
                                SkipForm::WideOctree, SkipForm::RangeOctree}) {
        names.insert(name(form));
    }
    EXPECT_EQ(names.size(), 6U);
    EXPECT_STREQ(name(SkipForm::RangeOctree), "range-octree");
    EXPECT_STRNE(name(Traversal::TopDown), name(Traversal::Bidirectional));
}

TEST(SkipStructure, DependsOnTheTransferFunctionWhereItHoldsNoValues) {
    const std::set<std::string> free{"partitioned", "minmax-octree", "bitfield-octree", "none"};
    for (const SkipStructureInfo& info : skipStructures()) {
        EXPECT_EQ(info.dependsOnTransfer, free.count(info.name) == 0) << info.name;
    }
}

TEST(SkipStructure, HasAForm) {
    const SkipForm forms[] = {SkipForm::None,        SkipForm::Boxes, SkipForm::Balls,
                              SkipForm::Boxes,       SkipForm::Boxes, SkipForm::Octree,
                              SkipForm::RangeOctree, SkipForm::Octree};
    for (const SkipStructureInfo& info : skipStructures()) {
        EXPECT_EQ(formOf(optionsOf(info)), forms[std::size_t(info.structure)]) << info.name;
    }
    for (const int bits : {8, 16, 32, 64, 128}) {
        EXPECT_EQ(formOf({.structure = SkipStructure::BitfieldOctree, .bits = bits}),
                  bits > 32 ? SkipForm::WideOctree : SkipForm::Octree);
    }
}

TEST(SkipOptions, OfferTheirEdgesAndNoOthers) {
    for (const SkipStructureInfo& info : skipStructures()) {
        SkipOptions options = optionsOf(info);
        for (int edge = -1; edge <= 130; ++edge) {
            options.blockEdgeVoxels = edge;
            const bool offered =
                info.structure == SkipStructure::None ||
                std::find(info.edges.begin(), info.edges.end(), edge) != info.edges.end();
            EXPECT_EQ(check(options).has_value(), offered) << info.name << ' ' << edge;
            EXPECT_EQ(refuses(options), !offered) << info.name << ' ' << edge;
        }
    }
}

TEST(SkipOptions, AreLookedAtWhereTheyBelong) {
    for (const SkipStructureInfo& info : skipStructures()) {
        const bool bitfield = info.structure == SkipStructure::BitfieldOctree;
        const bool partitioned = info.structure == SkipStructure::Partitioned;
        const bool none = info.structure == SkipStructure::None;
        SkipOptions options = optionsOf(info);
        EXPECT_FALSE(refuses(options)) << info.name;
        options.bits = 24;
        EXPECT_EQ(refuses(options), bitfield) << info.name;
        options = optionsOf(info);
        options.partitions = 8;
        EXPECT_EQ(refuses(options), partitioned) << info.name;
        options = optionsOf(info);
        options.initialLevel = -1;
        EXPECT_EQ(refuses(options), !none) << info.name;
        options = optionsOf(info);
        options.valueRange = {2.0, 2.0};
        EXPECT_EQ(refuses(options), !none) << info.name;
        options.valueRange = {2.0, 3.0};
        EXPECT_FALSE(refuses(options)) << info.name;
    }
}

TEST(SkipOptions, BitsAndPartitionsAreThoseOffered) {
    for (int value = 0; value <= 300; ++value) {
        const std::set<int> bits{8, 16, 32, 64, 128};
        const std::set<int> partitions{16, 32, 64, 128, 256};
        EXPECT_EQ(refuses({.structure = SkipStructure::BitfieldOctree, .bits = value}),
                  bits.count(value) == 0);
        EXPECT_EQ(refuses({.structure = SkipStructure::Partitioned, .partitions = value}),
                  partitions.count(value) == 0);
    }
}

TEST(SkipOptions, RefusalsNameWhatIsOffered) {
    const auto result = check({.structure = SkipStructure::Chebyshev, .blockEdgeVoxels = 3});
    ASSERT_FALSE(result.has_value());
    EXPECT_EQ(result.error().detail, "block edge of chebyshev 3: not offered; use 1, 2, 4 or 8");
}

} // namespace
} // namespace slabcast
