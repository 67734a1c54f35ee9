#include "perf/json.h"

#include <limits>
#include <utility>

#include <gtest/gtest.h>

namespace slabcast::test {
namespace {

constexpr std::int64_t kLeast = std::numeric_limits<std::int64_t>::min();
constexpr std::uint64_t kMost = std::numeric_limits<std::uint64_t>::max();

std::string nested(int levels) {
    const auto times = static_cast<std::size_t>(levels);
    return std::string(times, '[') + std::string(times, ']');
}

TEST(Json, everyKindIsWrittenAsNlohmannJsonWritesIt) {
    const std::pair<Json, const char*> expected[] = {
        {Json(), "null"},
        {nullptr, "null"},
        {true, "true"},
        {false, "false"},
        {0, "0"},
        {-1, "-1"},
        {kLeast, "-9223372036854775808"},
        {kMost, "18446744073709551615"},
        {7U, "7"},
        {1.0, "1.0"},
        {-0.0, "-0.0"},
        {0.1, "0.1"},
        {0.1F, "0.10000000149011612"},
        {1.0 / 3.0, "0.3333333333333333"},
        {123456789012345678.0, "1.2345678901234568e+17"},
        {1e300, "1e+300"},
        {5e-324, "5e-324"},
        {std::numeric_limits<double>::quiet_NaN(), "null"},
        {-std::numeric_limits<double>::infinity(), "null"},
        {"", "\"\""},
        {"\u00e9\n\"\\/\t\x01", "\"\u00e9\\n\\\"\\\\/\\t\\u0001\""},
        {std::string("a\0b", 3), "\"a\\u0000b\""},
        {"\xff!", "\"\ufffd!\""},
        {Json::list(), "[]"},
        {Json::object(), "{}"},
        {Json::list({1, "two", Json::list({3.0}), nullptr}), "[1,\"two\",[3.0],null]"},
        {{{"b", 1}, {"a", {{"c", "d"}}}, {"B", true}}, "{\"B\":true,\"a\":{\"c\":\"d\"},\"b\":1}"}};
    for (const auto& [value, text] : expected) {
        EXPECT_EQ(value.dump(), text);
    }
}

TEST(Json, isIndentedAsNlohmannJsonIndentsIt) {
    const Json value{{"list", Json::list({1, Json::object()})}, {"empty", Json::list()}};
    EXPECT_EQ(value.dump(2), "{\n  \"empty\": [],\n  \"list\": [\n    1,\n    {}\n  ]\n}");
    EXPECT_EQ(value.dump(0), "{\n\"empty\": [],\n\"list\": [\n1,\n{}\n]\n}");
}

TEST(Json, isReadAsItWasWritten) {
    const Json value{{"null", nullptr},
                     {"flags", Json::list({true, false})},
                     {"whole", Json::list({-1, 0, kLeast, kMost})},
                     {"real", Json::list({0.1, 1.0, 1e300, -5e-324})},
                     {"text", "\u00e9\n\""},
                     {"deep", {{"list", Json::list({Json::list(), Json::object()})}}}};
    for (const int indent : {-1, 1}) {
        const std::optional<Json> read = Json::parse(value.dump(indent));
        ASSERT_TRUE(read);
        EXPECT_EQ(*read, value) << read->dump();
        EXPECT_EQ(read->dump(), value.dump());
        EXPECT_EQ(read->names(), value.names());
    }
    EXPECT_TRUE(Json::parse(" 1 ")->isWhole());
    EXPECT_FALSE(Json::parse("1.0")->isWhole());
    EXPECT_EQ(Json::parse("{\"a\": 1, \"a\": 2}")->at("a"), 2);
}

TEST(Json, whatIsNoJsonIsNotRead) {
    for (const char* text : {"", " ", "[1", "[1,]", "{\"a\"}", "{1: 2}", "nul", "1 2", "NaN", "'a'",
                             "\"\xff\"", "{\"a\": 1} x"}) {
        EXPECT_FALSE(Json::parse(text)) << text;
    }
    EXPECT_TRUE(Json::parse("null"));
    EXPECT_TRUE(Json::parse(nested(100)));
    EXPECT_FALSE(Json::parse(nested(101)));
    EXPECT_FALSE(Json::parse(nested(10000)));
}

TEST(Json, numbersCompareByWhatTheyAre) {
    EXPECT_EQ(Json(1), Json(1.0));
    EXPECT_EQ(Json(1), Json(1U));
    EXPECT_EQ(Json(-2.0), Json(-2));
    EXPECT_NE(Json(1), Json(1.5));
    EXPECT_NE(Json(1), Json(true));
    EXPECT_NE(Json(0), Json());
    EXPECT_NE(Json(0), Json(false));
    EXPECT_NE(Json("1"), Json(1));
    EXPECT_NE(Json::list(), Json::object());
    EXPECT_EQ(Json::list({1, 2.0}), Json::list({1.0, 2}));
    EXPECT_NE(Json::list({1}), Json::list({1, 1}));
    EXPECT_EQ((Json{{"a", 1}, {"b", 2}}), (Json{{"b", 2}, {"a", 1}}));
    EXPECT_NE((Json{{"a", 1}}), (Json{{"b", 1}}));
}

TEST(Json, whatIsOfAnotherKindOrMissingIsNothing) {
    EXPECT_EQ(Json(kMost).number(), 18446744073709551616.0);
    EXPECT_EQ(Json(-3).number(), -3.0);
    EXPECT_EQ(Json(-3).whole(), -3);
    EXPECT_EQ(Json(2.5).whole(), 0);
    EXPECT_EQ(Json("5").number(), 0.0);
    EXPECT_EQ(Json(true).whole(), 0);
    EXPECT_TRUE(Json(true).flag());
    EXPECT_FALSE(Json(1).flag());
    EXPECT_EQ(Json(1).text(), "");
    const Json value{{"a", Json::list({1})}};
    EXPECT_TRUE(value.at("b").at("c").at(0).isNull());
    EXPECT_TRUE(value.at("a").at(1).isNull());
    EXPECT_TRUE(value.at("a").at("a").isNull());
    EXPECT_FALSE(value.contains("b"));
    EXPECT_EQ(Json(1).size(), 0U);
}

TEST(Json, membersAreMadeSetAndTakenAway) {
    Json value;
    value["b"]["c"] = 1;
    value["a"].push_back(2);
    value["a"].push_back({{"x", "y"}});
    EXPECT_EQ(value.dump(), "{\"a\":[2,{\"x\":\"y\"}],\"b\":{\"c\":1}}");
    value["a"][0] = "two";
    value.update({{"b", 3}, {"aa", nullptr}});
    EXPECT_EQ(value.dump(), "{\"a\":[\"two\",{\"x\":\"y\"}],\"aa\":null,\"b\":3}");
    value.erase("a");
    value.erase("none");
    EXPECT_EQ(value.names(), (std::vector<std::string>{"aa", "b"}));
    value = {{"only", 1}};
    EXPECT_EQ(value.dump(), "{\"only\":1}");
    const Json copy = value;
    value["only"] = 2;
    EXPECT_EQ(copy.at("only"), 1);
    for (Json& member : value) {
        member = Json::listOf(std::vector<bool>{true, false});
    }
    EXPECT_EQ(value.dump(), "{\"only\":[true,false]}");
}

TEST(Json, pointersLeadToWhatIsThere) {
    const Json value{{"rows", Json::list({{{"id", "a"}}, {{"id", nullptr}}})}, {"", 7}};
    EXPECT_EQ(value.atPointer(""), &value);
    EXPECT_EQ(value.atPointer("/rows/0/id"), &value.at("rows").at(0).at("id"));
    ASSERT_NE(value.atPointer("/rows/1/id"), nullptr) << "null, and there";
    EXPECT_TRUE(value.atPointer("/rows/1/id")->isNull());
    ASSERT_NE(value.atPointer("/"), nullptr);
    EXPECT_EQ(*value.atPointer("/"), 7);
    for (const char* pointer :
         {"rows", "/row", "/rows/", "/rows/2", "/rows/-", "/rows/x", "/rows/-1",
          "/rows/18446744073709551616", "/rows/id", "/rows/0/id/0", "//"}) {
        EXPECT_EQ(value.atPointer(pointer), nullptr) << pointer;
    }
}

} // namespace
} // namespace slabcast::test
