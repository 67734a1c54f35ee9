// TIFF as instruments and programs write it, byte by byte: what no library would write for us.
#include "tests/support/io_test_support.h"

#include <map>

#include <OpenImageIO/imageio.h>

#include "platform/io/base/readers.h"

namespace slabcast::test {
namespace {

struct Field {
    int type; // 2 text, 3 of 16 bits, 4 of 32 bits, 5 a ratio
    std::vector<std::uint32_t> numbers;
    std::string text;
};

struct TestPage {
    int width = 0;
    int height = 0;
    std::string pixels;
    std::map<int, Field> fields; // on top of the usual ones
};

Field shortField(std::uint32_t value) {
    return {3, {value}, ""};
}

Field textField(const std::string& text) {
    return {2, {}, text + '\0'};
}

/// A number as so many bytes.
std::string bytesOf(std::uint64_t value, int count, bool isBigEndian) {
    std::string bytes;
    for (int i = 0; i < count; ++i) {
        bytes += static_cast<char>(value >> 8 * (isBigEndian ? count - 1 - i : i));
    }
    return bytes;
}

std::string tiffOf(const std::vector<TestPage>& pages, bool isBigEndian = false) {
    const auto number = [&](std::uint64_t value, int count) {
        return bytesOf(value, count, isBigEndian);
    };
    std::string file = (isBigEndian ? "MM" : "II") + number(42, 2) + number(0, 4);
    std::size_t link = 4;
    for (const TestPage& page : pages) {
        const auto at = static_cast<std::uint32_t>(file.size());
        file += page.pixels;
        std::map<int, Field> fields = {
            {256, {4, {static_cast<std::uint32_t>(page.width)}, ""}},
            {257, {4, {static_cast<std::uint32_t>(page.height)}, ""}},
            {258, shortField(8)},
            {259, shortField(1)},
            {262, shortField(1)},
            {273, {4, {at}, ""}},
            {277, shortField(1)},
            {278, {4, {static_cast<std::uint32_t>(page.height)}, ""}},
            {279, {4, {static_cast<std::uint32_t>(page.pixels.size())}, ""}},
        };
        for (const auto& [tag, field] : page.fields) {
            fields[tag] = field;
        }
        std::map<int, std::string> values;
        for (const auto& [tag, field] : fields) {
            std::string value = field.text;
            for (const std::uint32_t each : field.numbers) {
                value += number(each, field.type == 3 ? 2 : 4);
            }
            if (value.size() > 4) {
                const std::size_t there = file.size();
                file += value;
                value = number(there, 4);
            }
            value.resize(4);
            values[tag] = value;
        }
        file.replace(link, 4, number(file.size(), 4));
        file += number(fields.size(), 2);
        for (const auto& [tag, field] : fields) {
            const std::size_t count = field.type == 2
                                          ? field.text.size()
                                          : field.numbers.size() / (field.type == 5 ? 2 : 1);
            file += number(tag, 2) + number(field.type, 2) + number(count, 4) + values[tag];
        }
        link = file.size();
        file += number(0, 4);
    }
    return file;
}

/// Rows of so many bits a value, each row on bytes of its own; depths of whole bytes as the machine
/// that wrote the file holds them.
std::string packed(const std::vector<std::uint64_t>& values, int width, int bits,
                   bool isBigEndian = false) {
    std::string bytes;
    std::uint64_t held = 0;
    int count = 0;
    for (std::size_t i = 0; i < values.size(); ++i) {
        if (bits % 8 == 0 && (bits <= 32 || bits == 64)) {
            bytes += bytesOf(values[i], bits / 8, isBigEndian);
            continue;
        }
        held = held << bits | (values[i] & ((std::uint64_t{1} << bits) - 1));
        count += bits;
        const bool endsRow = (i + 1) % width == 0;
        for (; count >= 8; count -= 8) {
            bytes += static_cast<char>(held >> (count - 8));
        }
        if (endsRow && count > 0) {
            bytes += static_cast<char>(held << (8 - count));
            count = 0;
        }
    }
    return bytes;
}

std::vector<std::uint64_t> codesOf(int z) {
    std::vector<std::uint64_t> values;
    for (int i = 0; i < kDims.x * kDims.y; ++i) {
        values.push_back(codeAt(i % kDims.x, i / kDims.x, z));
    }
    return values;
}

class TiffTest : public IoTest {
protected:
    /// Three pages of codes, with these fields on each and those on the first.
    static std::vector<TestPage> codePages(int bits = 16, const std::map<int, Field>& fields = {},
                                           const std::map<int, Field>& first = {}) {
        std::vector<TestPage> pages;
        for (int z = 0; z < kDims.z; ++z) {
            TestPage page{kDims.x, kDims.y, packed(codesOf(z), kDims.x, bits), fields};
            page.fields[258] = shortField(bits);
            if (z == 0) {
                page.fields.insert(first.begin(), first.end());
            }
            pages.push_back(page);
        }
        return pages;
    }

    std::filesystem::path writeTiff(const std::string& name, const std::vector<TestPage>& pages,
                                    bool isBigEndian = false) const {
        return write(name, tiffOf(pages, isBigEndian));
    }

    /// With a description on the first page.
    std::filesystem::path describedTiff(const std::string& text,
                                        const std::map<int, Field>& more = {}) const {
        std::map<int, Field> first = more;
        first[270] = textField(text);
        return writeTiff("described.tif", codePages(16, {}, first));
    }

    static bool says(const Volume& volume, std::string_view part) {
        return std::any_of(volume.notes.begin(), volume.notes.end(), [&](const std::string& note) {
            return note.find(part) != std::string::npos;
        });
    }
};

constexpr const char* kNoSize =
    "states no voxel size: 1 x 1 x 1 mm is assumed; --spacing X,Y,Z gives it";

TEST_F(TiffTest, everyDepthIsReadAsStored) {
    for (int bits = 1; bits <= 32; ++bits) {
        for (const bool isSigned : {false, true}) {
            SCOPED_TRACE(std::to_string(bits) + (isSigned ? " signed" : ""));
            const std::uint64_t highest = (std::uint64_t{1} << bits) - 1;
            const std::vector<std::uint64_t> values = {
                0, highest, 1 & highest, highest / 3, highest / 2 + 1, 0x5A5A5A5A & highest};
            TestPage page{3,
                          2,
                          packed(values, 3, bits),
                          {{258, shortField(bits)}, {339, shortField(isSigned ? 2 : 1)}}};
            const Result<Volume> volume = loadVolume(writeTiff("a.tif", {page, page}));
            ASSERT_LOADED(volume);
            const VoxelType type = bits <= 8    ? isSigned ? VoxelType::I8 : VoxelType::U8
                                   : bits <= 16 ? isSigned ? VoxelType::I16 : VoxelType::U16
                                   : isSigned   ? VoxelType::I32
                                                : VoxelType::U32;
            EXPECT_EQ(volume->type, type);
            for (int i = 0; i < 6; ++i) {
                const auto stored = static_cast<double>(values[i]);
                const bool isNegative = isSigned && values[i] > highest / 2;
                EXPECT_EQ(volume->valueAt({i % 3, i / 3, 1}),
                          isNegative ? stored - static_cast<double>(highest) - 1.0 : stored)
                    << i;
            }
        }
    }
}

TEST_F(TiffTest, lowestIsWhiteIsTurnedOver) {
    for (const int bits : {1, 4, 7, 8, 10, 12, 16, 24, 32}) {
        SCOPED_TRACE(bits);
        const std::uint64_t highest = (std::uint64_t{1} << bits) - 1;
        TestPage page{
            2, 1, packed({0, highest}, 2, bits), {{258, shortField(bits)}, {262, shortField(0)}}};
        const Result<Volume> volume = loadVolume(writeTiff("a.tif", {page, page}));
        ASSERT_LOADED(volume);
        EXPECT_EQ(volume->valueAt({0, 0, 1}), static_cast<double>(highest));
        EXPECT_EQ(volume->valueAt({1, 0, 1}), 0.0);
    }
    TestPage page{2,
                  1,
                  packed({0, 0xFFFF}, 2, 16),
                  {{258, shortField(16)}, {262, shortField(0)}, {339, shortField(2)}}};
    const Result<Volume> negative = loadVolume(writeTiff("a.tif", {page, page}));
    ASSERT_LOADED(negative);
    EXPECT_EQ(negative->valueAt({1, 0, 0}), -1.0);
    EXPECT_TRUE(says(*negative, "white"));
}

TEST_F(TiffTest, floatingPointOfThreeDepthsIsRead) {
    const std::vector<std::pair<std::uint64_t, double>> halves = {
        {0x3C00, 1.0}, {0xC000, -2.0}, {0x0001, 5.9604644775390625e-08}, {0x7BFF, 65504.0}};
    for (const auto& [bits, value] : halves) {
        TestPage page{1, 1, packed({bits}, 1, 16), {{258, shortField(16)}, {339, shortField(3)}}};
        const Result<Volume> volume = loadVolume(writeTiff("a.tif", {page, page}));
        ASSERT_LOADED(volume);
        EXPECT_EQ(volume->type, VoxelType::F32);
        EXPECT_EQ(volume->valueAt({0, 0, 1}), value);
    }
    for (const bool isBigEndian : {false, true}) { // pages of one row
        const std::string row =
            packed({std::bit_cast<std::uint64_t>(1.5), std::bit_cast<std::uint64_t>(-0.1)}, 2, 64,
                   isBigEndian);
        TestPage page{2, 1, row, {{258, shortField(64)}, {339, shortField(3)}}};
        const Result<Volume> volume =
            loadVolume(writeTiff("a.tif", {page, page, page}, isBigEndian));
        ASSERT_LOADED(volume);
        EXPECT_EQ(volume->type, VoxelType::F64);
        EXPECT_EQ(volume->valueAt({0, 0, 2}), 1.5);
        EXPECT_EQ(volume->valueAt({1, 0, 2}), -0.1);
    }
}

TEST_F(TiffTest, orderOfBytesAndBitsIsHeeded) {
    for (const int bits : {8, 12, 16, 24, 32}) {
        SCOPED_TRACE(bits);
        std::vector<TestPage> pages = codePages(bits);
        for (int z = 0; z < kDims.z; ++z) {
            pages[z].pixels = packed(codesOf(z), kDims.x, bits, true);
        }
        const Result<Volume> volume = loadVolume(writeTiff("a.tif", pages, true));
        ASSERT_LOADED(volume);
        expectCodes(*volume);
    }
    std::vector<TestPage> pages = codePages(8, {{266, shortField(2)}});
    for (TestPage& page : pages) {
        for (char& pixel : page.pixels) {
            unsigned turned = 0;
            for (unsigned bit = 0; bit < 8; ++bit) {
                turned |= (static_cast<unsigned char>(pixel) >> bit & 1U) << (7 - bit);
            }
            pixel = static_cast<char>(turned);
        }
    }
    const Result<Volume> volume = loadVolume(writeTiff("a.tif", pages));
    ASSERT_LOADED(volume);
    expectCodes(*volume);
}

TEST_F(TiffTest, orientationIsApplied) {
    for (const int bits : {12, 16}) {
        for (int orientation = 1; orientation <= 8; ++orientation) {
            SCOPED_TRACE(orientation);
            const std::map<int, Field> turned = {{274, shortField(orientation)},
                                                 {282, {5, {100, 1}, ""}},
                                                 {283, {5, {50, 1}, ""}},
                                                 {296, shortField(3)}};
            const Result<Volume> volume = loadVolume(writeTiff("a.tif", codePages(bits, turned)));
            ASSERT_LOADED(volume);
            const bool isTransposed = orientation >= 5;
            const glm::ivec3 dims{isTransposed ? 4 : 5, isTransposed ? 5 : 4, 3};
            ASSERT_EQ(volume->geometry.dims, dims);
            expectNear(volume->geometry.spacingMm,
                       isTransposed ? glm::dvec3(0.2, 0.1, 1) : glm::dvec3(0.1, 0.2, 1));
            for (int row = 0; row < 4; ++row) {
                for (int column = 0; column < 5; ++column) {
                    // TIFF 6.0: where row 0 and column 0 lie.
                    const std::array<glm::ivec2, 8> upright = {{{column, row},
                                                                {4 - column, row},
                                                                {4 - column, 3 - row},
                                                                {column, 3 - row},
                                                                {row, column},
                                                                {3 - row, column},
                                                                {3 - row, 4 - column},
                                                                {row, 4 - column}}};
                    ASSERT_EQ(volume->valueAt({upright[orientation - 1], 2}),
                              codeAt(column, row, 2));
                }
            }
        }
    }
}

TEST_F(TiffTest, stripsTilesAndCompressionsAreRead) {
    using OIIO::TypeDesc;
    const glm::ivec3 dims{37, 21, 2};
    for (const char* compression : {"none", "lzw", "zip", "packbits"}) {
        for (const bool isTiled : {false, true}) {
            SCOPED_TRACE(std::string(compression) + (isTiled ? " tiled" : ""));
            OIIO::ImageSpec spec(dims.x, dims.y, 1, TypeDesc::UINT16);
            spec.attribute("compression", compression);
            spec.attribute("tiff:RowsPerStrip", 4);
            spec.attribute("tiff:bigtiff", isTiled ? 1 : 0);
            spec.tile_width = spec.tile_height = isTiled ? 16 : 0;
            const std::vector<OIIO::ImageSpec> specs(2, spec);
            const auto file = OIIO::ImageOutput::create(at("a.tif").string());
            ASSERT_TRUE(file && file->open(at("a.tif").string(), 2, specs.data()));
            std::vector<std::uint16_t> pixels;
            for (int i = 0; i < dims.x * dims.y; ++i) {
                pixels.push_back(codeAt(i % dims.x, i / dims.x, 0));
            }
            ASSERT_TRUE(file->write_image(TypeDesc::UINT16, pixels.data()));
            ASSERT_TRUE(file->open(at("a.tif").string(), spec, OIIO::ImageOutput::AppendSubimage));
            std::transform(pixels.begin(), pixels.end(), pixels.begin(),
                           [](std::uint16_t value) { return value + codeAt(0, 0, 1); });
            ASSERT_TRUE(file->write_image(TypeDesc::UINT16, pixels.data()));
            file->close();
            const Result<Volume> volume = loadVolume(at("a.tif"));
            ASSERT_LOADED(volume);
            expectCodes(*volume, dims);
        }
    }
}

TEST_F(TiffTest, oneSampleOfSeveralIsTaken) {
    for (const bool isPlanar : {false, true}) {
        for (const int bits : {8, 12}) {
            std::vector<TestPage> pages;
            for (int z = 0; z < kDims.z; ++z) {
                const std::vector<std::uint64_t> second = codesOf(z);
                const std::vector<std::uint64_t> first(second.size(), 7);
                std::vector<std::uint64_t> mixed;
                for (const std::uint64_t value : second) {
                    mixed.insert(mixed.end(), {7, value});
                }
                TestPage page{
                    kDims.x,
                    kDims.y,
                    packed(mixed, 2 * kDims.x, bits),
                    {{258,
                      {3,
                       {static_cast<std::uint32_t>(bits), static_cast<std::uint32_t>(bits)},
                       ""}},
                     {277, shortField(2)},
                     {284, shortField(isPlanar ? 2 : 1)}}};
                if (isPlanar) { // two strips, known once the page's place is
                    page.pixels = packed(first, kDims.x, bits) + packed(second, kDims.x, bits);
                    page.fields[278] = {4, {static_cast<std::uint32_t>(kDims.y)}, ""};
                }
                pages.push_back(page);
            }
            std::string file = tiffOf(pages);
            if (isPlanar) {
                file = ""; // laid out anew, page by page, with the offsets that came out
                std::uint32_t at = 8;
                for (TestPage& page : pages) {
                    const auto half = static_cast<std::uint32_t>(page.pixels.size() / 2);
                    page.fields[273] = {4, {at, at + half}, ""};
                    page.fields[279] = {4, {half, half}, ""};
                    at = static_cast<std::uint32_t>(
                        tiffOf({pages.begin(), pages.begin() + (&page - pages.data()) + 1}).size());
                }
                file = tiffOf(pages);
            }
            const auto path = write("a.tif", file);
            expectFailure(loadVolume(path), ErrorCode::UnsupportedType, "a.tif",
                          "has 2 channels, and a volume has one; convert the images to grey "
                          "without alpha, or take one with --select channel=N, from 1 to 2");
            const Result<Volume> volume = loadVolume(path, {.select = {{"channel", "2"}}});
            ASSERT_LOADED(volume);
            expectCodes(*volume);
            expectFailure(loadVolume(path, {.select = {{"channel", "3"}}}),
                          ErrorCode::InvalidArgument, "a.tif", "takes 1 to 2");
            expectFailure(loadVolume(path, {.select = {{"EchoTime", "3"}}}),
                          ErrorCode::InvalidArgument, "a.tif", "--select channel=N");
        }
    }
}

TEST_F(TiffTest, whatIsNoNumberOfOursIsRefusedInWords) {
    const std::string none(8 * 64, '\0');
    const auto refused = [&](int bits, int format, const char* words) {
        TestPage page{8, 4, none, {{258, shortField(bits)}, {339, shortField(format)}}};
        expectFailure(loadVolume(writeTiff("a.tif", {page, page})), ErrorCode::UnsupportedType,
                      "a.tif: page 1 has", words);
    };
    refused(64, 1, "64-bit integers, which are not read; convert them to an integer of 8 to 32");
    refused(64, 2, "64-bit integers");
    refused(48, 1, "48-bit integers");
    refused(64, 6, "complex numbers");
    refused(32, 5, "complex numbers");
    refused(24, 3, "floating point numbers of 24 bits");
    TestPage odd{8, 4, none, {{259, shortField(34712)}}};
    expectFailure(loadVolume(writeTiff("a.tif", {odd, odd})), ErrorCode::UnsupportedType, "a.tif",
                  "compressed in a way (number 34712), which are not read; save the file with LZW");
}

TEST_F(TiffTest, copiesAndMasksAreLeftOut) {
    const TestPage copy{2, 2, "abcdefgh", {{254, {4, {1}, ""}}, {258, shortField(16)}}};
    const TestPage mask{kDims.x, kDims.y, "abcd", {{254, {4, {4}, ""}}, {258, shortField(1)}}};
    std::vector<TestPage> pages = codePages(16, {{254, {4, {2}, ""}}});
    pages.insert(pages.begin(), copy);
    const Result<Volume> first = loadVolume(writeTiff("a.tif", pages));
    ASSERT_LOADED(first);
    expectCodes(*first);
    EXPECT_TRUE(says(*first, "page 1 is a reduced copy: left out"));
    pages = codePages();
    pages.push_back(copy);
    pages.push_back(mask);
    pages.push_back(copy);
    const Result<Volume> last = loadVolume(writeTiff("a.tif", pages));
    ASSERT_LOADED(last);
    expectCodes(*last);
    EXPECT_TRUE(says(*last, "pages 4, 6 are reduced copies: left out"));
    EXPECT_TRUE(says(*last, "page 5 is a mask: left out"));
    const TestPage old{2, 2, "abcdefgh", {{255, shortField(2)}, {258, shortField(16)}}};
    pages = codePages();
    pages.push_back(old);
    ASSERT_LOADED(loadVolume(writeTiff("a.tif", pages)));
}

TEST_F(TiffTest, aPageThatDiffersIsNamed) {
    std::vector<TestPage> pages = codePages();
    pages.insert(pages.begin(), {2, 2, "abcdefgh", {{258, shortField(16)}}});
    expectFailure(loadVolume(writeTiff("a.tif", pages)), ErrorCode::InvalidGeometry,
                  "a.tif: page 1 has 2 x 2 pixels of uint16, where the other slices have 5 x 4 of "
                  "uint16",
                  "take away");
    std::rotate(pages.begin(), pages.begin() + 1, pages.end());
    pages.back() = pages.front();
    pages.back().pixels.resize(20);
    pages.back().fields[258] = shortField(8);
    expectFailure(loadVolume(writeTiff("a.tif", pages)), ErrorCode::InvalidGeometry,
                  "page 4 has 5 x 4 pixels of uint8", "take away");
}

TEST_F(TiffTest, imagesBehindOneDirectoryAreRead) {
    for (const bool isBigEndian : {false, true}) {
        std::string pixels;
        for (int z = 0; z < kDims.z; ++z) {
            pixels += packed(codesOf(z), kDims.x, 16, isBigEndian);
        }
        // Behind the directory there is room for nothing else.
        TestPage page{kDims.x,
                      kDims.y,
                      pixels,
                      {{258, shortField(16)},
                       {270, textField("ImageJ=1.53q\nimages=3\nslices=3\n")},
                       {279, {4, {40}, ""}}}};
        const std::string file = tiffOf({page}, isBigEndian);
        const Result<Volume> volume = loadVolume(write("a.tif", file));
        ASSERT_LOADED(volume);
        expectCodes(*volume);
    }
    TestPage many{
        kDims.x,
        kDims.y,
        std::string(40, 'a'),
        {{258, shortField(16)}, {270, textField("ImageJ=1.53q\nimages=300000\nslices=300000\n")}}};
    expectFailure(loadVolume(writeTiff("a.tif", {many})), ErrorCode::FileTruncated, "a.tif",
                  "ends before the last of its 300000 images does; fetch");
    many.fields[259] = shortField(5);
    expectFailure(loadVolume(writeTiff("a.tif", {many})), ErrorCode::UnsupportedDims, "a.tif",
                  "save it again from ImageJ");
}

TEST_F(TiffTest, imageJStatesLengthsAndValues) {
    const Result<Volume> volume = loadVolume(describedTiff(
        "ImageJ=1.53q\nimages=3\nslices=3\nunit=mm\nspacing=2.0\ncf=0\nc0=10\nc1=0.5\nvunit=HU\n",
        {{282, {5, {1000000, 1000000}, ""}}, {283, {5, {2, 3}, ""}}, {296, shortField(1)}}));
    ASSERT_LOADED(volume);
    expectNear(volume->geometry.spacingMm, {1.0, 1.5, 2.0});
    EXPECT_EQ(volume->unit, "HU");
    EXPECT_EQ(volume->rescaleSlope, 0.5);
    EXPECT_EQ(volume->valueAt({1, 2, 2}), codeAt(1, 2, 2) * 0.5 + 10.0);
    EXPECT_TRUE(volume->notes.empty());

    const Result<Volume> bare = loadVolume(describedTiff("ImageJ=1.53q\nimages=3\nslices=3\n"));
    ASSERT_LOADED(bare);
    EXPECT_EQ(bare->notes, std::vector<std::string>{kNoSize});
    const Result<Volume> given =
        loadVolume(at("described.tif"), {.spacingMm = glm::dvec3(1, 2, 3)});
    ASSERT_LOADED(given);
    EXPECT_TRUE(given->notes.empty());
    expectNear(given->geometry.spacingMm, {1, 2, 3});
}

TEST_F(TiffTest, imageJsSignedNumbersAreExact) {
    TestPage page{2,
                  1,
                  packed({0, 33768}, 2, 16),
                  {{258, shortField(16)},
                   {270, textField("ImageJ=1\nimages=2\ncf=0\nc0=-32768.0\nc1=1.0\n"
                                   "vunit=gray value\n")}}};
    const Result<Volume> volume = loadVolume(writeTiff("a.tif", {page, page}));
    ASSERT_LOADED(volume);
    EXPECT_EQ(volume->type, VoxelType::I16);
    EXPECT_EQ(volume->rescaleIntercept, 0.0);
    EXPECT_EQ(volume->unit, "");
    EXPECT_EQ(volume->valueAt({0, 0, 1}), -32768.0);
    EXPECT_EQ(volume->valueAt({1, 0, 1}), 1000.0);
}

/// Channel c, slice z and time t hold 100 * c + 10 * z + t.
std::vector<TestPage> hyperstack(const std::string& order, glm::ivec3 counts,
                                 const std::string& text) {
    std::vector<TestPage> pages;
    const auto countOf = [&](char axis) {
        return axis == 'C' ? counts.x : axis == 'Z' ? counts.y : counts.z;
    };
    const int total = counts.x * counts.y * counts.z;
    for (int i = 0; i < total; ++i) {
        int left = i;
        int value = 0;
        for (const char axis : order) {
            value += left % countOf(axis) * (axis == 'C' ? 100 : axis == 'Z' ? 10 : 1);
            left /= countOf(axis);
        }
        pages.push_back(
            {1, 1, packed({static_cast<std::uint64_t>(value)}, 1, 16), {{258, shortField(16)}}});
    }
    pages.front().fields[270] = textField(text);
    return pages;
}

TEST_F(TiffTest, channelsAndTimesAreChosen) {
    const std::string imageJ = "ImageJ=1\nimages=24\nchannels=2\nslices=4\nframes=3\n";
    const std::string ome =
        "<?xml?><OME><Image><Pixels DimensionOrder=\"XYTZC\" SizeC=\"2\" SizeZ=\"4\" SizeT=\"3\">"
        "<TiffData/></Pixels></Image></OME>";
    for (const auto& [order, text] : {std::pair("CZT", imageJ), std::pair("TZC", ome)}) {
        SCOPED_TRACE(order);
        const auto path = writeTiff("a.tif", hyperstack(order, {2, 4, 3}, text));
        expectFailure(loadVolume(path), ErrorCode::UnsupportedType, "a.tif",
                      "has 2 channels, and a volume has one; take one with --select channel=N, "
                      "from 1 to 2");
        expectFailure(loadVolume(path, {.select = {{"channel", "1"}}}), ErrorCode::AmbiguousSeries,
                      "a.tif", "holds 3 volumes over time; take one with --time N, from 0 to 2");
        expectFailure(loadVolume(path, {.select = {{"channel", "1"}}, .time = 3}),
                      ErrorCode::InvalidArgument, "a.tif", "--time takes 0 to 2");
        const Result<Volume> volume = loadVolume(path, {.select = {{"channel", "2"}}, .time = 1});
        ASSERT_LOADED(volume);
        ASSERT_EQ(volume->geometry.dims, glm::ivec3(1, 1, 4));
        for (int z = 0; z < 4; ++z) {
            EXPECT_EQ(volume->valueAt({0, 0, z}), 101 + 10 * z);
        }
    }
    expectFailure(loadVolume(writeTiff("a.tif", hyperstack("CZT", {2, 2, 1}, imageJ))),
                  ErrorCode::UnsupportedDims, "a.tif",
                  "says that it has 2 channels x 4 slices x 3 times, and holds 4 pages");
    expectFailure(loadVolume(writeTiff(
                      "a.tif", hyperstack("CZT", {1, 1, 4}, "ImageJ=1\nimages=4\nframes=4\n"))),
                  ErrorCode::UnsupportedDims, "a.tif", "4 times of one slice each");
}

TEST_F(TiffTest, omeSaysWhichPageIsWhich) {
    const std::string ome =
        "<OME><Image><Pixels DimensionOrder=\"XYCZT\" SizeC=\"1\" SizeZ=\"3\" SizeT=\"1\" "
        "PhysicalSizeX=\"1\" PhysicalSizeXUnit=\"mm\" PhysicalSizeY=\"1500\" "
        "PhysicalSizeZ=\"2\" PhysicalSizeZUnit=\"mm\">"
        "<TiffData FirstZ=\"2\" IFD=\"0\"/><TiffData FirstZ=\"1\" IFD=\"1\"/>"
        "<TiffData FirstZ=\"0\" IFD=\"2\"/></Pixels></Image></OME>";
    const auto path = writeTiff("a.tif", hyperstack("CZT", {1, 3, 1}, ome));
    const Result<Volume> volume = loadVolume(path);
    ASSERT_LOADED(volume);
    expectNear(volume->geometry.spacingMm, {1.0, 1.5, 2.0});
    for (int z = 0; z < 3; ++z) {
        EXPECT_EQ(volume->valueAt({0, 0, z}), 20 - 10 * z);
    }
    EXPECT_TRUE(volume->notes.empty());
    const Result<Volume> flatless = loadVolume(writeTiff(
        "b.tif", hyperstack("CZT", {1, 3, 1},
                            "<OME><Pixels SizeZ=\"3\" PhysicalSizeX=\"500\" PhysicalSizeY=\"500\">"
                            "</Pixels></OME>")));
    ASSERT_LOADED(flatless);
    expectNear(flatless->geometry.spacingMm, {0.5, 0.5, 0.5});
    EXPECT_TRUE(says(*flatless, "states no distance of slices: 0.5 mm is assumed"));
    expectFailure(loadVolume(writeTiff("c.tif", hyperstack("CZT", {1, 2, 1},
                                                           "<OME><Pixels SizeZ=\"1\"></Pixels>"
                                                           "<Pixels SizeZ=\"1\"></Pixels></OME>"))),
                  ErrorCode::UnsupportedDims, "c.tif", "holds 2 images of OME");
}

TEST_F(TiffTest, resolutionsOfPrintAreNoVoxels) {
    struct Case {
        std::uint32_t perUnit;
        std::uint32_t unit;
        double mm;
        const char* note;
    };
    for (const Case& each :
         {Case{72, 2, 1.0, "states no voxel size but a resolution of 72 x 72 dots per inch"},
          Case{300, 2, 1.0,
               "300 x 300 dots per inch, as for print: 1 x 1 x 1 mm is assumed; "
               "--spacing X,Y,Z gives it"},
          Case{508, 2, 1.0, "508 x 508 dots per inch"},
          Case{100, 3, 0.1, "states no distance of slices: 1 mm is assumed; --spacing X,Y,Z"},
          Case{20, 3, 0.5, "no distance of slices"}, Case{1, 3, 1.0, "1 x 1 dots per cm"},
          Case{100, 1, 1.0, kNoSize}}) {
        SCOPED_TRACE(each.note);
        const std::map<int, Field> fields = {{282, {5, {each.perUnit, 1}, ""}},
                                             {283, {5, {each.perUnit, 1}, ""}},
                                             {296, shortField(each.unit)}};
        const Result<Volume> volume = loadVolume(writeTiff("a.tif", codePages(16, fields)));
        ASSERT_LOADED(volume);
        expectNear(volume->geometry.spacingMm, {each.mm, each.mm, 1.0});
        ASSERT_EQ(volume->notes.size(), 1U);
        EXPECT_TRUE(says(*volume, each.note)) << volume->notes.front();
    }
}

TEST_F(TiffTest, foldersGiveAllPagesOfAllFiles) {
    std::vector<TestPage> pages = codePages();
    writeTiff("part1.tif", {pages[0], pages[1]});
    writeTiff("part2.tif", {pages[2]});
    const Result<Volume> volume = loadVolume(folder_);
    ASSERT_LOADED(volume);
    expectCodes(*volume);
    writeTiff("part1.tif", {pages[0]});
    writeTiff("part2.tif", {pages[1], pages[2]});
    const Result<Volume> other = loadVolume(folder_);
    ASSERT_LOADED(other);
    expectCodes(*other);
}

TEST_F(TiffTest, colourTablesAreLeftOut) {
    const std::map<int, Field> palette = {{262, shortField(3)},
                                          {320, {3, std::vector<std::uint32_t>(768, 9), ""}}};
    const Result<Volume> volume = loadVolume(writeTiff("a.tif", codePages(8, palette)));
    ASSERT_LOADED(volume);
    expectCodes(*volume);
    EXPECT_TRUE(says(*volume, "table of colours"));
}

TEST_F(TiffTest, brokenFilesAreRefused) {
    std::vector<TestPage> pages = codePages();
    std::string circle = tiffOf(pages);
    circle.replace(circle.size() - 4, 4, circle.substr(4, 4));
    expectFailure(loadVolume(write("a.tif", circle)), ErrorCode::FileUnreadable, "a.tif", "circle");

    pages[1].fields[256] = {4, {1U << 30}, ""};
    expectFailure(loadVolume(writeTiff("a.tif", pages)), ErrorCode::FileTruncated, "a.tif",
                  "ends before its page 2 does; fetch it again");
    pages[1].fields[259] = shortField(8);
    pages[1].fields[257] = {4, {1U << 30}, ""};
    expectFailure(loadVolume(writeTiff("a.tif", pages)), ErrorCode::FileTruncated, "a.tif",
                  "page 2");
    pages = codePages();
    pages[2].fields[257] = {4, {0}, ""};
    expectFailure(loadVolume(writeTiff("a.tif", pages)), ErrorCode::EmptyVolume, "a.tif",
                  "page 3 has no pixels");
    pages = codePages();
    pages[2].fields[259] = shortField(8); // and are not
    expectFailure(loadVolume(writeTiff("a.tif", pages)), ErrorCode::FileTruncated, "a.tif",
                  "page 3 end early or are damaged; fetch");

    std::vector<TestPage> shared(
        400, {kDims.x, kDims.y, "", {{273, {4, {8}, ""}}, {279, {4, {20}, ""}}}});
    shared.front().pixels = std::string(20000, 'a'); // would be 400 times as large
    for (TestPage& page : shared) {
        page.width = 20000;
        page.height = 1;
        page.fields[279] = {4, {20000}, ""};
    }
    expectFailure(loadVolume(writeTiff("a.tif", shared)), ErrorCode::FileUnreadable, "a.tif",
                  "lie over one another");
}

/// Every cut and many changed bytes: refused or read, never worse. Within this program, so that its
/// checks see it.
TEST_F(TiffTest, anyCutAndAnyChangedByteIsSurvived) {
    const std::string whole = tiffOf(codePages(12, {}, {{270, textField("ImageJ=1\nimages=3\n")}}));
    for (std::size_t kept = 4; kept < whole.size(); kept += 3) {
        EXPECT_FALSE(readImagePages(write("a.tif", whole.substr(0, kept)), {})) << kept;
    }
    for (std::size_t i = 0; i < whole.size(); ++i) {
        for (const int change : {0x01, 0x80, 0xFF}) {
            std::string changed = whole;
            changed[i] = static_cast<char>(changed[i] ^ change);
            (void)readImagePages(write("a.tif", changed), {}).has_value();
        }
    }
}

} // namespace
} // namespace slabcast::test
