#include "core/scene/memory_forecast.h"
#include "core/scene/texel_format.h"

#include <cmath>
#include <limits>

#include "core/gl/program.h"
#include "core/gl/state_guard.h"
#include "core/scene/volume_texture.h"
#include "tests/support/gl_fixture.h"

namespace slabcast {

namespace {

constexpr double kAnyStep = std::numeric_limits<double>::infinity();

const TexelFormatTest& entry(const std::vector<TexelFormatTest>& tests, TexelFormat format) {
    return tests.at(static_cast<std::size_t>(format));
}

std::vector<TexelFormatTest> allUsable() {
    std::vector<TexelFormatTest> tests;
    for (int i = 0; i < 5; ++i) {
        tests.push_back({.format = static_cast<TexelFormat>(i), .usable = true});
    }
    return tests;
}

std::vector<TexelFormatTest> allBut(std::initializer_list<TexelFormat> broken) {
    std::vector<TexelFormatTest> tests = allUsable();
    for (const TexelFormat format : broken) {
        tests.at(static_cast<std::size_t>(format)).usable = false;
        tests.at(static_cast<std::size_t>(format)).reason = "broken here";
    }
    return tests;
}

/// Samples from 0 to 1 that a filter with `response` gives for weights 0 to 1.
template <class Response>
std::vector<FilterSample> ramp(Response response) {
    std::vector<FilterSample> samples;
    for (int i = 0; i <= 1000; ++i) {
        const double weight = i / 1000.0;
        samples.push_back(
            {.expected = weight, .measured = response(weight), .low = 0.0, .high = 1.0});
    }
    return samples;
}

constexpr FetchSample kGoodFetch[] = {{0.25, 0.25}};

constexpr std::int64_t kTwoBytes = 2; // per texel

gl::Caps capsWithLimit(std::int64_t edge) {
    gl::Caps caps;
    caps.maxTexture3DSize = edge;
    caps.maxTextureSize = edge;
    return caps;
}

} // namespace

TEST(JudgeTexelFormat, ExactFilterIsUsable) {
    const auto test =
        judgeTexelFormat(TexelFormat::R16, ramp([](double w) { return w; }), kGoodFetch);
    EXPECT_TRUE(test.usable) << test.reason;
    EXPECT_EQ(test.maxFilterError, 0.0);
}

TEST(JudgeTexelFormat, EightBitWeightsAreUsableAndMeasured) {
    const auto cutOff = [](double w) { return std::floor(w * 256.0) / 256.0; };
    const auto unorm = judgeTexelFormat(TexelFormat::R16, ramp(cutOff), kGoodFetch);
    EXPECT_TRUE(unorm.usable) << unorm.reason;
    EXPECT_GT(unorm.maxFilterError, 0.0035);
    EXPECT_LE(unorm.maxFilterError, 1.0 / 256.0);
}

TEST(JudgeTexelFormat, NearestIsNotUsableAndNamed) {
    const auto test = judgeTexelFormat(TexelFormat::R16,
                                       ramp([](double w) { return std::round(w); }), kGoodFetch);
    EXPECT_FALSE(test.usable);
    EXPECT_NE(test.reason.find("not filtered"), std::string::npos) << test.reason;
    EXPECT_NEAR(test.maxFilterError, 0.5, 0.001);
}

TEST(JudgeTexelFormat, ZeroCoarseAndNanAreNotUsable) {
    const auto zero = ramp([](double) { return 0.0; });
    const auto coarse = ramp([](double w) { return std::round(w * 16.0) / 16.0; });
    const auto nan = ramp([](double w) { return w > 0.5 ? NAN : w; });
    EXPECT_FALSE(judgeTexelFormat(TexelFormat::R16, zero, kGoodFetch).usable);
    EXPECT_FALSE(judgeTexelFormat(TexelFormat::R16, coarse, kGoodFetch).usable);
    EXPECT_FALSE(judgeTexelFormat(TexelFormat::R16, nan, kGoodFetch).usable);
    EXPECT_FALSE(judgeTexelFormat(TexelFormat::R16, {}, kGoodFetch).usable);
}

TEST(JudgeTexelFormat, SixteenBitTexelsFilteredToEightBitsAreNotUsable) {
    // Two close texels: an eight-bit result cannot tell what lies between them.
    const double low = 32704.0 / 65535.0;
    const double high = 32768.0 / 65535.0;
    std::vector<FilterSample> samples;
    for (int i = 0; i <= 64; ++i) {
        const double exact = low + (high - low) * i / 64.0;
        samples.push_back({exact, std::round(exact * 255.0) / 255.0, low, high, 1});
    }
    EXPECT_FALSE(judgeTexelFormat(TexelFormat::R16, samples, kGoodFetch).usable);
}

TEST(JudgeTexelFormat, WrongFetchIsNotUsable) {
    const FetchSample off[] = {{0.25, 0.25 + 1.0 / 255.0}};
    EXPECT_FALSE(judgeTexelFormat(TexelFormat::R8, ramp([](double w) { return w; }), off).usable);
    const FetchSample lost[] = {{1000.0, 1001.0}};
    EXPECT_FALSE(judgeTexelFormat(TexelFormat::Rg8Exact, {}, lost).usable);
    const FetchSample rounded[] = {{0.1, static_cast<double>(0.1F)}};
    EXPECT_FALSE(judgeTexelFormat(TexelFormat::R32fExact, {}, rounded).usable);
}

TEST(ChooseTexelFormat, FollowsTypeAndDevice) {
    struct Row {
        VoxelType type;
        bool exact;
        std::vector<TexelFormatTest> tests;
        TexelFormat expected;
    };
    using enum TexelFormat;
    const Row rows[] = {
        {VoxelType::U8, false, allUsable(), R8},
        {VoxelType::I8, false, allBut({R16, R16F}), R8},
        {VoxelType::I16, false, allUsable(), R16},
        {VoxelType::U16, false, allBut({R16}), R16F},
        {VoxelType::U16, false, allBut({R16, R16F}), Rg8Exact},
        {VoxelType::U16, false, {}, Rg8Exact},
        {VoxelType::F32, false, allUsable(), R16},
        {VoxelType::F64, false, allBut({R16}), R16F},
        {VoxelType::I32, false, allBut({R16, R16F}), R32fExact},
        {VoxelType::U8, true, allUsable(), Rg8Exact},
        {VoxelType::I16, true, allUsable(), Rg8Exact},
        {VoxelType::U32, true, allUsable(), R32fExact},
        {VoxelType::F32, true, allUsable(), R32fExact},
    };
    for (const Row& row : rows) {
        std::string reason;
        EXPECT_EQ(chooseTexelFormat(row.type, {}, row.exact, kAnyStep, row.tests, &reason),
                  row.expected)
            << name(row.type) << (row.exact ? " exact: " : ": ") << reason;
        EXPECT_FALSE(reason.empty());
        EXPECT_EQ(reason.find('\n'), std::string::npos);
    }
}

TEST(ChooseTexelFormat, ReasonNamesLossAndRejection) {
    VolumeStatistics statistics;
    statistics.min = -1.0;
    statistics.max = 1.0;
    std::string reason;
    chooseTexelFormat(VoxelType::F32, statistics, false, kAnyStep, allBut({TexelFormat::R16}),
                      &reason);
    EXPECT_NE(reason.find("0.000244"), std::string::npos) << reason; // 2 / 4096 / 2
    EXPECT_NE(reason.find("broken here"), std::string::npos) << reason;
    EXPECT_EQ(chooseTexelFormat(VoxelType::U8, statistics, false, kAnyStep, {}, nullptr),
              TexelFormat::R8);
}

TEST(VolumeMemory, ForecastCountsEveryCopy) {
    const auto forecast = forecastMemory({10, 20, 30}, VoxelType::I16, TexelFormat::R16F);
    ASSERT_TRUE(forecast.has_value());
    EXPECT_EQ(forecast->gpuTexelBytes, 12000);
    EXPECT_EQ(forecast->hostBytes(), 12000 + 12000); // texels take the place of voxels
    // Colours of four bytes on both sides, beside the scalars that they are made from.
    const auto classified = forecastMemory({10, 20, 30}, VoxelType::I16, TexelFormat::R16F,
                                           {.classification = Classification::Pre});
    ASSERT_TRUE(classified.has_value());
    EXPECT_EQ(classified->gpuTexelBytes, 24000);
    EXPECT_EQ(classified->hostBytes(), 12000 + 24000 + 6000); // codes of alpha have 8 bits
    // Normals beside the scalars.
    const auto lit = forecastMemory({10, 20, 30}, VoxelType::I16, TexelFormat::R16F,
                                    {.shaded = true, .normals = true});
    ASSERT_TRUE(lit.has_value());
    EXPECT_EQ(lit->gpuTexelBytes, 12000 + 24000);
    EXPECT_EQ(lit->hostBytes(), 12000 + 12000 + 24000);
    EXPECT_EQ(forecastTextureBytes({3, 5, 7}, TexelFormat::R8), 105);
    EXPECT_EQ(forecastTextureBytes({3, 5, 7}, TexelFormat::R32fExact), 420);
}

TEST(VolumeMemory, ForecastRefusesWhatCannotBeCounted) {
    const auto empty = forecastTextureBytes({4, 0, 4}, TexelFormat::R8);
    ASSERT_FALSE(empty.has_value());
    EXPECT_EQ(empty.error().code, ErrorCode::EmptyVolume);
    const auto huge = forecastTextureBytes(glm::ivec3(2147483647), TexelFormat::R8);
    ASSERT_FALSE(huge.has_value());
    EXPECT_EQ(huge.error().code, ErrorCode::SizeOverflow);
    // 2^62 texels can be counted, their bytes at four each cannot.
    const auto wide = forecastTextureBytes({1 << 21, 1 << 21, 1 << 20}, TexelFormat::R32fExact);
    ASSERT_FALSE(wide.has_value());
    EXPECT_EQ(wide.error().code, ErrorCode::SizeOverflow);
}

TEST(VolumeMemory, WhatIsUploadedIsWhatMustFit) {
    const Needs pre{.classification = Classification::Pre};
    EXPECT_EQ(uploadedBytesPerVoxel(TexelFormat::R8, {}), 1);
    EXPECT_EQ(uploadedBytesPerVoxel(TexelFormat::R16F, {}), 2);
    EXPECT_EQ(uploadedBytesPerVoxel(TexelFormat::R8, pre), 4);
    EXPECT_EQ(uploadedBytesPerVoxel(TexelFormat::R16F, pre), 4);
    EXPECT_EQ(uploadedBytesPerVoxel(TexelFormat::R8, {.normals = true}), 5);
}

TEST(VolumeMemory, LimitNamesSmallestDownsampling) {
    const gl::Caps caps = capsWithLimit(512);
    EXPECT_TRUE(checkFits(glm::ivec3(512), kTwoBytes, caps).has_value());
    const auto edge = checkFits({512, 1025, 10}, kTwoBytes, caps);
    ASSERT_FALSE(edge.has_value());
    EXPECT_EQ(edge.error().code, ErrorCode::VolumeTooLarge);
    EXPECT_NE(edge.error().detail.find("512 texels"), std::string::npos) << edge.error().detail;
    EXPECT_NE(edge.error().detail.find("--downsample 3"), std::string::npos) << edge.error().detail;
}

TEST(VolumeMemory, BudgetNamesSmallestDownsampling) {
    const gl::Caps caps = capsWithLimit(512);
    EXPECT_TRUE(checkFits(glm::ivec3(100), kTwoBytes, caps, 2000000).has_value());
    const auto budget = checkFits(glm::ivec3(100), kTwoBytes, caps, 1999999);
    ASSERT_FALSE(budget.has_value());
    EXPECT_NE(budget.error().detail.find("--downsample 2"), std::string::npos)
        << budget.error().detail;
    // 25^3 x 2 = 31,250 bytes: N = 4; one byte less asks for 20^3, N = 5.
    EXPECT_NE(
        checkFits(glm::ivec3(100), kTwoBytes, caps, 31250).error().detail.find("--downsample 4"),
        std::string::npos);
    EXPECT_NE(
        checkFits(glm::ivec3(100), kTwoBytes, caps, 31249).error().detail.find("--downsample 5"),
        std::string::npos);
    const auto none = checkFits(glm::ivec3(100), kTwoBytes, caps, 1);
    ASSERT_FALSE(none.has_value());
    EXPECT_EQ(none.error().detail.find("--downsample"), std::string::npos) << none.error().detail;
}

class TexelFormatGl : public GlTest {};

TEST_F(TexelFormatGl, SelfTestMeasuresEveryFormat) {
    const auto tests = selfTestTexelFormats(caps());
    ASSERT_EQ(tests.size(), 5U);
    for (const TexelFormatTest& test : tests) {
        const std::string prefix = std::string("texels_") + name(test.format) + "_";
        RecordProperty(prefix + "filter_error", std::to_string(test.maxFilterError));
        RecordProperty(prefix + "reason", test.reason);
        EXPECT_EQ(test.format, tests[static_cast<std::size_t>(test.format)].format);
        EXPECT_FALSE(test.reason.empty());
        if (test.format != TexelFormat::R16) { // core formats
            EXPECT_TRUE(test.usable) << name(test.format) << ": " << test.reason;
        }
        EXPECT_LE(test.maxFetchError, 1e-6) << name(test.format);
        EXPECT_LE(test.maxFilterError, 3.0 / 256.0 + 1.0 / 255.0) << name(test.format);
    }
    if (!caps().norm16) {
        EXPECT_FALSE(entry(tests, TexelFormat::R16).usable);
    }
    EXPECT_EQ(entry(tests, TexelFormat::R32fExact).maxFetchError, 0.0);
}

TEST_F(TexelFormatGl, SelfTestHonoursTheMask) {
    gl::Caps masked = caps();
    masked.norm16 = false;
    const auto tests = selfTestTexelFormats(masked);
    EXPECT_FALSE(entry(tests, TexelFormat::R16).usable);
    EXPECT_NE(entry(tests, TexelFormat::R16).reason.find("norm16"), std::string::npos);
}

// Mesa's software rasteriser, as measured by hand: 8-bit results between 8-bit texels, float texels
// exact.
TEST_F(TexelFormatGl, SoftwareDriverFiltersAsKnown) {
    const auto tests = selfTestTexelFormats(caps());
    if (caps().renderer.find("llvmpipe") == std::string::npos) {
        GTEST_SKIP() << "the renderer is " << caps().renderer;
    }
    EXPECT_GT(entry(tests, TexelFormat::R8).maxFilterError, 1.0 / 512.0);
    EXPECT_LT(entry(tests, TexelFormat::R16F).maxFilterError, 1e-6);
}

namespace {

constexpr const char* kVertexText = R"(#version 320 es
void main() {
    gl_Position = vec4(vec2((gl_VertexID << 1) & 2, gl_VertexID & 2) * 2.0 - 1.0, 0.0, 1.0);
}
)";

/// A fragment shader of `body`, which writes `result` for pixel i, with `sampler` as `data`.
std::string fragmentText(const std::string& sampler, const std::string& body) {
    return "#version 320 es\nprecision highp float;\nprecision highp int;\nuniform highp " +
           sampler + " data;\nout vec4 result;\nvoid main() {\n    int i = int(gl_FragCoord.x);\n" +
           body + "\n}\n";
}

/// Draws `count` pixels in a row and reads them.
std::vector<glm::vec4> drawRow(int count, const std::string& fragment, GLenum target,
                               GLuint texture) {
    const gl::StateGuard guard;
    auto program = gl::buildProgram("row", kVertexText, fragment);
    EXPECT_TRUE(program.has_value()) << program.error().detail;
    const gl::Texture row = gl::Texture::make("row", GL_TEXTURE_2D);
    const gl::Framebuffer framebuffer = gl::Framebuffer::make("row");
    const gl::VertexArray vertexArray = gl::VertexArray::make("row");
    gl::BindTexture(GL_TEXTURE_2D, row.id());
    gl::TexStorage2D(GL_TEXTURE_2D, 1, GL_RGBA32F, count, 1);
    gl::BindFramebuffer(GL_FRAMEBUFFER, framebuffer.id());
    gl::FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, row.id(), 0);
    gl::Viewport(0, 0, count, 1);
    gl::BindVertexArray(vertexArray.id());
    program->use();
    gl::BindTexture(target, texture);
    gl::DrawArrays(GL_TRIANGLES, 0, 3);
    std::vector<glm::vec4> pixels(static_cast<std::size_t>(count));
    gl::ReadPixels(0, 0, count, 1, GL_RGBA, GL_FLOAT, pixels.data());
    return pixels;
}

} // namespace

TEST_F(TexelFormatGl, UploadPutsEveryTexelInItsPlaceWhateverThePixelState) {
    // Odd extents, so that rows are not aligned; and pixel state as a host may have left it.
    Texels texels;
    texels.format = TexelFormat::R8;
    texels.dims = {5, 3, 2};
    texels.data.resize(30);
    for (std::size_t i = 0; i < texels.data.size(); ++i) {
        texels.data[i] = std::byte(100 + i);
    }
    gl::PixelStorei(GL_UNPACK_ROW_LENGTH, 11);
    gl::PixelStorei(GL_UNPACK_SKIP_ROWS, 2);
    gl::PixelStorei(GL_UNPACK_ALIGNMENT, 8);
    const auto texture = [&] {
        const gl::StateGuard guard; // the host's state is its caller's to keep
        return uploadTexels(texels, caps());
    }();
    GLint rowLength = 0;
    gl::GetIntegerv(GL_UNPACK_ROW_LENGTH, &rowLength);
    EXPECT_EQ(rowLength, 11);
    gl::PixelStorei(GL_UNPACK_ROW_LENGTH, 0);
    gl::PixelStorei(GL_UNPACK_SKIP_ROWS, 0);
    gl::PixelStorei(GL_UNPACK_ALIGNMENT, 4);
    ASSERT_TRUE(texture.has_value()) << texture.error().detail;
    const auto pixels = drawRow(
        30,
        fragmentText("sampler3D", "    float byte = texelFetch(data, ivec3(i % 5, (i / 5) % 3, i / "
                                  "15), 0).r * 255.0;\n    result = vec4(round(byte));"),
        GL_TEXTURE_3D, texture->id());
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        EXPECT_EQ(pixels[i].r, static_cast<float>(100 + i)) << i;
    }
}

TEST_F(TexelFormatGl, UploadInSeveralSlabsKeepsEverySlice) {
    // 2 MiB a slice: 16 MiB slabs hold eight, and the last slab of 20 slices is a short one.
    Texels texels;
    texels.format = TexelFormat::R8;
    texels.dims = {2048, 1024, 20};
    constexpr std::size_t kSlice = std::size_t{2048} * 1024;
    texels.data.resize(kSlice * 20);
    for (std::size_t i = 0; i < texels.data.size(); ++i) {
        texels.data[i] = std::byte(i / kSlice * 10);
    }
    const auto texture = uploadTexels(texels, caps());
    ASSERT_TRUE(texture.has_value()) << texture.error().detail;
    const auto pixels = drawRow(
        20, fragmentText("sampler3D", "    result = texelFetch(data, ivec3(2047, 1023, i), 0);"),
        GL_TEXTURE_3D, texture->id());
    for (std::size_t z = 0; z < pixels.size(); ++z) {
        EXPECT_NEAR(pixels[z].r * 255.0F, static_cast<float>(z * 10), 0.01) << z;
    }
}

TEST_F(TexelFormatGl, ClassifiedTexelsAreFilteredAndClamped) {
    const glm::u8vec4 texels[] = {{0, 10, 20, 30}, {200, 110, 60, 250}};
    const auto texture = uploadClassified(texels, {2, 1, 1}, caps());
    ASSERT_TRUE(texture.has_value()) << texture.error().detail;
    const auto pixels = drawRow(
        3, fragmentText("sampler3D", "    result = texture(data, vec3(float(i) * 0.5, 0.5, 0.5));"),
        GL_TEXTURE_3D, texture->id());
    const glm::vec4 expected[] = {{0, 10, 20, 30}, {100, 60, 40, 140}, {200, 110, 60, 250}};
    for (int i = 0; i < 3; ++i) {
        for (int channel = 0; channel < 4; ++channel) {
            EXPECT_NEAR(pixels[static_cast<std::size_t>(i)][channel] * 255.0F, expected[i][channel],
                        1.01F)
                << i << " " << channel;
        }
    }
}

TEST_F(TexelFormatGl, TableKeepsHalfFloatsAndIsNotFiltered) {
    const std::vector<glm::vec4> table = {{0.5F, 0.25F, 1.0F, 0.0F}, {1.0F, 0.75F, 0.0F, 2000.0F}};
    const auto texture = uploadTable(table, false, caps());
    ASSERT_TRUE(texture.has_value()) << texture.error().detail;
    const auto pixels =
        drawRow(3,
                fragmentText("sampler2D", "    result = i < 2 ? texelFetch(data, ivec2(i, 0), 0)\n"
                                          "                   : texture(data, vec2(0.4, 0.5));"),
                GL_TEXTURE_2D, texture->id());
    EXPECT_EQ(pixels[0], table[0]);
    EXPECT_EQ(pixels[1], table[1]);
    EXPECT_EQ(pixels[2], table[0]);
    const std::vector<glm::vec4> decades = {{0.1F, 0.2F, 0.3F, 1e-12F}, {0.0F, 0.0F, 0.0F, 1e4F}};
    const auto wide = uploadTable(decades, true, caps());
    ASSERT_TRUE(wide.has_value()) << wide.error().detail;
    const auto kept =
        drawRow(2, fragmentText("sampler2D", "    result = texelFetch(data, ivec2(i, 0), 0);"),
                GL_TEXTURE_2D, wide->id());
    EXPECT_EQ(kept[0], decades[0]);
    EXPECT_EQ(kept[1], decades[1]);
    EXPECT_EQ(uploadTable({}, false, caps()).error().code, ErrorCode::InvalidArgument);
}

TEST_F(TexelFormatGl, UploadRefusesWhatDoesNotFit) {
    gl::Caps small = caps();
    small.maxTexture3DSize = 16;
    const std::vector<glm::u8vec4> colours(17);
    const auto texture = uploadClassified(colours.data(), {17, 1, 1}, small);
    ASSERT_FALSE(texture.has_value());
    EXPECT_EQ(texture.error().code, ErrorCode::VolumeTooLarge);

    Texels texels;
    texels.format = TexelFormat::R16;
    texels.dims = {1, 1, 1};
    texels.data.resize(2);
    small.norm16 = false;
    EXPECT_EQ(uploadTexels(texels, small).error().code, ErrorCode::DeviceUnsupported);
}

} // namespace slabcast
