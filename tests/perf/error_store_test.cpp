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
        {"layer_spacing", 1.0},
        {"layers_per_plane", 8},
        {"classify", "post"},
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
        Result<ErrorStore> opened = open();
        EXPECT_TRUE(opened) << opened.error().detail;
        ErrorStore& store = *opened;
        EXPECT_TRUE(store.setReference({{glm::dvec4(0.25), glm::dvec4(0.5)}, 1.5}));
        for (const char* id : {"a", "b"}) {
            EXPECT_TRUE(store.add(finished(id)));
            folder.files[std::string(id) + ".png"] = folder.files[std::string(id) + "_d.png"] = "";
        }
        notes.clear();
    }

    Result<ErrorStore> open(const Json& key = rowsKey(), const Json& reference = kReferenceKey) {
        const Watcher watcher{.say = [this](const std::string& note) { notes.push_back(note); }};
        return ErrorStore::open(folder, {"error", "a ball", "slabcast error", key}, reference,
                                watcher);
    }

    MemoryFolder folder;
    std::vector<std::string> notes;
};

} // namespace

TEST_F(ErrorStoreTest, GoesOnWhereItWas) {
    const Result<ErrorStore> store = open();
    ASSERT_TRUE(store);
    ASSERT_NE(store->reference(), nullptr);
    EXPECT_EQ(store->reference()->pixels[1], glm::dvec4(0.5));
    EXPECT_EQ(store->reference()->seconds, 1.5);
    ASSERT_NE(store->row("a"), nullptr);
    EXPECT_EQ(*store->row("a"), finished("a"));
    EXPECT_NE(store->row("b"), nullptr);
    EXPECT_EQ(store->row("c"), nullptr);
    ASSERT_EQ(notes.size(), 1U);
    EXPECT_EQ(notes[0], "memory: 2 rows of an earlier run with the same settings are kept");
}

TEST_F(ErrorStoreTest, AReferenceOfAnotherKeyIsNotTaken) {
    const Result<ErrorStore> store =
        open(rowsKey(), {{"commit", "abc"}, {"size", Json::list({2, 2})}});
    ASSERT_TRUE(store);
    EXPECT_EQ(store->reference(), nullptr);
    EXPECT_NE(store->row("a"), nullptr);
}

TEST_F(ErrorStoreTest, NothingOfTheReferenceIsTakenWhereTheRunStartsAnew) {
    folder.replaceable = true;
    const Result<ErrorStore> store = open();
    ASSERT_TRUE(store);
    EXPECT_EQ(store->reference(), nullptr);
    EXPECT_FALSE(folder.has("reference.f64"));
}

TEST_F(ErrorStoreTest, ARowWithoutItsPictureIsMeasuredAgain) {
    folder.files.erase("a_d.png");
    const Result<ErrorStore> store = open();
    ASSERT_TRUE(store);
    EXPECT_EQ(store->row("a"), nullptr);
    EXPECT_NE(store->row("b"), nullptr);
}

TEST_F(ErrorStoreTest, ARowWithoutAnErrorIsDamage) {
    folder.files.at("rows.jsonl") += "{\"id\": \"c\"}\n";
    const Result<ErrorStore> store = open();
    ASSERT_TRUE(store);
    EXPECT_EQ(store->row("a"), nullptr);
    ASSERT_EQ(notes.size(), 1U);
    EXPECT_EQ(notes[0], "memory: rows.jsonl is damaged: starts anew");
}

TEST_F(ErrorStoreTest, AReferenceCutShortIsNotTaken) {
    std::string& reference = folder.files.at("reference.f64");
    reference.pop_back();
    EXPECT_EQ(open()->reference(), nullptr);
}

} // namespace slabcast
