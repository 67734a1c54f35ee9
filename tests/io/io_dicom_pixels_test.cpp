#include "tests/support/dicom_test_support.h"

namespace slabcast::test {
namespace {

/// 5 x 4 samples of 16 bits, 7 + 100 i, lossless.
constexpr std::string_view kJpeg2000 =
    "ff4fff5100290000000000050000000400000000000000000000000500000004000000000000000000010f0101ff52"
    "000c00000001000004040001ff5c00044080ff640025000143726561746564206279204f70656e4a50454720766572"
    "73696f6e20322e352e30ff90000a0000000000340001ff93cffc308811505460f4745efbce7e9ec29a0c63e5e964ab"
    "a3108c26762d69b205577e7c85388fffd9";

std::string fromHex(std::string_view hex) {
    std::string bytes;
    for (std::size_t i = 0; i < hex.size(); i += 2) {
        bytes += static_cast<char>(std::stoi(std::string(hex.substr(i, 2)), nullptr, 16));
    }
    return bytes;
}

class DicomPixelsTest : public DicomFilesTest {
protected:
    static constexpr const char* kRle = "1.2.840.10008.1.2.5";
    static constexpr const char* kJpeg2000Lossless = "1.2.840.10008.1.2.4.90";

    static DicomElements compressed(const std::vector<std::string>& frames) {
        return enhanced("", {30, 33, 36}).word(0x00280103, 0).fragments(frames);
    }

    /// Both bytes of 20 pixels, each as a run: high ones, then low ones.
    static std::string rle(int high, int low) {
        std::string frame(64, '\0');
        frame[0] = 2;
        frame[4] = 64;
        frame[8] = 66;
        for (const int value : {high, low}) {
            frame += static_cast<char>(1 - 20);
            frame += static_cast<char>(value);
        }
        return frame;
    }
};

TEST_F(DicomPixelsTest, runsAreDecoded) {
    const auto path = writeDicom("a.dcm", compressed({rle(0, 5), rle(1, 2), rle(2, 255)}), kRle);
    const Result<Volume> volume = loadVolume(path);
    ASSERT_LOADED(volume);
    EXPECT_EQ(volume->valueAt({4, 3, 0}), 5);
    EXPECT_EQ(volume->valueAt({4, 3, 1}), 258);
    EXPECT_EQ(volume->valueAt({0, 0, 2}), 767);
}

TEST_F(DicomPixelsTest, jpeg2000IsDecoded) {
    const std::string frame = fromHex(kJpeg2000);
    const auto path = writeDicom("a.dcm", compressed({frame, frame, frame}), kJpeg2000Lossless);
    const Result<Volume> volume = loadVolume(path);
    ASSERT_LOADED(volume);
    for (int i = 0; i < 20; ++i) {
        EXPECT_EQ(volume->valueAt({i % 5, i / 5, 1}), 7 + 100 * i);
    }
    const std::string cut = frame.substr(0, 100);
    expectFailure(
        loadVolume(writeDicom("b.dcm", compressed({frame, cut, frame}), kJpeg2000Lossless)),
        ErrorCode::FileUnreadable, "b.dcm", "frame 2");
}

TEST_F(DicomPixelsTest, missingFragmentsAreRefused) {
    expectFailure(loadVolume(writeDicom("a.dcm", compressed({rle(0, 5), rle(0, 6)}), kRle)),
                  ErrorCode::FileTruncated, "a.dcm", "2 compressed pieces for 3 frames");
}

TEST_F(DicomPixelsTest, unknownCompressionIsNamed) {
    const auto path =
        writeDicom("a.dcm", compressed({"ab", "cd", "ef"}), "1.2.840.10008.1.2.4.100");
    expectFailure(loadVolume(path), ErrorCode::UnsupportedType, "a.dcm", "MPEG2");
}

TEST_F(DicomPixelsTest, depthsAreRead) {
    DicomElements bytes = enhanced(codes<std::int8_t>(), {30, 33, 36});
    bytes.word(0x00280100, 8).word(0x00280101, 8).word(0x00280102, 7);
    const Result<Volume> eight = loadVolume(writeDicom("a.dcm", bytes));
    ASSERT_LOADED(eight);
    EXPECT_EQ(eight->type, VoxelType::I8);
    expectCodes(*eight);

    DicomElements wide = enhanced(codes<std::uint32_t>(), {30, 33, 36});
    wide.word(0x00280100, 32).word(0x00280101, 32).word(0x00280102, 31).word(0x00280103, 0);
    const Result<Volume> thirtyTwo = loadVolume(writeDicom("a.dcm", wide));
    ASSERT_LOADED(thirtyTwo);
    EXPECT_EQ(thirtyTwo->type, VoxelType::U32);
    expectCodes(*thirtyTwo);

    DicomElements floats = enhanced("", {30, 33, 36});
    floats.without(0x7fe00010).raw(0x7fe00008, "OF", codes<float>()).word(0x00280100, 32);
    const Result<Volume> real = loadVolume(writeDicom("a.dcm", floats));
    ASSERT_LOADED(real);
    EXPECT_EQ(real->type, VoxelType::F32);
    expectCodes(*real);

    DicomElements bits = enhanced("\x21\x84\xff\x00\x00\x00\x00\x01", {30, 33, 36}); // 60 of 64
    bits.word(0x00280100, 1).word(0x00280101, 1).word(0x00280102, 0).word(0x00280103, 0);
    const Result<Volume> mask = loadVolume(
        writeDicom("a.dcm", bits.raw(0x7fe00010, "OB", std::string("\x21\x84\xff\0\0\0\0\1", 8))));
    ASSERT_LOADED(mask);
    EXPECT_EQ(mask->valueAt({0, 0, 0}), 1);
    EXPECT_EQ(mask->valueAt({1, 0, 0}), 0);
    EXPECT_EQ(mask->valueAt({0, 1, 0}), 1);
    EXPECT_EQ(mask->valueAt({0, 3, 0}), 1);
    EXPECT_EQ(mask->valueAt({3, 0, 1}), 1);
    EXPECT_EQ(mask->valueAt({4, 0, 1}), 0);
}

TEST_F(DicomPixelsTest, coloursAreRefused) {
    writeSlices([](DicomElements& elements, int) {
        elements.word(0x00280002, 3).text(0x00280004, "CS", "RGB");
    });
    expectFailure(loadVolume(folder_), ErrorCode::UnsupportedType, "0.dcm", "RGB");
}

} // namespace
} // namespace slabcast::test
