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

} // namespace
} // namespace slabcast::test
