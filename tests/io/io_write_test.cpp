#include "tests/support/io_test_support.h"

#include <OpenImageIO/imageio.h>

#include "platform/io/atomic_file.h"
#include "platform/io/save_image.h"
#include "platform/io/unfinished.h"

namespace slabcast::test {
namespace {

class WriteTest : public IoTest {
protected:
    std::string read(const std::filesystem::path& path) const {
        std::ifstream file(path, std::ios::binary);
        return {std::istreambuf_iterator<char>(file), {}};
    }
    std::ptrdiff_t fileCount() const {
        return std::distance(std::filesystem::directory_iterator(folder_), {});
    }
};

TEST_F(WriteTest, contentReplacesTheFileAndNothingStaysBehind) {
    const auto path = write("a.txt", "old and much longer");
    ASSERT_TRUE(writeFileAtomically(path, "new"));
    EXPECT_EQ(read(path), "new");
    EXPECT_EQ(fileCount(), 1);
}

TEST_F(WriteTest, failedWriterLeavesTheOldFile) {
    const auto path = write("a.txt", "old");
    const Result<void> written =
        writeFileAtomically(path, [](const std::filesystem::path& temporary) -> Result<void> {
            EXPECT_EQ(temporary.extension(), ".txt");
            std::ofstream(temporary) << "half";
            return fail(ErrorCode::Internal, "stopped");
        });
    ASSERT_FALSE(written);
    EXPECT_EQ(written.error().code, ErrorCode::Internal);
    EXPECT_EQ(read(path), "old");
    EXPECT_EQ(fileCount(), 1);
}

TEST_F(WriteTest, whatIsUnfinishedGoesWhereTheProgramIsInterrupted) {
    const auto kept = write("kept.txt", "old");
    const Result<void> written =
        writeFileAtomically(kept, [&](const std::filesystem::path& temporary) -> Result<void> {
            std::ofstream(temporary) << "half";
            std::filesystem::create_directories(at("made/inner"));
            std::filesystem::create_directories(at("full"));
            write("full/result", "whole");
            const Unfinished made(at("made"));
            const Unfinished inner(at("made/inner"));
            const Unfinished full(at("full"));
            Unfinished::removeAll();
            EXPECT_FALSE(std::filesystem::exists(temporary));
            return fail(ErrorCode::Internal, "stopped");
        });
    EXPECT_FALSE(written);
    EXPECT_EQ(read(kept), "old");
    EXPECT_FALSE(std::filesystem::exists(at("made")));
    EXPECT_EQ(read(at("full/result")), "whole");
    Unfinished::removeAll(); // nothing is any more
    EXPECT_EQ(fileCount(), 2);
}

void expectUnwritable(const Result<void>& written, const std::filesystem::path& path) {
    ASSERT_FALSE(written);
    EXPECT_EQ(written.error().code, ErrorCode::FileUnwritable);
    EXPECT_NE(written.error().detail.find(path.string()), std::string::npos)
        << written.error().detail;
}

TEST_F(WriteTest, placesThatTakeNoFileAreNamed) {
    expectUnwritable(writeFileAtomically(at("no/such/a.txt"), "x"), at("no/such/a.txt"));
    expectUnwritable(writeFileAtomically(folder_, "x"), folder_);
    expectUnwritable(writeFileAtomically("/dev/null", "x"), "/dev/null");
    const std::vector<std::uint8_t> pixels(4);
    expectUnwritable(savePng(at("no/a.png"), 1, 1, pixels.data()), at("no/a.png"));
}

template <class T>
std::vector<T> readBack(const std::filesystem::path& path, int width, int height, int channels,
                        OIIO::TypeDesc type) {
    OIIO::ImageSpec config;
    config.attribute("oiio:UnassociatedAlpha", 1);
    const auto file = OIIO::ImageInput::open(path.string(), &config);
    EXPECT_TRUE(file);
    EXPECT_EQ(file->spec().width, width);
    EXPECT_EQ(file->spec().height, height);
    EXPECT_EQ(file->spec().nchannels, channels);
    EXPECT_EQ(file->spec().format, type);
    std::vector<T> pixels(static_cast<std::size_t>(width * height * channels));
    file->read_image(0, 0, 0, channels, type, pixels.data());
    return pixels;
}

TEST_F(WriteTest, pngKeepsEveryByteFromTheTopRowOn) {
    std::vector<std::uint8_t> pixels;
    for (int i = 0; i < 3 * 2 * 4; ++i) {
        pixels.push_back(static_cast<std::uint8_t>(i * 10));
    }
    ASSERT_TRUE(savePng(at("a.png"), 3, 2, pixels.data()));
    EXPECT_EQ(readBack<std::uint8_t>(at("a.png"), 3, 2, 4, OIIO::TypeDesc::UINT8), pixels);
    ASSERT_TRUE(savePng(at("b.png"), 4, 2, pixels.data(), PngChannels::Rgb));
    EXPECT_EQ(readBack<std::uint8_t>(at("b.png"), 4, 2, 3, OIIO::TypeDesc::UINT8), pixels);
    EXPECT_EQ(fileCount(), 2);
}

TEST_F(WriteTest, exrKeepsEveryBit) {
    const std::vector<float> pixels = {0.1F, -2.0F, 1e6F, 0.5F, 1e-7F, 3.0F, 0.25F, 0.0F};
    ASSERT_TRUE(saveExr(at("a.exr"), 1, 2, pixels.data()));
    EXPECT_EQ(readBack<float>(at("a.exr"), 1, 2, 4, OIIO::TypeDesc::FLOAT), pixels);
}

TEST_F(WriteTest, sizesBelowOneAreNamed) {
    const Result<void> saved = savePng(at("a.png"), 0, 2, nullptr);
    ASSERT_FALSE(saved);
    EXPECT_EQ(saved.error().code, ErrorCode::InvalidArgument);
    EXPECT_EQ(fileCount(), 0);
}

} // namespace
} // namespace slabcast::test
