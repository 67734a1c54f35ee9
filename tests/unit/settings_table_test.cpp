#include "core/plan/settings_table.h"

#include <clocale>
#include <cstdlib>
#include <fstream>
#include <sstream>

#include <gtest/gtest.h>

#include "core/base/number_text.h"
#include "core/plan/settings_check.h"

namespace slabcast::test {
namespace {

/// Values that a setting takes: all words and offered numbers, both ends of a range and between.
std::vector<std::string> textsOf(const Setting& setting) {
    std::vector<std::string> texts(setting.words.begin(), setting.words.end());
    for (const int value : setting.offered) {
        texts.push_back(std::to_string(value));
    }
    if (setting.unset != nullptr) {
        texts.emplace_back(setting.unset);
    }
    if (setting.kind == SettingKind::Range) {
        texts.emplace_back("-100.5,3000");
    } else if (texts.empty() || setting.kind == SettingKind::Real || setting.offered.empty()) {
        if (setting.kind != SettingKind::Choice) {
            texts.push_back(numberText(setting.low));
            texts.push_back(numberText(setting.high));
            texts.push_back(setting.kind == SettingKind::Whole ? "7" : "0.3");
        }
    }
    return texts;
}

TEST(SettingsTable, everyValueOfEverySettingComesBackAndTouchesNoOther) {
    for (const Setting& setting : settingsTable()) {
        for (const std::string& text : textsOf(setting)) {
            SCOPED_TRACE(std::string(setting.name) + " " + text);
            Settings settings;
            const Result<void> done = set(settings, setting.name, text);
            ASSERT_TRUE(done) << done.error().detail;
            EXPECT_EQ(get(settings, setting.name), text);
            for (const Setting& other : settingsTable()) {
                if (other.name != setting.name) {
                    EXPECT_EQ(get(settings, other.name), get(Settings{}, other.name)) << other.name;
                }
            }
        }
    }
}

TEST(SettingsTable, everyMemberOfTheSettingsIsInIt) {
    // A new member does not compile until it is named here.
    const auto& [classification, skip, skipOptions, skipBuilder, lattice, jitter, spacing, layers,
                 planes, layersPerPlane, form, tighten, target, space, shaded, normals, order,
                 termination] = Settings{};
    constexpr std::size_t kMembers = 18;
    [[maybe_unused]] const auto& [structure, edge, bits, partitions, minimum, range, level,
                                  traversal, budget] = skipOptions;
    constexpr std::size_t kSkipMembers = 9;
    // Of the options the structure is the setting skip's, and they themselves are no setting.
    EXPECT_EQ(settingsTable().size(), kMembers - 1 + kSkipMembers - 1);
}

TEST(SettingsTable, eachIsReadFromTheMemberThatItNames) {
    Settings s;
    s.classification = Classification::Preintegrated;
    s.skip = SkipStructure::MinMaxOctree;
    s.skipBuilder = SkipBuilder::Gpu;
    s.skipOptions = {.blockEdgeVoxels = 8,
                     .bits = 64,
                     .partitions = 128,
                     .separateMinimum = true,
                     .valueRange = std::array{-1.5, 2.0},
                     .initialLevel = 3,
                     .traversal = Traversal::TopDown,
                     .memoryBudgetBytes = 3 << 19};
    s.lattice = LatticeKind::Shells;
    s.jitter = true;
    s.layerSpacingVoxels = 0.25;
    s.totalLayers = 100;
    s.planes = 5;
    s.layersPerPlane = 20;
    s.form = SegmentForm::Loop;
    s.tighten = false;
    s.target = TargetFormat::Rgba16f;
    s.space = CompositingSpace::Linear;
    s.shaded = true;
    s.normals = Normals::Baked;
    s.order = BlendOrder::FrontToBack;
    s.termination.reset();
    const std::pair<const char*, std::string> expected[] = {
        {"classify", name(s.classification)},
        {"target", name(s.target)},
        {"space", name(s.space)},
        {"shade", "phong"},
        {"normals", "baked"},
        {"layer-spacing", "0.25"},
        {"layers", "100"},
        {"planes", "5"},
        {"layers-per-plane", "20"},
        {"lattice", name(*s.lattice)},
        {"jitter", "on"},
        {"form", "loop"},
        {"order", name(*s.order)},
        {"tighten", "off"},
        {"termination", "off"},
        {"skip", name(*s.skip)},
        {"skip-builder", "gpu"},
        {"skip-block", "8"},
        {"skip-bits", "64"},
        {"partitions", "128"},
        {"separate-minimum", "on"},
        {"value-range", "-1.5,2"},
        {"initial-level", "3"},
        {"traversal", name(s.skipOptions.traversal)},
        {"partition-budget", "1.5"},
    };
    EXPECT_EQ(std::size(expected), settingsTable().size());
    for (const auto& [setting, text] : expected) {
        EXPECT_EQ(get(s, setting), text) << setting;
    }
}

TEST(SettingsTable, skipOffersEveryStructureByItsName) {
    const Setting& skip = *findSetting("skip");
    ASSERT_EQ(skip.words.size(), skipStructures().size());
    for (std::size_t k = 0; k < skip.words.size(); ++k) {
        EXPECT_STREQ(skip.words[k], skipStructures()[k].name);
    }
}

TEST(SettingsTable, whatIsNotTakenIsRefusedAndChangesNothing) {
    for (const Setting& setting : settingsTable()) {
        std::vector<std::string> wrong = {"", "nan", "inf", "1x", "much", "-1e300", "1e300", "1,0"};
        if (setting.kind == SettingKind::Whole) {
            wrong.emplace_back("1.5");
        }
        if (setting.kind == SettingKind::Whole && setting.offered.empty()) {
            wrong.push_back(numberText(setting.low - 1.0));
            wrong.push_back(numberText(setting.high + 1.0));
        }
        if (setting.kind == SettingKind::Real) {
            wrong.push_back(numberText(0.99 * setting.low));
            wrong.push_back(numberText(1.01 * setting.high));
        }
        for (const std::string& text : wrong) {
            SCOPED_TRACE(std::string(setting.name) + " " + text);
            Settings settings;
            const Result<void> done = set(settings, setting.name, text);
            ASSERT_FALSE(done);
            EXPECT_EQ(done.error().code, ErrorCode::InvalidArgument);
            EXPECT_EQ(done.error().detail,
                      std::string(setting.name) + ": '" + text + "' is not " + setting.allowed());
            EXPECT_EQ(get(settings, setting.name), get(Settings{}, setting.name));
        }
    }
    Settings settings;
    EXPECT_EQ(set(settings, "colour", "1").error().code, ErrorCode::InvalidArgument);
    EXPECT_EQ(findSetting("colour"), nullptr);
}

TEST(SettingsTable, defaultsAreThoseOfTheSettingsAndSound) {
    for (const Setting& setting : settingsTable()) {
        Settings settings;
        EXPECT_TRUE(set(settings, setting.name, get(Settings{}, setting.name))) << setting.name;
        EXPECT_EQ(setting.read(settings), setting.read(Settings{})) << setting.name;
    }
    EXPECT_TRUE(check(Settings{}));
    EXPECT_TRUE(check(SkipOptions{}));
}

TEST(SettingsTable, excludedAndUsedSettingsAreThere) {
    for (const Setting& setting : settingsTable()) {
        if (setting.excludes != nullptr) {
            EXPECT_NE(findSetting(setting.excludes), nullptr) << setting.name;
        }
        if (setting.usedBy != nullptr) {
            EXPECT_FALSE(setting.usedBy(SkipStructure::None)) << setting.name;
            EXPECT_STREQ(setting.group, findSetting("skip")->group);
        }
    }
}

TEST(NumberText, isShortAndTheSameNumber) {
    const std::pair<double, const char*> cases[] = {
        {0.1, "0.1"},   {1e6, "1000000"},           {1e-6, "1e-06"},
        {-2.5, "-2.5"}, {0.99609375, "0.99609375"}, {1048576.0, "1048576"},
        {0.0, "0"}};
    for (const auto& [value, text] : cases) {
        EXPECT_EQ(numberText(value), text);
        EXPECT_EQ(numberFrom(text), value);
    }
    EXPECT_EQ(numberFrom(numberText(1.0 / 3.0)), 1.0 / 3.0);
    for (const char* text : {"", " 1", "1 ", "1,5", "0x1p3", "nan", "inf", "1e999", "--1"}) {
        EXPECT_FALSE(numberFrom(text)) << text;
    }
}

std::string ownersOf(const Setting& setting) {
    std::string owners;
    std::size_t count = 0;
    for (const SkipStructureInfo& info : skipStructures()) {
        if (setting.usedBy(info.structure)) {
            owners += (owners.empty() ? "`" : ", `") + std::string(info.name) + "`";
            ++count;
        }
    }
    return count + 1 == skipStructures().size() ? "every structure" : owners;
}

std::string rowOf(const Setting& setting) {
    std::string row = std::string("| `") + setting.name + "` | " + setting.allowed();
    row += setting.unit == nullptr ? "" : std::string("; ") + setting.unit;
    row += " | " + get(Settings{}, setting.name) + " | " + setting.help;
    row +=
        setting.excludes == nullptr ? "" : std::string("; not beside `") + setting.excludes + "`";
    row += setting.usedBy == nullptr ? "" : "; of " + ownersOf(setting);
    return row + " |\n";
}

/// docs/settings.md as it should be.
std::string page() {
    std::string text =
        "# Settings\n\n"
        "What a picture depends on beside volume, transfer function and view. Each is an option "
        "of the command line (`--layers 128`), a member of `slabcast::Settings`, and an entry of "
        "`settings` in `stats.json`, there in snake_case: `layers_per_plane`; `--settings "
        "stats.json` takes them from there. This page is made "
        "from "
        "the table in `core/plan/settings_table.cpp`, and a test holds it to that.\n";
    std::string group;
    for (const Setting& setting : settingsTable()) {
        if (setting.group != group) {
            group = setting.group;
            text += "\n## " + group + "\n\n| setting | takes | default | what it does |\n" +
                    "| --- | --- | --- | --- |\n";
        }
        text += rowOf(setting);
    }
    return text;
}

TEST(SettingsTable, itsPageSaysWhatItSays) {
    const char* path = SLABCAST_SETTINGS_PAGE;
    if (std::getenv("SLABCAST_WRITE_PAGES") != nullptr) {
        std::ofstream(path) << page();
    }
    std::stringstream kept;
    kept << std::ifstream(path).rdbuf();
    EXPECT_EQ(kept.str(), page()) << "to write it anew: SLABCAST_WRITE_PAGES=1 cpu_tests "
                                     "--gtest_filter=SettingsTable.itsPage*";
}

} // namespace
} // namespace slabcast::test
