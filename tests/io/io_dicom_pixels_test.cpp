#include "tests/support/dicom_test_support.h"

namespace slabcast::test {
namespace {

/// 5 x 4 samples of 16 bits, 7 + 100 i, lossless.
constexpr std::string_view kJpeg2000 =
    "ff4fff5100290000000000050000000400000000000000000000000500000004000000000000000000010f0101ff52"
    "000c00000001000004040001ff5c00044080ff640025000143726561746564206279204f70656e4a50454720766572"
    "73696f6e20322e352e30ff90000a0000000000340001ff93cffc308811505460f4745efbce7e9ec29a0c63e5e964ab"
    "a3108c26762d69b205577e7c85388fffd9";

/// The same by JPEG's lossless process 14 and by JPEG-LS, and 10 i in 8 bits by baseline JPEG
/// at its best quality.
constexpr std::string_view kJpegLossless =
    "ffd8ffe000104a46494600010100000100010000ffc3000b100004000501011100ffc40016000101010000000000"
    "000000000000000007090fffda0008010100010000c001991919192fa323232325f464646464be8c8c8c8c9fffd9";
constexpr std::string_view kJpegLs =
    "ffd8fff7000b100004000501011100fff8000d01ff000012004301140040ffda000801010000000040d98f31e62c"
    "c7fd132263589323f4585606fa637e6de6eb716200ffd900";
constexpr std::string_view kJpegBaseline =
    "ffd8ffe000104a46494600010100000100010000ffdb004300010101010101010101010101010101010101010101"
    "01010101010101010101010101010101010101010101010101010101010101010101010101010101010101ffc000"
    "0b080004000501011100ffc4001f0000010501010101010100000000000000000102030405060708090a0bffc400"
    "b5100002010303020403050504040000017d01020300041105122131410613516107227114328191a1082342b1c1"
    "1552d1f02433627282090a161718191a25262728292a3435363738393a434445464748494a535455565758595a63"
    "6465666768696a737475767778797a838485868788898a92939495969798999aa2a3a4a5a6a7a8a9aab2b3b4b5b6"
    "b7b8b9bac2c3c4c5c6c7c8c9cad2d3d4d5d6d7d8d9dae1e2e3e4e5e6e7e8e9eaf1f2f3f4f5f6f7f8f9faffda0008"
    "010100003f00f60f825ff0492fd883fe1124ff008b5fff003c3fe5be9ffdc7ff00a84d7fffd9";

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

TEST_F(DicomPixelsTest, losslessJpegIsDecoded) {
    const std::array<std::pair<const char*, std::string_view>, 2> cases = {
        {{"1.2.840.10008.1.2.4.70", kJpegLossless}, {"1.2.840.10008.1.2.4.80", kJpegLs}}};
    for (const auto& [syntax, hex] : cases) {
        const std::string frame = fromHex(hex);
        const Result<Volume> volume =
            loadVolume(writeDicom("a.dcm", compressed({frame, frame, frame}), syntax));
        ASSERT_LOADED(volume);
        for (int i = 0; i < 20; ++i) {
            EXPECT_EQ(volume->valueAt({i % 5, i / 5, 2}), 7 + 100 * i) << syntax;
        }
        const std::string cut = frame.substr(0, frame.size() / 2);
        expectFailure(loadVolume(writeDicom("b.dcm", compressed({frame, cut, frame}), syntax)),
                      ErrorCode::FileUnreadable, "b.dcm", "frame 2");
    }
}

TEST_F(DicomPixelsTest, baselineJpegIsDecoded) {
    const std::string frame = fromHex(kJpegBaseline);
    DicomElements bytes = compressed({frame, frame, frame});
    bytes.word(0x00280100, 8).word(0x00280101, 8).word(0x00280102, 7);
    const Result<Volume> volume = loadVolume(writeDicom("a.dcm", bytes, "1.2.840.10008.1.2.4.50"));
    ASSERT_LOADED(volume);
    for (int i = 0; i < 20; ++i) {
        EXPECT_NEAR(volume->valueAt({i % 5, i / 5, 2}), 10 * i, 1.0);
    }
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
