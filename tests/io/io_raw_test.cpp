#include "tests/support/io_test_support.h"

namespace slabcast::test {
namespace {

class RawTest : public IoTest {};

TEST_F(RawTest, layoutIsParsed) {
    const Result<RawLayout> layout = parseRawLayout("256x255x128,uint16,1x0.5x1.5,be");
    ASSERT_TRUE(layout) << layout.error().detail;
    EXPECT_EQ(layout->dims, glm::i64vec3(256, 255, 128));
    EXPECT_EQ(layout->type, VoxelType::U16);
    EXPECT_EQ(layout->spacingMm, glm::dvec3(1, 0.5, 1.5));
    EXPECT_TRUE(layout->bigEndian);
    EXPECT_FALSE(parseRawLayout("2x2x2,float,1x1x1")->bigEndian);
}

TEST_F(RawTest, wrongLayoutsAreNamed) {
    const std::vector<std::pair<const char*, ErrorCode>> cases = {
        {"", ErrorCode::InvalidArgument},
        {"2x2x2,uint8", ErrorCode::InvalidArgument},
        {"2x2x2,uint8,1x1x1,me", ErrorCode::InvalidArgument},
        {"2x2x2,uint8,1x1x1,le,le", ErrorCode::InvalidArgument},
        {"2x2xa,uint8,1x1x1", ErrorCode::InvalidArgument},
        {"2x2,uint8,1x1x1", ErrorCode::UnsupportedDims},
        {"2x2x2x2,uint8,1x1x1", ErrorCode::UnsupportedDims},
        {"2x0x2,uint8,1x1x1", ErrorCode::EmptyVolume},
        {"2x-2x2,uint8,1x1x1", ErrorCode::EmptyVolume},
        {"2x2x2,uint7,1x1x1", ErrorCode::UnsupportedType},
        {"2x2x2,uint8,1x0x1", ErrorCode::InvalidGeometry},
        {"2x2x2,uint8,1x-1x1", ErrorCode::InvalidGeometry},
        {"2x2x2,uint8,1xnanx1", ErrorCode::InvalidGeometry},
        {"2x2x2,uint8,1x1", ErrorCode::InvalidGeometry},
        {"4000000000x4000000000x4000000000,uint8,1x1x1", ErrorCode::SizeOverflow},
        {"2x2x99999999999999999999999,uint8,1x1x1", ErrorCode::SizeOverflow},
    };
    for (const auto& [text, code] : cases) {
        SCOPED_TRACE(text);
        const Result<RawLayout> layout = parseRawLayout(text);
        ASSERT_FALSE(layout);
        EXPECT_EQ(layout.error().code, code) << layout.error().detail;
        EXPECT_NE(layout.error().detail.find("expected DIMS,TYPE,SPACING"), std::string::npos);
    }
}

LoadOptions raw(std::string_view layout) {
    LoadOptions options;
    options.raw = *parseRawLayout(layout);
    return options;
}

TEST_F(RawTest, bothByteOrdersAreRead) {
    const Result<Volume> little =
        loadVolume(write("a.bin", codes<std::int32_t>()), raw("5x4x3,int32,1x2x3"));
    ASSERT_LOADED(little);
    EXPECT_EQ(little->type, VoxelType::I32);
    expectCodes(*little);
    expectGeometry(*little, {1, 2, 3}, {0, 0, 0});
    const Result<Volume> big =
        loadVolume(write("b.bin", codes<float>(kDims, true)), raw("5x4x3,float,1x2x3,be"));
    ASSERT_LOADED(big);
    expectCodes(*big);
}

TEST_F(RawTest, sizesThatDoNotMatchAreNamed) {
    const auto path = write("a.bin", codes<std::int16_t>());
    expectFailure(loadVolume(path, raw("5x4x4,int16,1x1x1")), ErrorCode::FileTruncated,
                  path.string(), "--raw");
    const LoadOptions less = raw("5x4x2,int16,1x1x1"); // 40 voxels of 60
    expectFailure(loadVolume(path, less), ErrorCode::FileUnreadable, path.string(),
                  "--skip-bytes 40");
    LoadOptions skipped = less;
    skipped.rawSkipBytes = 40;
    const Result<Volume> rest = loadVolume(path, skipped);
    ASSERT_LOADED(rest);
    EXPECT_EQ(rest->valueAt({0, 0, 0}), codeAt(0, 0, 1));
}

TEST_F(RawTest, pathsThatLeadNowhereAreNamed) {
    expectFailure(loadVolume(at("gone.nrrd")), ErrorCode::FileNotFound, "gone.nrrd",
                  "check the path");
    expectFailure(loadVolume(write("a.xyz", "text")), ErrorCode::UnsupportedType, "a.xyz", "--raw");
    expectFailure(loadVolume(folder_, raw("5x4x3,int16,1x1x1")), ErrorCode::FileUnreadable,
                  folder_.string(), "check");
}

TEST_F(RawTest, fileWithoutPermissionIsNamed) {
    if (geteuid() == 0) {
        GTEST_SKIP() << "root may read every file";
    }
    const auto path = write("a.nrrd", "NRRD0005\n");
    std::filesystem::permissions(path, std::filesystem::perms::none);
    expectFailure(loadVolume(path), ErrorCode::FileUnreadable, path.string(), "permissions");
}

} // namespace
} // namespace slabcast::test
