#include "perf/json.h"
#include "perf/settings_json.h"

#include <gtest/gtest.h>

#include "perf/report_json.h"

namespace slabcast::test {
namespace {

TEST(SettingsJson, holdsEverySettingByItsName) {
    const Json all = toJson(Settings{});
    EXPECT_EQ(all.size(), settingsTable().size());
    for (const Setting& setting : settingsTable()) {
        EXPECT_TRUE(all.contains(keyOf(setting.name))) << setting.name;
    }
}

TEST(SettingsJson, keysAreSnakeCase) {
    EXPECT_EQ(keyOf("layers"), "layers");
    EXPECT_EQ(keyOf("layers-per-plane"), "layers_per_plane");
    EXPECT_EQ(keyOf("early exit"), "early_exit");
    EXPECT_EQ(keyOf(""), "");
}

TEST(SettingsJson, valuesAreNumbersWordsAndNothing) {
    Settings settings;
    settings.planes = 12;
    settings.jitter = true;
    settings.skipOptions.valueRange = std::array{-0.5, 2.0};
    settings.order = BlendOrder::FrontToBack;
    const Json all = toJson(settings);
    EXPECT_EQ(all.at("planes"), Json(12));
    EXPECT_TRUE(all.at("planes").isWhole());
    EXPECT_TRUE(all.at("layers").isNull());
    EXPECT_EQ(all.at("layer_spacing"), Json(1.0));
    EXPECT_EQ(all.at("jitter"), Json(true));
    EXPECT_EQ(all.at("shade"), Json(false));
    EXPECT_EQ(all.at("order"), Json("front-to-back"));
    EXPECT_TRUE(all.at("skip").isNull());
    EXPECT_EQ(all.at("value_range"), Json::list({-0.5, 2.0}));
    EXPECT_EQ(all.at("termination"), Json(0.99609375));
}

TEST(SettingsJson, areTakenBackAsTheyWere) {
    Settings settings;
    settings.planes = 12;
    settings.layerSpacingVoxels = 1.0 / 3.0;
    settings.jitter = true;
    settings.skip = SkipStructure::BitfieldOctree;
    settings.skipOptions.valueRange = std::array{-0.1, 2e-7};
    settings.order = BlendOrder::FrontToBack;
    settings.termination = std::nullopt;
    for (const Json& all : {toJson(settings), Json{{"settings", toJson(settings)}, {"date", 1}}}) {
        Settings taken;
        const Result<void> went = takeSettings(taken, Json::parse(all.dump()).value());
        ASSERT_TRUE(went) << went.error().detail;
        for (const Setting& setting : settingsTable()) {
            EXPECT_EQ(setting.read(taken), setting.read(settings)) << setting.name;
        }
    }
}

TEST(SettingsJson, whatIsNotNamedOrLeftStays) {
    Settings settings;
    settings.planes = 12;
    settings.jitter = true;
    constexpr std::array<std::string_view, 1> kLeft = {"planes"};
    ASSERT_TRUE(takeSettings(settings, Json{{"planes", 7}, {"space", "linear"}}, kLeft));
    EXPECT_EQ(settings.planes, 12);
    EXPECT_TRUE(settings.jitter);
    EXPECT_EQ(settings.space, CompositingSpace::Linear);
}

TEST(SettingsJson, whatIsNoSettingIsRefusedWhole) {
    const std::array<std::pair<Json, std::string>, 6> cases = {{
        {Json{{"jitter", true}, {"no_such", 1}}, "no_such: is no setting"},
        {Json{{"jitter", true}, {"layers-per-plane", 1}}, "layers-per-plane: is no setting"},
        {Json{{"jitter", true}, {"layers", 0}}, "layers: '0' is not a whole number from 1"},
        {Json{{"jitter", true}, {"target", nullptr}}, "target: 'null' is not one of"},
        {Json{{"jitter", true}, {"value_range", Json::list({1})}}, "value-range: '[1]' is not"},
        {Json::list({1}), "holds no settings"},
    }};
    for (const auto& [given, cause] : cases) {
        Settings settings;
        const Result<void> taken = takeSettings(settings, given);
        ASSERT_FALSE(taken) << cause;
        EXPECT_TRUE(taken.error().detail.starts_with(cause)) << taken.error().detail;
        EXPECT_FALSE(settings.jitter) << cause;
    }
}

} // namespace
} // namespace slabcast::test
