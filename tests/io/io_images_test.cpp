#include "tests/support/io_test_support.h"

#include <OpenImageIO/imageio.h>

namespace slabcast::test {
namespace {

using OIIO::TypeDesc;

template <class T>
std::vector<T> pageOf(int z, glm::ivec3 dims = kDims) {
    std::vector<T> page;
    for (int y = 0; y < dims.y; ++y) {
        for (int x = 0; x < dims.x; ++x) {
            page.push_back(static_cast<T>(codeAt(x, y, z)));
        }
    }
    return page;
}

class ImagesTest : public IoTest {
protected:
    template <class T>
    std::filesystem::path writePage(const std::string& name, int z, TypeDesc type,
                                    int width = kDims.x) const {
        const OIIO::ImageSpec spec(width, kDims.y, 1, type);
        const auto file = OIIO::ImageOutput::create(at(name).string());
        EXPECT_TRUE(file && file->open(at(name).string(), spec));
        file->write_image(type, pageOf<T>(z, {width, kDims.y, 1}).data());
        file->close();
        return at(name);
    }

    template <class T>
    std::filesystem::path writePages(const std::string& name, TypeDesc type,
                                     int lastWidth = kDims.x,
                                     const char* resolutionUnit = "") const {
        std::vector<OIIO::ImageSpec> specs(3, OIIO::ImageSpec(kDims.x, kDims.y, 1, type));
        specs[2].width = specs[2].full_width = lastWidth;
        for (OIIO::ImageSpec& spec : specs) {
            spec.attribute("compression", "none");
            if (*resolutionUnit != '\0') {
                spec.attribute("XResolution", 50.0F);
                spec.attribute("YResolution", 25.0F);
                spec.attribute("PixelAspectRatio", 0.5F); // the writer lets it overrule YResolution
                spec.attribute("ResolutionUnit", resolutionUnit);
            }
        }
        const auto file = OIIO::ImageOutput::create(at(name).string());
        EXPECT_TRUE(file && file->open(at(name).string(), 3, specs.data()));
        for (int z = 0; z < 3; ++z) {
            if (z > 0) {
                file->open(at(name).string(), specs[z], OIIO::ImageOutput::AppendSubimage);
            }
            file->write_image(type, pageOf<T>(z, {specs[z].width, kDims.y, 1}).data());
        }
        file->close();
        return at(name);
    }

    template <class T>
    void expectPages(TypeDesc type, VoxelType expected) const {
        const Result<Volume> volume = loadVolume(writePages<T>("a.tif", type));
        ASSERT_LOADED(volume);
        EXPECT_EQ(volume->type, expected);
        expectCodes(*volume);
        expectGeometry(*volume, {1, 1, 1}, {0, 0, 0});
    }
};

TEST_F(ImagesTest, pagesKeepTheirType) {
    expectPages<std::uint8_t>(TypeDesc::UINT8, VoxelType::U8);
    expectPages<std::int8_t>(TypeDesc::INT8, VoxelType::I8);
    expectPages<std::uint16_t>(TypeDesc::UINT16, VoxelType::U16);
    expectPages<std::int16_t>(TypeDesc::INT16, VoxelType::I16);
    expectPages<std::uint32_t>(TypeDesc::UINT32, VoxelType::U32);
    expectPages<std::int32_t>(TypeDesc::INT32, VoxelType::I32);
    expectPages<float>(TypeDesc::FLOAT, VoxelType::F32);
    expectPages<double>(TypeDesc::DOUBLE, VoxelType::F64);
}

TEST_F(ImagesTest, resolutionTagsGiveTheSpacingInThePlane) {
    const Result<Volume> inch =
        loadVolume(writePages<float>("a.tif", TypeDesc::FLOAT, kDims.x, "in"));
    ASSERT_LOADED(inch);
    expectGeometry(*inch, {1, 1, 1}, {0, 0, 0}); // as for print
    EXPECT_EQ(inch->notes.size(), 1U);
    const Result<Volume> centimetre =
        loadVolume(writePages<float>("b.tif", TypeDesc::FLOAT, kDims.x, "cm"));
    ASSERT_LOADED(centimetre);
    expectGeometry(*centimetre, {10.0 / 50, 10.0 / 25, 1}, {0, 0, 0});
}

TEST_F(ImagesTest, stackIsSortedNaturally) {
    writePage<std::uint16_t>("slice2.png", 0, TypeDesc::UINT16);
    writePage<std::uint16_t>("slice10.png", 1, TypeDesc::UINT16);
    writePage<std::uint16_t>("slice100.png", 2, TypeDesc::UINT16);
    write("notes.txt", "not a slice");
    const Result<Volume> volume = loadVolume(folder_);
    ASSERT_LOADED(volume);
    EXPECT_EQ(volume->type, VoxelType::U16);
    EXPECT_EQ(volume->name, folder_.filename().string());
    expectCodes(*volume);
    ASSERT_LOADED(loadVolume(folder_ / ""));
}

TEST_F(ImagesTest, tiffStackIsRead) {
    for (int z = 0; z < 3; ++z) {
        writePage<float>(std::to_string(z) + ".tiff", z, TypeDesc::FLOAT);
    }
    const Result<Volume> volume = loadVolume(folder_);
    ASSERT_LOADED(volume);
    expectCodes(*volume);
}

TEST_F(ImagesTest, slicesThatFormNoVolumeAreNamed) {
    writePage<std::uint8_t>("a1.png", 0, TypeDesc::UINT8);
    writePage<std::uint8_t>("a2.png", 1, TypeDesc::UINT8, 6);
    expectFailure(loadVolume(folder_), ErrorCode::InvalidGeometry, "a2.png", "take away");
    writePage<std::uint16_t>("a2.png", 1, TypeDesc::UINT16);
    expectFailure(loadVolume(folder_), ErrorCode::InvalidGeometry, "a2.png", "take away");
    write("a2.png", "no image");
    expectFailure(loadVolume(folder_), ErrorCode::FileUnreadable, "a2.png", "check");
    expectFailure(loadVolume(writePages<float>("wide.tif", TypeDesc::FLOAT, 6)),
                  ErrorCode::InvalidGeometry, "wide.tif", "take away");
}

TEST_F(ImagesTest, colourAndFlatImagesAreNamed) {
    const OIIO::ImageSpec spec(4, 4, 3, TypeDesc::UINT8);
    const std::vector<std::uint8_t> pixels(48);
    for (const char* name : {"a1.png", "a2.png"}) {
        const auto file = OIIO::ImageOutput::create("png");
        file->open(at(name).string(), spec);
        file->write_image(TypeDesc::UINT8, pixels.data());
        file->close();
    }
    expectFailure(loadVolume(folder_), ErrorCode::UnsupportedType, "a1.png", "grey");
    expectFailure(loadVolume(writePage<float>("flat.tif", 0, TypeDesc::FLOAT)),
                  ErrorCode::UnsupportedDims, "flat.tif", "folder");
}

TEST_F(ImagesTest, truncatedFilesAreNamed) {
    const auto path = writePages<double>("a.tif", TypeDesc::DOUBLE);
    const std::uintmax_t size = std::filesystem::file_size(path);
    for (const std::uintmax_t kept :
         {size - 8, size * 3 / 4, size / 2, size / 4, std::uintmax_t{20}}) {
        SCOPED_TRACE(kept);
        truncate(path, kept);
        expectFailure(loadVolume(path), ErrorCode::FileTruncated, "a.tif", "fetch");
    }
    expectFailure(loadVolume(write("a.tif", "")), ErrorCode::FileUnreadable, "a.tif", "check");
    const auto png = writePage<std::uint16_t>("z1.png", 0, TypeDesc::UINT16, 64);
    writePage<std::uint16_t>("z2.png", 0, TypeDesc::UINT16, 64);
    std::filesystem::remove(path);
    truncate(png, std::filesystem::file_size(png) - 30); // the end mark and some pixels
    expectFailure(loadVolume(folder_), ErrorCode::FileTruncated, "z1.png", "fetch");
}

/// As a printer's program would write it: 8 bits, with a resolution.
void writeJpeg(const std::filesystem::path& path, int size, const char* unit = "",
               float resolution = 0.0F) {
    OIIO::ImageSpec spec(size, size, 1, TypeDesc::UINT8);
    spec.attribute("XResolution", resolution);
    spec.attribute("YResolution", resolution);
    spec.attribute("ResolutionUnit", unit);
    std::vector<std::uint8_t> pixels;
    for (int i = 0; i < size * size; ++i) {
        pixels.push_back(static_cast<std::uint8_t>(i * 7919 % 251));
    }
    const auto file = OIIO::ImageOutput::create(path.string());
    ASSERT_TRUE(file && file->open(path.string(), spec));
    ASSERT_TRUE(file->write_image(TypeDesc::UINT8, pixels.data()));
    file->close();
}

std::string contentOf(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

TEST_F(ImagesTest, cutJpegsAreNamed) {
    for (const char* name : {"s0.jpg", "s1.jpg", "s2.jpg"}) {
        writeJpeg(at(name), 64);
    }
    ASSERT_LOADED(loadVolume(folder_));
    const std::string whole = contentOf(at("s2.jpg"));
    write("s2.jpg", whole + std::string(100, '\0')); // what follows the end does not matter
    ASSERT_LOADED(loadVolume(folder_));
    for (const int percent : {20, 60, 99}) {
        for (const int zeros : {0, 500}) { // the rest of a copy that was made room for
            SCOPED_TRACE(percent);
            write("s2.jpg",
                  whole.substr(0, whole.size() * percent / 100) + std::string(zeros, '\0'));
            expectFailure(loadVolume(folder_), ErrorCode::FileTruncated, "s2.jpg",
                          "was cut off; fetch it again");
        }
    }
}

TEST_F(ImagesTest, jpegsThatLackAPartAreNamed) {
    for (const char* name : {"s0.jpg", "s1.jpg"}) {
        writeJpeg(at(name), 64);
    }
    const std::string whole = contentOf(at("s1.jpg"));
    const std::string begin = whole.substr(0, whole.size() * 6 / 10);
    for (const std::string& rest : {std::string("\xFF\xD9"), whole.substr(whole.size() * 8 / 10)}) {
        write("s1.jpg", begin + rest);
        expectFailure(loadVolume(folder_), ErrorCode::FileTruncated, "s1.jpg",
                      "end early or are damaged; fetch the file again");
    }
}

TEST_F(ImagesTest, cutPngsAreNamed) {
    writePage<std::uint16_t>("s0.png", 0, TypeDesc::UINT16, 64);
    const auto path = writePage<std::uint16_t>("s1.png", 1, TypeDesc::UINT16, 64);
    const std::string whole = contentOf(path);
    for (const std::size_t kept : {whole.size() - 1, whole.size() - 12, whole.size() / 2,
                                   whole.size() / 4, std::size_t{20}}) {
        write("s1.png", whole.substr(0, kept));
        expectFailure(loadVolume(folder_), ErrorCode::FileTruncated, "s1.png", "fetch");
    }
}

TEST_F(ImagesTest, resolutionsOfPrintAreNoVoxels) {
    writeJpeg(at("s0.jpg"), 8, "in", 300.0F);
    writeJpeg(at("s1.jpg"), 8, "in", 300.0F);
    const Result<Volume> volume = loadVolume(folder_);
    ASSERT_LOADED(volume);
    expectNear(volume->geometry.spacingMm, {1, 1, 1});
    ASSERT_EQ(volume->notes.size(), 1U);
    EXPECT_NE(volume->notes[0].find("300 x 300 dots per inch"), std::string::npos);
    const Result<Volume> given = loadVolume(folder_, {.spacingMm = glm::dvec3(1, 2, 3)});
    ASSERT_LOADED(given);
    EXPECT_TRUE(given->notes.empty());
}

TEST_F(ImagesTest, greyOfFewerValuesIsReadAsStored) {
    for (int z = 0; z < 2; ++z) {
        std::string pixels;
        for (int i = 0; i < 8; ++i) {
            const int value = 512 * i + z; // of 12 bits
            pixels += {static_cast<char>(value >> 8), static_cast<char>(value)};
        }
        write("s" + std::to_string(z) + ".pgm", "P5\n# by hand\n4 2\n4095\n" + pixels);
    }
    const Result<Volume> volume = loadVolume(folder_);
    ASSERT_LOADED(volume);
    for (int i = 0; i < 8; ++i) {
        EXPECT_EQ(volume->valueAt({i % 4, i / 4, 1}), 512 * i + 1);
    }
}

TEST_F(ImagesTest, theOddOneOfAFolderIsNamed) {
    writePage<std::uint8_t>("a1.png", 0, TypeDesc::UINT8, 6);
    for (const char* name : {"a2.png", "a3.png", "a4.png"}) {
        writePage<std::uint8_t>(name, 1, TypeDesc::UINT8);
    }
    expectFailure(loadVolume(folder_), ErrorCode::InvalidGeometry, "a1.png: 6 x 4 pixels",
                  "take away");
    std::filesystem::rename(at("a1.png"), at("overview.png"));
    expectFailure(loadVolume(folder_), ErrorCode::AmbiguousSeries, "overview.png", "take away");
}

} // namespace
} // namespace slabcast::test
