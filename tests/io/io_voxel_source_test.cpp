// Voxels as files hold them, and numbers as files store them.
#include "tests/support/io_test_support.h"

#include <sstream>

#include "platform/io/volumes/inflater.h"
#include "platform/io/volumes/stored_values.h"
#include "platform/io/volumes/voxel_source.h"
#include "platform/io/volumes/voxel_text.h"

namespace slabcast::test {
namespace {

class VoxelSourceTest : public IoTest {
protected:
    /// Bytes "ab...": as many as `count`, from the first on.
    static std::string letters(int count) {
        std::string text;
        for (int i = 0; i < count; ++i) {
            text += static_cast<char>('a' + i % 26);
        }
        return text;
    }

    static Result<std::string> read(const VoxelSource& source, std::int64_t bytes,
                                    std::int64_t first, std::size_t size) {
        std::vector<std::byte> voxels(size);
        return checkVoxelFiles("head", source, {VoxelType::U8}, bytes)
            .and_then([&]() {
                return readVoxelBytes("head", source, {VoxelType::U8}, bytes, first, voxels);
            })
            .map([&]() {
                return std::string(reinterpret_cast<const char*>(voxels.data()), voxels.size());
            });
    }

    static void expectRead(const VoxelSource& source, std::int64_t bytes, std::int64_t first,
                           const std::string& expected) {
        const Result<std::string> voxels = read(source, bytes, first, expected.size());
        ASSERT_TRUE(voxels) << voxels.error().detail;
        EXPECT_EQ(*voxels, expected);
    }
};

TEST_F(VoxelSourceTest, skipsComeOneBehindTheOther) {
    const auto path = write("a.raw", "head\none\ntwo\nxx" + letters(8) + "tail");
    expectRead({{path}, DataEncoding::Raw, false, 5, 2, 2}, 8, 0, letters(8));
    expectRead({{path}, DataEncoding::Raw, false, 5, 2, 2}, 8, 3, "def");
    expectRead({{path}, DataEncoding::Raw, false, 5, 0, -1}, 4, 0, "tail");
    expectRead({{path}, DataEncoding::Raw, false, 5, 0, -5}, 8, 0, letters(8));
}

TEST_F(VoxelSourceTest, voxelsNeverBeginInTheHeader) {
    const auto path = write("a.raw", "a long header\n" + letters(8));
    for (const VoxelSource& source :
         {VoxelSource{{path}, DataEncoding::Raw, false, 14, 0, -2},
          VoxelSource{{path}, DataEncoding::Raw, false, 14, 0, 1},
          VoxelSource{{path}, DataEncoding::Raw, false, 14, 9, 0},
          VoxelSource{{path}, DataEncoding::Raw, false, 14, 0, -(std::int64_t{1} << 60)}}) {
        const Result<std::string> voxels = read(source, 8, 0, 8);
        ASSERT_FALSE(voxels);
        EXPECT_EQ(voxels.error().code, ErrorCode::FileTruncated) << voxels.error().detail;
    }
}

TEST_F(VoxelSourceTest, severalFilesFollowEachOther) {
    VoxelSource source{{write("0", "abc"), write("1", "def"), write("2", "ghi")},
                       DataEncoding::Raw};
    expectRead(source, 9, 0, letters(9));
    expectRead(source, 9, 2, "cdefg");
    expectRead(source, 9, 3, "def");
    write("1", "de");
    const Result<std::string> cut = read(source, 9, 0, 9);
    ASSERT_FALSE(cut);
    EXPECT_NE(cut.error().detail.find(at("1").string() + " has 2 bytes"), std::string::npos)
        << cut.error().detail;
    source.files[2] = at("gone");
    source.files[1] = source.files[0];
    EXPECT_EQ(read(source, 9, 0, 9).error().code, ErrorCode::FileNotFound);
}

std::string fileText(const std::filesystem::path& path) {
    std::ifstream stream(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

TEST_F(VoxelSourceTest, deflatedVoxelsMayComeBehindLinesAndInMembers) {
    const std::string first = fileText(writeGz("1.gz", "skip" + letters(10)));
    const std::string second = fileText(writeGz("2.gz", letters(26).substr(10)));
    const auto path = write("a", "one\ntwo\n" + first + second);
    expectRead({{path}, DataEncoding::Deflate, false, 0, 2, 4}, 26, 0, letters(26));
    expectRead({{path}, DataEncoding::Deflate, false, 0, 2, 4}, 26, 8, "ijkl");
    expectRead({{path}, DataEncoding::Deflate, false, 8, 0, -1}, 26, 0, letters(26));
    expectRead({{path}, DataEncoding::Deflate, false, 8, 0, -3}, 24, 0, letters(24));
    EXPECT_FALSE(read({{path}, DataEncoding::Deflate, false, 0, 2, 5}, 26, 0, 26));
    EXPECT_FALSE(read({{path}, DataEncoding::Deflate, false, 0, 2, -9}, 26, 0, 26));
    EXPECT_FALSE(read({{path}, DataEncoding::Deflate, false, 0, 1, 4}, 26, 0, 26));
}

TEST_F(VoxelSourceTest, aDamagedChecksumIsNoticed) {
    std::string packed = fileText(writeGz("1.gz", letters(5000)));
    packed[packed.size() - 6] ^= 1;
    const Result<std::string> voxels =
        read({{write("a", packed)}, DataEncoding::Deflate}, 5000, 0, 5000);
    ASSERT_FALSE(voxels);
    EXPECT_NE(voxels.error().detail.find("compressed voxels"), std::string::npos);
}

TEST_F(VoxelSourceTest, hexIsRead) {
    const auto path = write("a.hex", "6162 63\n6A");
    expectRead({{path}, DataEncoding::Hex}, 4, 0, "abcj");
    expectRead({{path}, DataEncoding::Hex}, 4, 2, "cj");
    EXPECT_FALSE(read({{path}, DataEncoding::Hex}, 5, 0, 5));
    EXPECT_FALSE(read({{write("b.hex", "616x")}, DataEncoding::Hex}, 2, 0, 2));
}

TEST_F(VoxelSourceTest, readersMayBeStopped) {
    const auto path = write("a.raw", letters(8));
    std::vector<std::byte> voxels(8);
    const Result<void> stopped =
        readVoxelBytes("head", {{path}, DataEncoding::Raw}, {VoxelType::U8}, 8, 0, voxels,
                       [](const std::filesystem::path&, double) -> Result<void> {
                           return fail(ErrorCode::InvalidArgument, "enough");
                       });
    ASSERT_FALSE(stopped);
    EXPECT_EQ(stopped.error().detail, "enough");
}

template <class T>
Result<std::vector<T>> numbers(const std::string& text, StoredType type, std::size_t count) {
    std::istringstream stream(text);
    std::vector<T> values(count);
    return TextVoxels(stream, type).take(std::as_writable_bytes(std::span(values))).map([&]() {
        return values;
    });
}

TEST(VoxelText, numbersStandBetweenBlanksOrCommas) {
    const std::vector<std::int16_t> expected = {1, -2, 3, 4, 5};
    const StoredType type{VoxelType::I16};
    for (const char* text :
         {"1 -2 3 4 5", "1,-2,3,4,5\n", "1, -2,\n3\t+4 , 5", "1.0 -2.0 3 4e0 5."}) {
        const auto values = numbers<std::int16_t>(text, type, 5);
        ASSERT_TRUE(values) << text << values.error().detail;
        EXPECT_EQ(*values, expected) << text;
    }
    EXPECT_EQ(
        numbers<std::int64_t>("-9223372036854775808", {VoxelType::F64, Wide::Signed}, 1)->at(0),
        std::numeric_limits<std::int64_t>::min());
    EXPECT_EQ(numbers<float>("0.5 1e-3,-2.5e1", {VoxelType::F32}, 3).value(),
              (std::vector<float>{0.5F, 1e-3F, -25.0F}));
}

TEST(VoxelText, whatIsNoNumberOfTheTypeIsNamed) {
    for (const char* text : {"1 2 300", "1 2 x", "1 2 -1", "1 2 1.5", "1 2 nan"}) {
        const auto values = numbers<std::uint8_t>(text, {VoxelType::U8}, 3);
        ASSERT_FALSE(values) << text;
        EXPECT_EQ(values.error().code, ErrorCode::FileUnreadable);
        EXPECT_NE(values.error().detail.find("voxel 2"), std::string::npos)
            << values.error().detail;
        EXPECT_NE(values.error().detail.find("uint8"), std::string::npos) << values.error().detail;
    }
    EXPECT_EQ(numbers<std::uint8_t>("1 2", {VoxelType::U8}, 3).error().code,
              ErrorCode::FileTruncated);
    const auto endless = numbers<std::uint8_t>(std::string(100000, '7'), {VoxelType::U8}, 1);
    ASSERT_FALSE(endless);
    EXPECT_LT(endless.error().detail.size(), 300U);
}

template <class T>
VoxelBytes bytesOf(std::initializer_list<T> values) {
    return VoxelBytes(std::as_bytes(std::span(values.begin(), values.size())));
}

TEST(StoredValues, integersOf64BitsBecomeTheFirstTypeThatKeepsThem) {
    using I = std::int64_t;
    VoxelBytes bytes = bytesOf<I>({-5, 0, 1000});
    EXPECT_EQ(narrow(bytes, Wide::Signed).value(), VoxelType::I32);
    EXPECT_EQ(bytes, bytesOf<std::int32_t>({-5, 0, 1000}));
    bytes = bytesOf<I>({0, 4000000000});
    EXPECT_EQ(narrow(bytes, Wide::Signed).value(), VoxelType::U32);
    EXPECT_EQ(bytes, bytesOf<std::uint32_t>({0, 4000000000}));
    bytes = bytesOf<I>({-1, 4000000000, I{1} << 60});
    EXPECT_EQ(narrow(bytes, Wide::Signed).value(), VoxelType::F64);
    EXPECT_EQ(bytes, bytesOf<double>({-1.0, 4e9, 1152921504606846976.0}));
    bytes = bytesOf<std::uint64_t>({0, std::uint64_t{1} << 63});
    EXPECT_EQ(narrow(bytes, Wide::Unsigned).value(), VoxelType::F64);
    bytes = bytesOf<I>({std::numeric_limits<I>::min()});
    EXPECT_EQ(narrow(bytes, Wide::Signed).value(), VoxelType::F64);
    bytes = bytesOf<I>({(I{1} << 53) + 1});
    const Result<VoxelType> none = narrow(bytes, Wide::Signed);
    ASSERT_FALSE(none);
    EXPECT_NE(none.error().detail.find("int64"), std::string::npos);
}

TEST(StoredValues, rescaledValuesGrowInPlace) {
    VoxelBytes bytes = bytesOf<std::int16_t>({99, 99, 99, 1, -2, 300}); // stored ones at the end
    rescale(bytes, {VoxelType::I16}, {2.0, -24.0});
    EXPECT_EQ(bytes, bytesOf<float>({-22.0F, -28.0F, 576.0F}));
    bytes = bytesOf<std::int32_t>({0, 0, 16777217, -16777217});
    rescale(bytes, {VoxelType::I32}, {2.0, 1.0});
    EXPECT_EQ(bytes, bytesOf<double>({33554435.0, -33554433.0}));
}

} // namespace
} // namespace slabcast::test
