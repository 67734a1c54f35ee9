#include "perf/settings_json.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "perf/report_json.h"

namespace slabcast::test {
namespace {

using nlohmann::json;

TEST(SettingsJson, holdsEverySettingByItsName) {
    const json all = toJson(Settings{});
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
    const json all = toJson(settings);
    EXPECT_EQ(all.at("planes"), json(12));
    EXPECT_TRUE(all.at("planes").is_number_integer());
    EXPECT_TRUE(all.at("layers").is_null());
    EXPECT_EQ(all.at("layer_spacing"), json(1.0));
    EXPECT_EQ(all.at("jitter"), json(true));
    EXPECT_EQ(all.at("shade"), json(false));
    EXPECT_EQ(all.at("order"), json("front-to-back"));
    EXPECT_TRUE(all.at("skip").is_null());
    EXPECT_EQ(all.at("value_range"), json({-0.5, 2.0}));
    EXPECT_EQ(all.at("termination"), json(0.99609375));
}

} // namespace
} // namespace slabcast::test
