#include "perf/run_store.h"

#include <gtest/gtest.h>

#include "tests/support/memory_folder.h"

namespace slabcast {

namespace {

Json keyOf(const char* commit = "abc", int frames = 5, const char* lattice = "planar") {
    return {{"commit", commit}, {"frames", frames}, {"settings", {{"lattice", lattice}}}};
}

RunIdentity sweepOf(Json key = keyOf(), const char* report = "sweep") {
    return {report, "a ball", "slabcast " + std::string(report) + " ball", std::move(key)};
}

/// A folder with two finished pieces of a sweep.
class RunStoreTest : public testing::Test {
protected:
    RunStoreTest() {
        Result<RunStore> store = open();
        EXPECT_TRUE(store);
        for (const char* id : {"a", "b"}) {
            EXPECT_TRUE(store->add({{"id", id}, {"ms", 1.5}}));
        }
        notes.clear();
    }

    Result<RunStore> open(RunIdentity run = sweepOf(), const RunStore::Sound& isSound = {}) {
        const Watcher watcher{.say = [this](const std::string& note) { notes.push_back(note); }};
        return RunStore::open(folder, std::move(run), watcher, isSound);
    }

    /// That nothing is taken, and that all is as it was; why.
    std::string refusal(RunIdentity run) {
        const std::map<std::string, std::string> before = folder.files;
        const Result<RunStore> store = open(std::move(run));
        EXPECT_EQ(folder.files, before);
        EXPECT_FALSE(store);
        EXPECT_EQ(store ? ErrorCode::Internal : store.error().code, ErrorCode::FileUnwritable);
        return store ? "" : store.error().detail;
    }

    MemoryFolder folder;
    std::vector<std::string> notes;
};

constexpr const char* kRemedy = ": give --out another folder, or --fresh to start anew in this one";

} // namespace

TEST_F(RunStoreTest, GoesOnWhereItWas) {
    Result<RunStore> store = open();
    ASSERT_TRUE(store);
    EXPECT_TRUE(store->goesOn());
    ASSERT_NE(store->find("a"), nullptr);
    EXPECT_EQ(store->find("a")->at("ms").number(), 1.5);
    EXPECT_EQ(store->find("c"), nullptr);
    EXPECT_EQ(notes, std::vector<std::string>{
                         "memory: 2 rows of an earlier run with the same settings are kept"});
    ASSERT_TRUE(store->add({{"id", "c"}, {"ms", 2.0}}));
    EXPECT_NE(open()->find("c"), nullptr);
    EXPECT_NE(open()->find("a"), nullptr);
}

TEST_F(RunStoreTest, AnotherRunIsRefusedAndStaysAsItIs) {
    EXPECT_EQ(refusal(sweepOf(keyOf("abc", 9, "shells"))),
              std::string("memory: holds the beginning of a 'sweep' run of a ball (slabcast sweep "
                          "ball), which differs in frames, lattice") +
                  kRemedy);
    folder.files["sweep.json"] = "{}";
    EXPECT_EQ(refusal(sweepOf(keyOf("def"))),
              std::string("memory: holds a 'sweep' run of a ball (slabcast sweep ball), which "
                          "differs in commit") +
                  kRemedy);
    EXPECT_NE(refusal(sweepOf(keyOf(), "error")).find("which is another report"),
              std::string::npos);
}

TEST_F(RunStoreTest, ABuildOfChangedSourcesGoesOnWithNothing) {
    MemoryFolder other;
    std::swap(folder, other);
    ASSERT_TRUE(open(sweepOf(keyOf("abc-dirty")))->add({{"id", "a"}}));
    EXPECT_NE(refusal(sweepOf(keyOf("abc-dirty"))).find("sources that no commit names"),
              std::string::npos);
}

TEST_F(RunStoreTest, FreshLeavesNothingOfTheOtherRun) {
    folder.files["sweep.json"] = folder.files["report.html"] = folder.files["edit.csv"] = "old";
    folder.files["mine.txt"] = "kept";
    folder.replaceable = true;
    Result<RunStore> store = open(sweepOf(keyOf("def")));
    ASSERT_TRUE(store);
    EXPECT_FALSE(store->goesOn());
    EXPECT_EQ(store->find("a"), nullptr);
    EXPECT_EQ(folder.files, (std::map<std::string, std::string>{{"mine.txt", "kept"}}));
    // Also what it could have gone on with.
    EXPECT_EQ(open()->find("a"), nullptr);
}

TEST_F(RunStoreTest, AFinishedReportWithoutRowsIsToldByItself) {
    folder.files.clear();
    folder.files["edit.json"] =
        R"({"command": "slabcast edit x", "volume": {"name": "head"}, "rows": []})";
    const std::string why = refusal(sweepOf());
    EXPECT_EQ(why, std::string("memory: holds an 'edit' run of head (slabcast edit x), which is "
                               "another report") +
                       kRemedy);
    folder.files.clear();
    folder.files["sweep.json"] = "{";
    EXPECT_EQ(refusal(sweepOf()),
              std::string("memory: holds a 'sweep' run, without a rows.jsonl to go on from") +
                  kRemedy);
}

TEST_F(RunStoreTest, ARunThatCannotGoOnNeedsAnEmptyOrAReplaceableFolder) {
    const RunIdentity edit{"edit", "a ball", "slabcast edit ball"};
    EXPECT_FALSE(claim(folder, edit));
    folder.files.clear();
    EXPECT_TRUE(claim(folder, edit));
    folder.files["edit.json"] = R"({"command": "slabcast edit ball"})";
    const Result<void> again = claim(folder, edit);
    ASSERT_FALSE(again);
    EXPECT_EQ(again.error().detail,
              std::string("memory: holds an 'edit' run (slabcast edit ball), which cannot go on") +
                  kRemedy);
    folder.replaceable = true;
    EXPECT_TRUE(claim(folder, edit));
    EXPECT_TRUE(folder.files.empty());
}

TEST_F(RunStoreTest, ALineCutShortIsLeftOut) {
    std::string& rows = folder.files.at("rows.jsonl");
    rows.resize(rows.size() - 4);
    const Result<RunStore> store = open();
    ASSERT_TRUE(store);
    EXPECT_NE(store->find("a"), nullptr);
    EXPECT_EQ(store->find("b"), nullptr);
}

TEST_F(RunStoreTest, DamagedPiecesStartAnew) {
    std::string& rows = folder.files.at("rows.jsonl");
    for (const char* damage : {"{}\n", "[1]\n", "{\"id\": 7}\n", "{\"id\": \"unsound\"}\n"}) {
        const std::string before = rows;
        rows += damage;
        notes.clear();
        const Result<RunStore> store =
            open(sweepOf(), [](const Json& piece) { return piece.at("ms").isNumber(); });
        ASSERT_TRUE(store);
        EXPECT_EQ(store->find("a"), nullptr) << damage;
        EXPECT_EQ(notes, std::vector<std::string>{"memory: rows.jsonl is damaged: starts anew"});
        rows = before;
    }
}

TEST_F(RunStoreTest, WhoseRowsTheyAreMustBeKnown) {
    for (const char* first : {"", "7\n", "{\n", "{\"key\": {}}\n"}) {
        folder.files = {{"rows.jsonl", std::string(first) + "{\"id\": \"a\"}\n"}};
        notes.clear();
        ASSERT_TRUE(open()) << "rows that nobody can go on with hold nothing";
        EXPECT_EQ(notes.size(), 1U);
        folder.files = {{"rows.jsonl", first}, {"sweep.json", "{}"}};
        EXPECT_NE(refusal(sweepOf()), "");
    }
}

} // namespace slabcast
