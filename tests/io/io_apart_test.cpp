#include "platform/io/apart/read_apart.h"

#include <chrono>
#include <cstdlib>
#include <fstream>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include "platform/io/apart/confine.h"
#include "platform/io/apart/wire.h"
#include "tests/support/io_test_support.h"

// What a file does to the program that reads it ends that program and nothing else.

namespace slabcast::test {
namespace {

class ApartTest : public IoTest {
protected:
    void TearDown() override {
        unsetenv("SLABCAST_READER");
        IoTest::TearDown();
    }

    /// A program in the reader's place.
    void readWith(const std::string& script) {
        const auto program = write("reader", "#!/bin/sh\n" + script + "\n");
        std::filesystem::permissions(program, std::filesystem::perms::owner_all);
        setenv("SLABCAST_READER", program.c_str(), 1);
    }

    std::filesystem::path volume() {
        return write("a.nrrd",
                     "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 2 2 2\nspacings: 1 2 3\n"
                     "encoding: raw\n\nabcdefgh");
    }
};

LoadOptions here() {
    LoadOptions options;
    options.process = ReadIn::ThisProcess;
    return options;
}

TEST_F(ApartTest, GivesWhatReadingHereGives) {
    const auto path = volume();
    const Result<Volume> apart = apart::readApart(path, {});
    const Result<Volume> read = loadVolume(path, here());
    ASSERT_LOADED(apart);
    ASSERT_LOADED(read);
    EXPECT_EQ(apart->name, read->name);
    EXPECT_EQ(apart->type, read->type);
    EXPECT_EQ(apart->geometry.dims, read->geometry.dims);
    EXPECT_EQ(apart->geometry.spacingMm, read->geometry.spacingMm);
    EXPECT_EQ(apart->geometry.direction, read->geometry.direction);
    EXPECT_EQ(apart->notes, read->notes);
    EXPECT_EQ(apart->voxels, read->voxels);
}

TEST_F(ApartTest, FailsAsReadingHereFails) {
    const auto path = write("short.nrrd", "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 9 9 9\n"
                                          "encoding: raw\n\nabcdefgh");
    const Result<Volume> apart = apart::readApart(path, {});
    const Result<Volume> read = loadVolume(path, here());
    ASSERT_FALSE(apart);
    ASSERT_FALSE(read);
    EXPECT_EQ(apart.error().code, read.error().code);
    EXPECT_EQ(apart.error().detail, read.error().detail);
}

TEST_F(ApartTest, VoxelsMayBeWrittenTo) {
    Result<Volume> apart = apart::readApart(volume(), {});
    ASSERT_LOADED(apart);
    apart->voxels[0] = std::byte{7};
    EXPECT_EQ(apart->valueAt({0, 0, 0}), 7.0);
    EXPECT_EQ(apart->valueAt({1, 0, 0}), 'b');
}

TEST_F(ApartTest, AReaderThatBreaksIsAnErrorThatNamesTheFile) {
    const auto path = volume();
    readWith("kill -ABRT $$");
    expectFailure(apart::readApart(path, {}), ErrorCode::FileUnreadable, path.string(), "Aborted");
    readWith("kill -SEGV $$");
    expectFailure(apart::readApart(path, {}), ErrorCode::FileUnreadable, path.string(),
                  "Segmentation fault");
    readWith("exit 0");
    expectFailure(apart::readApart(path, {}), ErrorCode::FileUnreadable, path.string(),
                  "without an answer");
    readWith("printf '\\003abc' >&3"); // says that it is done, and nothing else
    expectFailure(apart::readApart(path, {}), ErrorCode::FileUnreadable, path.string(),
                  "without an answer");
}

TEST_F(ApartTest, AReaderThatGetsNoFurtherIsStopped) {
    readWith("while :; do :; done");
    LoadOptions options;
    options.limits.stuckSeconds = 0.2;
    expectFailure(apart::readApart(volume(), options), ErrorCode::FileUnreadable, "a.nrrd",
                  "no further in 0.2 s");
}

TEST_F(ApartTest, MoreThanMayBeTakenIsToldAsThat) {
    const auto path = write("a.raw", "");
    std::filesystem::resize_file(path, 128 << 20);
    LoadOptions options;
    options.raw = parseRawLayout("512x512x512,uint8,1x1x1").value();
    options.limits.memoryBytes = 64 << 20;
    expectFailure(apart::readApart(path, options), ErrorCode::FileUnreadable, "a.raw",
                  "not enough memory");
}

TEST_F(ApartTest, CanBeCancelled) {
    readWith("sleep 600");
    const std::atomic<bool> cancel = true;
    LoadOptions options;
    options.cancel = &cancel;
    const Result<Volume> cancelled = apart::readApart(volume(), options);
    ASSERT_FALSE(cancelled);
    EXPECT_EQ(cancelled.error().code, ErrorCode::Cancelled);
}

TEST_F(ApartTest, WhatIsNotWantedIsNotRead) {
    LoadOptions options;
    options.admit = [](const Volume& header) -> Result<void> {
        EXPECT_EQ(header.geometry.dims, glm::ivec3(2));
        EXPECT_EQ(header.type, VoxelType::U8);
        return fail(ErrorCode::VolumeTooLarge, "too large");
    };
    for (const ReadIn process : {ReadIn::OwnProcess, ReadIn::ThisProcess}) {
        options.process = process;
        const Result<Volume> refused = process == ReadIn::OwnProcess
                                           ? apart::readApart(volume(), options)
                                           : loadVolume(volume(), options);
        ASSERT_FALSE(refused);
        EXPECT_EQ(refused.error().code, ErrorCode::VolumeTooLarge);
    }
}

TEST_F(ApartTest, AReaderThatIsNotThereIsNamed) {
    setenv("SLABCAST_READER", "/nowhere/slabcast-read", 1);
    expectFailure(apart::readApart(volume(), {}), ErrorCode::FileUnreadable, "a.nrrd",
                  "/nowhere/slabcast-read");
}

TEST_F(ApartTest, RequestsArriveAsTheyWereSent) {
    LoadOptions options;
    options.series = "1.2.3";
    options.select = {{"EchoTime", "20"}, {"ImageType", ""}};
    options.time = 3;
    options.resampleUneven = true;
    options.raw = RawLayout{{5, 4, 3}, VoxelType::F64, {1, 2, 3}, true};
    options.rawSkipBytes = 512;
    options.spacingMm = glm::dvec3(0.5, 1, 2);
    options.unit = "HU";
    options.limits.memoryBytes = 1 << 30;
    const std::string packet = apart::encodeRequest("/a folder/ü", options);
    ASSERT_EQ(apart::kindOf(packet), apart::Packet::Request);
    const auto request = apart::decodeRequest(packet);
    ASSERT_TRUE(request);
    EXPECT_EQ(request->path, "/a folder/ü");
    EXPECT_EQ(request->options.series, options.series);
    ASSERT_EQ(request->options.select.size(), 2U);
    EXPECT_EQ(request->options.select[0].value, "20");
    EXPECT_EQ(request->options.time, 3);
    EXPECT_TRUE(request->options.resampleUneven);
    ASSERT_TRUE(request->options.raw);
    EXPECT_EQ(textOf(*request->options.raw), textOf(*options.raw));
    EXPECT_EQ(request->options.rawSkipBytes, 512);
    EXPECT_EQ(request->options.spacingMm, options.spacingMm);
    EXPECT_EQ(request->options.unit, "HU");
    EXPECT_EQ(request->options.limits.memoryBytes, 1 << 30);
    std::string ofAnotherBuild = packet;
    ofAnotherBuild[1] ^= 1;
    EXPECT_FALSE(apart::decodeRequest(ofAnotherBuild));
}

TEST_F(ApartTest, PacketsThatEndEarlyOrLateAreNone) {
    Volume volume;
    volume.notes = {"one", "two"};
    const std::string packet = apart::encodeVolume(apart::Packet::Done, volume);
    EXPECT_TRUE(apart::decodeVolume(packet));
    for (std::size_t size = 1; size < packet.size(); ++size) {
        EXPECT_FALSE(apart::decodeVolume(packet.substr(0, size))) << size;
    }
    EXPECT_FALSE(apart::decodeVolume(packet + "x"));
    EXPECT_FALSE(apart::kindOf(""));
    EXPECT_FALSE(apart::kindOf("\x7f"));
}

/// The exit status of a child that is confined, and then does this.
int confinedExit(int (*act)()) {
    const pid_t pid = fork();
    if (pid == 0) {
        LoadLimits limits;
        limits.memoryBytes = std::int64_t{1} << 50; // sanitizers reserve much of the address space
        apart::confine(limits);
        _exit(act());
    }
    int status = 0;
    waitpid(pid, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

TEST(Confine, LeavesReading) {
    EXPECT_EQ(confinedExit([] { return open("/dev/null", O_RDONLY) >= 0 ? 0 : errno; }), 0);
}

#ifdef SLABCAST_HAS_SECCOMP
TEST(Confine, TakesWritingTheNetworkAndOtherPrograms) {
    EXPECT_EQ(confinedExit([] { return open("/dev/null", O_WRONLY) >= 0 ? 0 : errno; }), EACCES);
    EXPECT_EQ(confinedExit([] { return open("/tmp/new", O_CREAT, 0600) >= 0 ? 0 : errno; }),
              EACCES);
    EXPECT_EQ(confinedExit([] { return unlink("/tmp/none") == 0 ? 0 : errno; }), EACCES);
    EXPECT_EQ(confinedExit([] { return socket(AF_INET, SOCK_STREAM, 0) >= 0 ? 0 : errno; }),
              EACCES);
    EXPECT_EQ(confinedExit([] { return execl("/bin/true", "true", nullptr) == 0 ? 0 : errno; }),
              EACCES);
    EXPECT_EQ(confinedExit([] { return fork() >= 0 ? 0 : errno; }), EACCES);
}
#endif

} // namespace
} // namespace slabcast::test
