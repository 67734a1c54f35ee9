#include "platform/json/transfer_json.h"

#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

namespace slabcast::test {
namespace {

constexpr const char* kValid = R"({"name": "CT bone", "unit": "HU", "opacityUnitMm": 2.0,
    "points": [{"value": 150, "color": [0.75, 0.45, 0.30], "opacity": 0.0},
               {"value": 700, "color": [1.0, 0.95, 0.85], "opacity": 0.5}]})";

/// kValid with one piece replaced.
std::string with(const std::string& piece, const std::string& replacement) {
    std::string text = kValid;
    const std::size_t at = text.find(piece);
    EXPECT_NE(at, std::string::npos) << piece;
    return text.replace(at, piece.size(), replacement);
}

/// 10,000 voxels: 9,980 in the first bin, 5 in the last.
VolumeStatistics skewed() {
    VolumeStatistics statistics;
    statistics.min = -100.0;
    statistics.max = 412.0; // bins 2 wide
    statistics.histogram[0] = 9980;
    statistics.histogram[99] = 15; // reaches 99.9 %; ends at -100 + 100 * 2
    statistics.histogram[255] = 5;
    return statistics;
}

const VolumeStatistics kSkewed = skewed();

Result<TransferFunction> parsed(const std::string& text, std::string_view unit = "") {
    return parseTransferFunction(text, "bone.json", {kSkewed, unit});
}

TEST(TransferJson, everyFieldIsTaken) {
    const Result<TransferFunction> tf = parsed(kValid);
    ASSERT_TRUE(tf) << tf.error().detail;
    EXPECT_EQ(tf->name, "CT bone");
    EXPECT_EQ(tf->unit, "HU");
    EXPECT_EQ(tf->opacityUnitMm, 2.0);
    ASSERT_EQ(tf->points.size(), 2u);
    EXPECT_EQ(tf->points[0].value, 150.0);
    EXPECT_EQ(tf->points[0].opacity, 0.0);
    EXPECT_EQ(tf->points[1].color, glm::dvec3(1.0, 0.95, 0.85));
    EXPECT_EQ(tf->points[1].opacity, 0.5);
}

TEST(TransferJson, unitAndOpacityUnitMayBeLeftOut) {
    const Result<TransferFunction> tf = parsed(with(R"("unit": "HU", "opacityUnitMm": 2.0,)", ""));
    ASSERT_TRUE(tf) << tf.error().detail;
    EXPECT_EQ(tf->unit, "");
    EXPECT_EQ(tf->opacityUnitMm, 1.0);
}

TEST(TransferJson, everyErrorNamesItsPath) {
    const std::vector<std::pair<std::string, std::string>> cases = {
        {with("0.95", "1.4"), "points[1].color[1]: 1.4 is outside 0..1"},
        {with("0.45", "-0.1"), "points[0].color[1]: -0.1 is outside 0..1"},
        {with("0.45", "\"red\""), "points[0].color[1]: is string, expected a number"},
        {with("[0.75, 0.45, 0.30]", "[0.75, 0.45]"), "points[0].color: expected three numbers"},
        {with("\"color\": [0.75, 0.45, 0.30], ", ""), "points[0].color: is missing"},
        {with("\"opacity\": 0.5", "\"opacity\": 1.5"), "points[1].opacity: 1.5 is outside 0..1"},
        {with("\"opacity\": 0.5", "\"opacity\": null"),
         "points[1].opacity: is null, expected a number"},
        {with(", \"opacity\": 0.5", ""), "points[1].opacity: is missing"},
        {with("\"value\": 700, ", ""), "points[1].value: is missing"},
        {with("\"value\": 700", "\"value\": 100"), "points[1]"}, // out of order
        {with("\"opacity\": 0.5", "\"opacity\": 0.5, \"opaque\": 1"),
         "points[1].opaque: unknown key"},
        {with("\"name\"", "\"nmae\""), "nmae: unknown key"},
        {with("\"name\"", "\"na\\nme\""), "na?me: unknown key"}, // one line
        {with("\"CT bone\"", "7"), "name: is number, expected a text"},
        {with("2.0", "0"), "opacityUnitMm: 0 is outside"},
        {with("2.0", "\"mm\""), "opacityUnitMm: is string"},
        {with("HU", "Hu"), "unit: 'Hu' is not known; known are HU, and range"},
        {with("\"HU\"", "7"), "unit: is number, expected a text"},
        {with("\"HU\"", "\"HU\", \"rangeShare\": 0.9"), "rangeShare: is of the unit \"range\""},
        {with("\"HU\"", "\"range\", \"rangeShare\": 1.5"), "rangeShare: 1.5 is outside 0.5..1"},
        {R"({"name": "a"})", "points: expected a list"},
        {R"({"name": "a", "points": []})", "points: expected a list"},
        {R"({"name": "a", "points": [3]})", "points[0]: is number, expected an object"},
        {"[1, 2]", "is array, expected an object"},
        {with("}]}", ""), "line"},
        {with("700", "1e999"), "bone.json"},
        {"", "bone.json"},
    };
    for (const auto& [text, part] : cases) {
        SCOPED_TRACE(text);
        const Result<TransferFunction> tf = parsed(text);
        ASSERT_FALSE(tf);
        EXPECT_EQ(tf.error().code, ErrorCode::InvalidTransferFunction);
        EXPECT_TRUE(tf.error().detail.starts_with("bone.json: ")) << tf.error().detail;
        EXPECT_NE(tf.error().detail.find(part), std::string::npos) << tf.error().detail;
        EXPECT_EQ(tf.error().detail.find('\n'), std::string::npos) << tf.error().detail;
    }
}

TEST(TransferJson, unitsThatAreKnown) {
    for (const char* unit : {"HU", ""}) {
        const Result<TransferFunction> tf = parsed(with("HU", unit), "K");
        ASSERT_TRUE(tf) << tf.error().detail;
        EXPECT_EQ(tf->unit, unit);
    }
    ASSERT_TRUE(parsed(with("HU", "K"), "K"));
    EXPECT_EQ(parsed(with("HU", "K"), "K")->unit, "K");
    const Result<TransferFunction> unknown = parsed(with("HU", "Pa"), "K");
    ASSERT_FALSE(unknown);
    EXPECT_NE(unknown.error().detail.find("known are HU, K, and range"), std::string::npos)
        << unknown.error().detail;
}

/// kValid with values from 0 to 1.
std::string relative(const std::string& entries) {
    std::string text = with("\"HU\"", entries);
    text.replace(text.find("150"), 3, "0.25");
    return text.replace(text.find("700"), 3, "1");
}

TEST(TransferJson, valuesRelativeToTheDataAreLaidOverThem) {
    const Result<TransferFunction> all = parsed(relative("\"range\""));
    ASSERT_TRUE(all) << all.error().detail;
    EXPECT_EQ(all->unit, "");
    EXPECT_DOUBLE_EQ(all->points[0].value, -100.0 + 0.25 * 512.0);
    EXPECT_DOUBLE_EQ(all->points[1].value, 412.0);
    const Result<TransferFunction> most = parsed(relative("\"range\", \"rangeShare\": 0.999"));
    ASSERT_TRUE(most) << most.error().detail;
    EXPECT_DOUBLE_EQ(most->points[0].value, -100.0 + 0.25 * 200.0);
    EXPECT_DOUBLE_EQ(most->points[1].value, 100.0);
}

TEST(TransferJson, filesAreRead) {
    const auto path = std::filesystem::temp_directory_path() / "slabcast_transfer_json_test.json";
    std::ofstream(path) << kValid;
    EXPECT_TRUE(loadTransferFunction(path, {kSkewed, ""}));
    std::ofstream(path) << "{";
    EXPECT_EQ(loadTransferFunction(path, {kSkewed, ""}).error().code,
              ErrorCode::InvalidTransferFunction);
    std::filesystem::remove(path);
    EXPECT_EQ(loadTransferFunction(path, {kSkewed, ""}).error().code, ErrorCode::FileNotFound);
    EXPECT_EQ(loadTransferFunction(path.parent_path(), {kSkewed, ""}).error().code,
              ErrorCode::FileUnreadable);
}

TEST(TransferJson, relativeValuesAreLaidOverTheBulkAndFillsAreHidden) {
    VolumeStatistics statistics = kSkewed;
    statistics.bulk = BulkOfValues{.range = {0.0, 64.0}, .voxelsAbove = 5};
    const char* text = R"({"unit": "range", "points": [
        {"value": 0, "color": [1, 1, 1], "opacity": 0.1},
        {"value": 1, "color": [1, 1, 1], "opacity": 0.5}]})";
    const auto parsed = [&] { return *parseTransferFunction(text, "t.json", {statistics, ""}); };
    EXPECT_EQ(parsed().points.size(), 2U);
    EXPECT_EQ(parsed().points.front().value, 0.0);
    EXPECT_EQ(parsed().points.back().value, 64.0);
    EXPECT_EQ(evaluate(parsed(), 412.0).opacity, 0.5) << "a few bright voxels are no fill value";
    statistics.bulk->fillAbove = true;
    EXPECT_EQ(evaluate(parsed(), 412.0).opacity, 0.0);
    EXPECT_EQ(evaluate(parsed(), 64.0).opacity, 0.5);
    EXPECT_EQ(evaluate(parsed(), -100.0).opacity, 0.1);
    statistics.bulk->fillBelow = true;
    EXPECT_EQ(evaluate(parsed(), -100.0).opacity, 0.0);
    EXPECT_EQ(evaluate(parsed(), 0.0).opacity, 0.1);
    EXPECT_LE(presetTransferFunction("mr", statistics)->points.back().value, 66.0);
}

TEST(Presets, allAreValidAndShowSomething) {
    ASSERT_EQ(presetNames(), (std::vector<std::string>{"angio", "ct-bone", "ct-bone-skin",
                                                       "ct-lung", "gap", "linear", "mr"}));
    for (const std::string& name : presetNames()) {
        const Result<TransferFunction> tf = presetTransferFunction(name, kSkewed);
        ASSERT_TRUE(tf) << tf.error().detail;
        EXPECT_EQ(tf->unit, name.starts_with("ct-") ? "HU" : "") << name;
        EXPECT_EQ(tf->points.front().opacity, 0.0) << name;
        EXPECT_GT(tf->points.back().opacity, 0.0) << name;
    }
}

TEST(Presets, relativeOnesAreLaidOverTheData) {
    const TransferFunction linear = *presetTransferFunction("linear", kSkewed);
    EXPECT_DOUBLE_EQ(linear.points.front().value, -100.0);
    EXPECT_DOUBLE_EQ(linear.points.back().value, 412.0);
    EXPECT_DOUBLE_EQ(presetTransferFunction("angio", kSkewed)->points.back().value, 412.0);
    EXPECT_DOUBLE_EQ(presetTransferFunction("mr", kSkewed)->points.back().value, 100.0);
    EXPECT_DOUBLE_EQ(presetTransferFunction("ct-bone", kSkewed)->points.front().value, 240.0);
}

/// The very same numbers, so the very same picture.
TEST(Presets, theirFilesSayTheSame) {
    const std::filesystem::path folder = SLABCAST_PRESET_FOLDER;
    for (const std::string& name : presetNames()) {
        const TransferFunction preset = *presetTransferFunction(name, kSkewed);
        const Result<TransferFunction> file =
            loadTransferFunction(folder / (name + ".json"), {kSkewed, ""});
        ASSERT_TRUE(file) << file.error().detail;
        ASSERT_EQ(file->points.size(), preset.points.size());
        for (std::size_t k = 0; k < preset.points.size(); ++k) {
            EXPECT_EQ(file->points[k].value, preset.points[k].value) << name;
            EXPECT_EQ(file->points[k].color, preset.points[k].color) << name;
            EXPECT_EQ(file->points[k].opacity, preset.points[k].opacity) << name;
        }
    }
}

TEST(Presets, constantDataKeepThePointsInOrder) {
    VolumeStatistics flat;
    flat.min = flat.max = 7.0;
    flat.histogram[0] = 10;
    for (const std::string& name : presetNames()) {
        EXPECT_TRUE(presetTransferFunction(name, flat)) << name;
    }
    const TransferFunction mr = *presetTransferFunction("mr", flat);
    EXPECT_LT(mr.points.front().value, mr.points.back().value);
}

TEST(Presets, unknownNameListsTheKnown) {
    const Result<TransferFunction> tf = presetTransferFunction("bones", kSkewed);
    ASSERT_FALSE(tf);
    EXPECT_EQ(tf.error().code, ErrorCode::InvalidArgument);
    EXPECT_NE(tf.error().detail.find("ct-bone"), std::string::npos);
}

TEST(Presets, defaultShowsSomethingOfTheData) {
    VolumeStatistics head;
    head.min = -1024;
    head.max = 3033;
    EXPECT_EQ(defaultPresetName(Modality::Ct, head), "ct-bone");
    EXPECT_EQ(defaultPresetName(Modality::Mr, head), "mr");
    EXPECT_EQ(defaultPresetName(Modality::Unknown, head), "linear");
    head.max = 200;
    EXPECT_EQ(defaultPresetName(Modality::Ct, head), "ct-lung");
    head.min = -100;
    EXPECT_EQ(defaultPresetName(Modality::Ct, head), "linear");
}

} // namespace
} // namespace slabcast::test
