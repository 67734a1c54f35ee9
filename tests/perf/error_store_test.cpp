#include <gtest/gtest.h>

#include "perf/error/error_store.h"
#include "perf/json.h"
#include "tests/support/memory_folder.h"

namespace slabcast {

namespace {

const Json kReferenceKey = {{"commit", "abc"}, {"size", Json::list({2, 1})}};

Json rowsKey(const char* commit = "abc", int frames = 5) {
    return {{"commit", commit}, {"size", Json::list({2, 1})}, {"frames", frames}};
}

Json finished(const std::string& id) {
    return {
        {"id", id},
        {"date", "today"},
        {"spacing", 1.0},
        {"layers", 8},
        {"classification", "post"},
        {"target", "rgba8"},
        {"termination", "off"},
        {"jitter", false},
        {"error",
         {{"total", {{"rmse", 0.1}}}, {"sampling", nullptr}, {"table", nullptr}, {"gpu", nullptr}}},
        {"frame_ms", {{"median", 3.0}}},
        {"counters", nullptr},
        {"pictures", {{"thumbnail", id + ".png"}, {"difference", id + "_d.png"}}}};
}

/// A folder with two finished rows and a reference.
class ErrorStoreTest : public testing::Test {
protected:
    ErrorStoreTest() {
        ErrorStore store = open();
        EXPECT_TRUE(store.setReference({{glm::dvec4(0.25), glm::dvec4(0.5)}, 1.5}));
        for (const char* id : {"a", "b"}) {
            EXPECT_TRUE(store.add(finished(id)));
            folder.files[std::string(id) + ".png"] = folder.files[std::string(id) + "_d.png"] = "";
        }
        notes.clear();
    }

    ErrorStore open(const Json& key = rowsKey()) {
        return ErrorStore::open(folder, kReferenceKey, key, notes);
    }

    MemoryFolder folder;
    std::vector<std::string> notes;
};

} // namespace

TEST_F(ErrorStoreTest, GoesOnWhereItWas) {
    const ErrorStore store = open();
    ASSERT_NE(store.reference(), nullptr);
    EXPECT_EQ(store.reference()->pixels[1], glm::dvec4(0.5));
    EXPECT_EQ(store.reference()->seconds, 1.5);
    ASSERT_NE(store.row("a"), nullptr);
    EXPECT_EQ(*store.row("a"), finished("a"));
    EXPECT_NE(store.row("b"), nullptr);
    EXPECT_EQ(store.row("c"), nullptr);
    ASSERT_EQ(notes.size(), 1U);
    EXPECT_EQ(notes[0], "memory: 2 rows of an earlier run with the same settings are kept");
}

TEST_F(ErrorStoreTest, RowsOfOtherSettingsAreNotTakenAndWhyIsSaid) {
    const ErrorStore store = open(rowsKey("abc", 9));
    EXPECT_EQ(store.row("a"), nullptr);
    EXPECT_NE(store.reference(), nullptr) << "it does not depend on the frames";
    ASSERT_EQ(notes.size(), 1U);
    EXPECT_EQ(notes[0], "memory: holds rows that differ in frames: starts anew");
}

TEST_F(ErrorStoreTest, NothingIsTakenByABuildOfChangedSources) {
    const ErrorStore store = open(rowsKey("abc-dirty"));
    EXPECT_EQ(store.row("a"), nullptr);
    EXPECT_EQ(store.reference(), nullptr);
    ASSERT_EQ(notes.size(), 1U);
}

TEST_F(ErrorStoreTest, ARowWithoutItsPictureIsMeasuredAgain) {
    folder.files.erase("a_d.png");
    const ErrorStore store = open();
    EXPECT_EQ(store.row("a"), nullptr);
    EXPECT_NE(store.row("b"), nullptr);
}

TEST_F(ErrorStoreTest, ALineCutShortIsLeftOut) {
    std::string& rows = folder.files.at("rows.jsonl");
    rows.resize(rows.size() - 9);
    const ErrorStore store = open();
    EXPECT_NE(store.row("a"), nullptr);
    EXPECT_EQ(store.row("b"), nullptr);
}

TEST_F(ErrorStoreTest, DamagedRowsStartAnew) {
    std::string& rows = folder.files.at("rows.jsonl");
    for (const char* damage : {"{}\n", "[1]\n"}) {
        const std::string before = rows;
        rows += damage;
        notes.clear();
        const ErrorStore store = open();
        EXPECT_EQ(store.row("a"), nullptr);
        ASSERT_EQ(notes.size(), 1U);
        EXPECT_EQ(notes[0], "memory: rows.jsonl is damaged: starts anew");
        rows = before;
    }
}

TEST_F(ErrorStoreTest, AReferenceCutShortIsNotTaken) {
    std::string& reference = folder.files.at("reference.f64");
    reference.pop_back();
    EXPECT_EQ(open().reference(), nullptr);
}

} // namespace slabcast
