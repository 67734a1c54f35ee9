#include "perf/ratios/ratio_table.h"

#include <functional>
#include <set>

#include <gtest/gtest.h>

#include "core/volume/phantoms.h"
#include "perf/stage.h"

namespace slabcast {
namespace {

TransferFunction ramp(double opacity) {
    return {.name = "ramp", .points = {{0.0, {1, 1, 1}, 0.0}, {255.0, {1, 1, 1}, opacity}}};
}

/// What a key is made of.
struct Drawn {
    gl::Caps caps{.renderer = "A"};
    std::string volume = "phantom:sphere:8";
    TransferFunction tf = ramp(0.5);
    StageDesc desc;
    Settings settings;
    std::string commit = "c";
};

std::string keyOf(const Drawn& drawn) {
    Scene scene = Scene::create(makePhantom(drawn.volume).value(), TextureChoice{}).value();
    EXPECT_TRUE(scene.setLook({.tf = drawn.tf}).has_value());
    return ratioKey(drawn.caps, scene, drawn.desc, drawn.settings, drawn.commit);
}

TEST(RatioTable, AKeyTellsApartAllThatAFrameTakesTimeBy) {
    const std::function<void(Drawn&)> changes[] = {
        [](Drawn&) {},
        [](Drawn& d) { d.caps.renderer = "B"; },
        [](Drawn& d) { d.caps.driver = "2"; },
        [](Drawn& d) { d.caps.extensions = {"GL_EXT_x"}; },
        [](Drawn& d) { d.volume = "phantom:shells:8"; },
        [](Drawn& d) { d.tf = ramp(0.25); },
        [](Drawn& d) {
            d.desc.size = {640, 480};
        },
        [](Drawn& d) { d.desc.camera.azimuthDegrees = 30.0; },
        [](Drawn& d) { d.desc.fovDegrees = 90.0; },
        [](Drawn& d) { d.desc.stereoIpdMm = 60.0; },
        [](Drawn& d) { d.settings.termination.reset(); },
        [](Drawn& d) { d.settings.layerSpacingVoxels = 0.5; },
        [](Drawn& d) { d.settings.form = SegmentForm::Loop; },
        [](Drawn& d) { d.settings.skip = SkipStructure::None; },
        [](Drawn& d) { d.commit = "d"; },
    };
    std::set<std::string> keys;
    for (const auto& change : changes) {
        Drawn drawn;
        change(drawn);
        keys.insert(keyOf(drawn));
    }
    EXPECT_EQ(keys.size(), std::size(changes));
    Drawn dealt; // the ratio is what is kept
    dealt.settings.planes = 3;
    EXPECT_EQ(keyOf(dealt), keyOf({}));
}

KeptRatios kept(const std::string& key, double ms) {
    return {key, "ball", "2026-11-30T00:00:00Z", {{{4, 16, SegmentForm::Unrolled}, ms}}};
}

TEST(RatioTable, WhatIsMeasuredAnewTakesThePlaceOfTheOld) {
    std::vector<KeptRatios> table = withRatios({kept("a", 1.0), kept("b", 2.0)}, kept("a", 3.0));
    ASSERT_EQ(table.size(), 2U);
    EXPECT_EQ(findRatios(table, "a")->ratios[0].frameMs, 3.0);
    EXPECT_EQ(findRatios(table, "c"), nullptr);
    for (std::size_t k = 0; k < kMostKeptScenes; ++k) {
        table = withRatios(std::move(table), kept("n" + std::to_string(k), 1.0));
    }
    EXPECT_EQ(table.size(), kMostKeptScenes);
    EXPECT_EQ(findRatios(table, "a"), nullptr); // the oldest went
    EXPECT_NE(findRatios(table, "n0"), nullptr);
}

TEST(RatioTable, IsReadAsItWasWritten) {
    const std::vector<KeptRatios> table = {kept("a", 0.1), kept("b", 1e-3)};
    const std::vector<KeptRatios> read = parseRatioTable(ratioTableText(table)).value();
    ASSERT_EQ(read.size(), 2U);
    for (std::size_t k = 0; k < read.size(); ++k) {
        EXPECT_EQ(read[k].key, table[k].key);
        EXPECT_EQ(read[k].subject, table[k].subject);
        EXPECT_EQ(read[k].date, table[k].date);
        ASSERT_EQ(read[k].ratios.size(), 1U);
        EXPECT_EQ(read[k].ratios[0].ratio, table[k].ratios[0].ratio);
        EXPECT_EQ(read[k].ratios[0].frameMs, table[k].ratios[0].frameMs);
    }
}

TEST(RatioTable, WhatCannotBeIsRefused) {
    const std::string sound = ratioTableText({kept("a", 1.0)});
    const std::pair<const char*, const char*> damages[] = {
        {"\"version\": 1", "\"version\": 2"},
        {"\"scenes\"", "\"rows\""},
        {"\"key\": \"a\"", "\"key\": 3"},
        {"\"planes\": 4", "\"planes\": 0"},
        {"\"planes\": 4", "\"planes\": 1e9"},
        {"\"layers_per_plane\": 16", "\"layers_per_plane\": 1000"}, // too long to unroll
        {"\"unrolled\": true", "\"unrolled\": 1"},
        {"\"frame_ms\": 1.0", "\"frame_ms\": 0.0"},
        {"\"frame_ms\": 1.0", "\"frame_ms\": 1e999"},
        {"\"ratios\"", "\"ratio\""},
    };
    EXPECT_TRUE(parseRatioTable(sound).has_value());
    for (const auto& [from, to] : damages) {
        std::string bad = sound;
        const std::size_t at = bad.find(from);
        ASSERT_NE(at, std::string::npos) << from;
        bad.replace(at, std::string(from).size(), to);
        EXPECT_FALSE(parseRatioTable(bad).has_value()) << to;
    }
    for (const char* bad : {"", "[]", "{", "null"}) {
        EXPECT_FALSE(parseRatioTable(bad).has_value()) << bad;
    }
}

} // namespace
} // namespace slabcast
