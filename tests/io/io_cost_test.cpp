// What reading takes beside the voxels: bytes before a refusal, openings of files, memory.

#include <cstdlib>
#include <fstream>

#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include "platform/io/apart/read_apart.h"
#include "tests/support/io_test_support.h"
#include "tests/support/open_counter.h"

namespace slabcast::test {
namespace {

constexpr std::int64_t kHugeEdge = 2048;
constexpr std::int64_t kHugeBytes = kHugeEdge * kHugeEdge * kHugeEdge; // 8 GiB, nearly all holes

LoadOptions refusing() {
    LoadOptions options;
    options.process = ReadIn::ThisProcess;
    options.admit = [](const Volume& header) -> Result<void> {
        EXPECT_EQ(header.geometry.dims, glm::ivec3(kHugeEdge));
        return fail(ErrorCode::VolumeTooLarge, "too large");
    };
    return options;
}

/// A number that the system counts of this process, of a file of /proc/self.
std::int64_t counted(const char* file, const std::string& name) {
    std::ifstream counts(std::string("/proc/self/") + file);
    for (std::string key; counts >> key;) {
        std::int64_t value = 0;
        if (key == name && counts >> value) {
            return value;
        }
    }
    ADD_FAILURE() << name << " is not counted here";
    return 0;
}

class CostTest : public IoTest {
protected:
    /// A file of `header` and zeros that take no room on the disk.
    std::filesystem::path huge(const std::string& name, const std::string& header) const {
        const auto path = write(name, header);
        std::filesystem::resize_file(path, header.size() + kHugeBytes);
        return path;
    }

    void expectRefusedFromHeader(const std::filesystem::path& path, const LoadOptions& options) {
        const std::int64_t before = counted("io", "rchar:");
        const Result<Volume> refused = loadVolume(path, options);
        EXPECT_LT(counted("io", "rchar:") - before, 1 << 23) << path; // text: up to 4 MiB
        ASSERT_FALSE(refused);
        EXPECT_EQ(refused.error().code, ErrorCode::VolumeTooLarge) << refused.error().detail;
    }

    std::filesystem::path writeImage(const std::string& name, OIIO::TypeDesc type) const {
        const OIIO::ImageSpec spec(kDims.x, kDims.y, 1, type);
        const auto file = OIIO::ImageOutput::create(at(name).string());
        const std::vector<std::uint8_t> pixels(64);
        EXPECT_TRUE(file && file->open(at(name).string(), spec) &&
                    file->write_image(OIIO::TypeDesc::UINT8, pixels.data()) && file->close());
        return at(name);
    }
};

// A 4 GiB file over the budget was once refused after 40 s of reading.
TEST_F(CostTest, WhatIsTooLargeIsRefusedFromItsHeader) {
    expectRefusedFromHeader(huge("a.nrrd", "NRRD0004\ntype: uint8\ndimension: 3\n"
                                           "sizes: 2048 2048 2048\nencoding: raw\n\n"),
                            refusing());
    expectRefusedFromHeader(huge("a.mha", "ObjectType = Image\nNDims = 3\n"
                                          "DimSize = 2048 2048 2048\nElementType = MET_UCHAR\n"
                                          "ElementDataFile = LOCAL\n"),
                            refusing());
    std::string nifti(352, '\0');
    const auto put = [&](std::size_t at, auto value) {
        std::memcpy(nifti.data() + at, &value, sizeof value);
    };
    put(0, std::int32_t{348});
    for (const std::size_t i : {40, 42, 44, 46}) {
        put(i, static_cast<std::int16_t>(i == 40 ? 3 : kHugeEdge));
    }
    put(70, std::int16_t{2}); // uint8
    put(72, std::int16_t{8});
    for (const std::size_t i : {80, 84, 88}) {
        put(i, 1.0F);
    }
    put(108, 352.0F);
    std::memcpy(nifti.data() + 344, "n+1", 3);
    expectRefusedFromHeader(huge("a.nii", nifti), refusing());
    LoadOptions raw = refusing();
    raw.raw = parseRawLayout("2048x2048x2048,uint8,1x1x1").value();
    expectRefusedFromHeader(huge("a.raw", ""), raw);
}

TEST_F(CostTest, FilesOfVoxelsAreOpenedTwiceAtMost) {
    const std::string start = "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 5 4 3\nencoding: ";
    write("a.nrrd", start + "raw\n\n" + codes<std::uint8_t>());
    write("end.nhdr", start + "gzip\nbyte skip: -1\ndata file: end.gz\n");
    writeGz("end.gz", "skipped" + codes<std::uint8_t>());
    write("list.nhdr", start + "raw\ndata file: LIST\ns1.raw\ns2.raw\ns3.raw\n");
    write("list.mhd", "NDims = 3\nDimSize = 5 4 3\nElementType = MET_UCHAR\n"
                      "ElementDataFile = LIST\ns1.raw\ns2.raw\ns3.raw\n");
    for (const char* slice : {"s1.raw", "s2.raw", "s3.raw"}) {
        write(slice, codes<std::uint8_t>({5, 4, 1}));
    }
    for (const auto& [name, files] : {std::pair("a.nrrd", 1U), std::pair("end.nhdr", 2U),
                                      std::pair("list.nhdr", 4U), std::pair("list.mhd", 4U)}) {
        SCOPED_TRACE(name);
        expectOpenedTwiceAtMost(folder_, files,
                                [&, path = at(name)] { ASSERT_LOADED(loadVolume(path)); });
    }
}

TEST_F(CostTest, PicturesAreOpenedTwiceAtMost) {
    for (const char* ending : {"png", "jpg", "tif", "bmp", "tga", "pgm", "exr"}) {
        SCOPED_TRACE(ending);
        const auto endsAs = [&](const char* other) { return std::string(ending) == other; };
        for (int slice = 1; slice <= 3; ++slice) {
            writeImage(fmt::format("s{}.{}", slice, ending),
                       endsAs("exr") ? OIIO::TypeDesc::HALF : OIIO::TypeDesc::UINT8);
        }
        LoadOptions options; // each reader of its own would load the library anew
        options.process = endsAs("png") ? ReadIn::OwnProcess : ReadIn::ThisProcess;
        expectOpenedTwiceAtMost(folder_, 3, [&] {
            const Result<Volume> volume = loadVolume(folder_, options);
            ASSERT_TRUE(volume || endsAs("bmp") || endsAs("tga"))
                << volume.error().detail; // their writers make colours of grey
        });
        for (const auto& file : std::filesystem::directory_iterator(folder_)) {
            std::filesystem::remove(file);
        }
    }
}

// The pages that the reader filled are the program's own: to write to them takes no others.
TEST_F(CostTest, VoxelsThatAreWrittenToAreNotCopied) {
    constexpr std::int64_t kEdge = 256;
    const auto path = write("a.raw", "");
    std::filesystem::resize_file(path, kEdge * kEdge * kEdge);
    LoadOptions options;
    options.raw = parseRawLayout("256x256x256,uint8,1x1x1").value();
    Result<Volume> volume = apart::readApart(path, options);
    ASSERT_LOADED(volume);
    const std::int64_t before = counted("status", "RssAnon:");
    std::fill(volume->voxels.begin(), volume->voxels.end(), std::byte{1});
    EXPECT_LT((counted("status", "RssAnon:") - before) * 1024, kEdge * kEdge * kEdge / 4);
    EXPECT_EQ(volume->valueAt({255, 255, 255}), 1.0);
}

} // namespace
} // namespace slabcast::test
