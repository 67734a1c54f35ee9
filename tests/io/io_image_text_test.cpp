// What file names and descriptions say: no files are needed.
#include "tests/support/io_test_support.h"

#include "platform/io/pictures/image_order.h"
#include "platform/io/pictures/image_statement.h"

namespace slabcast::test {
namespace {

using Names = std::vector<std::string>;

Names sorted(const Names& names) {
    std::vector<std::filesystem::path> files;
    for (const std::string& name : names) {
        files.emplace_back("folder/" + name);
    }
    sortByNames(files);
    Names result;
    for (const std::filesystem::path& file : files) {
        result.push_back(file.filename().string());
    }
    return result;
}

/// From the names in reverse, so that no order is right by chance.
void expectOrder(const Names& names) {
    EXPECT_EQ(sorted(Names(names.rbegin(), names.rend())), names);
}

TEST(ImageNames, numbersCountAndCapitalsDoNot) {
    expectOrder({"slice2.png", "slice10.png", "slice100.png"});
    expectOrder({"Slice0.PNG", "slice1.PNG", "Slice2.png", "slice3.PNG"});
    expectOrder({"IMG9.tif", "img09.TIF", "Img10.tif", "img11.tif"});
    expectOrder({"A.png", "a.png", "b.png"}); // a tie is broken by the bytes
    expectOrder({"a1b2.png", "a1b10.png", "a2b1.png"});
    expectOrder({"a.png", "a1.png", "a2.png"});
    expectOrder({"99999999999999999998.png", "99999999999999999999.png"});
}

TEST(ImageNames, signsCountWhereTheyAreSigns) {
    expectOrder({"z-02.png", "z-01.png", "z+00.png", "z+01.png"});
    expectOrder({"z-10.png", "z-2.png", "z0.png", "z3.png"});
    expectOrder({"-2.png", "-1.png", "0.png", "1.png"});
    expectOrder({"scan-01.png", "scan-02.png", "scan-10.png"}); // a hyphen
    expectOrder({"s-1_z-3.png", "s-1_z+4.png", "s-2_z-5.png", "s-2_z-4.png"});
    expectOrder({"a+1.png", "a+2.png"});
}

Result<void> series(const Names& names) {
    return checkOneSeries("folder", {names.begin(), names.end()});
}

TEST(ImageNames, oneSeriesIsAlikeButForItsNumbers) {
    for (const Names& names : {Names{"a1.png", "A02.PNG", "a3.png"}, Names{"left.png", "right.png"},
                               Names{"z-1.png", "z0.png", "z+1.png", "z+2.png"},
                               Names{"a1.tif", "a2.tiff", "a3.tif", "a4.tif"},
                               Names{"z1.png", "z1.5.png", "z2.png", "z2.5.png"},
                               Names{"0a.png", "0b.png", "1a.png", "1b.png"}, Names{"one.png"}}) {
        const Result<void> found = series(names);
        EXPECT_TRUE(found) << found.error().detail;
    }
    const Result<void> odd = series({"overview.png", "a1.png", "a2.png", "a3.png"});
    ASSERT_FALSE(odd);
    EXPECT_EQ(odd.error().detail,
              "overview.png: is named unlike the other images of its folder (a#.png, 3 of them); "
              "take away what does not belong to the stack");
    const Result<void> two = series({"a1.png", "a2.png", "a3.png", "b1.png", "b2.png", "b3.png"});
    ASSERT_FALSE(two);
    EXPECT_EQ(two.error().code, ErrorCode::AmbiguousSeries);
    EXPECT_EQ(two.error().detail,
              "folder: holds several series of images, a#.png (3 files) and b#.png (3 files); move "
              "all but one to folders of their own");
}

TEST(ImageTexts, imageJGivesLengthsInItsUnit) {
    const std::vector<std::pair<std::string, double>> units = {
        {"mm", 1.0},        {"cm", 10.0},        {"um", 1e-3},     {"micron", 1e-3},
        {"\\u00B5m", 1e-3}, {"\xC2\xB5m", 1e-3}, {"\xB5m", 1e-3},  {"\xCE\xBCm", 1e-3},
        {"nm", 1e-6},       {"inch", 25.4},      {"microns", 1e-3}};
    for (const auto& [unit, mm] : units) {
        const ImageStatement found = parseStatement(
            "ImageJ=1.53q\nimages=4\nslices=4\nunit=" + unit + "\nspacing=2.0\n", {4.0, 2.0});
        EXPECT_DOUBLE_EQ(found.lengthsMm[0], mm * 0.25) << unit;
        EXPECT_DOUBLE_EQ(found.lengthsMm[1], mm * 0.5) << unit;
        EXPECT_DOUBLE_EQ(found.lengthsMm[2], mm * 2.0) << unit;
        EXPECT_TRUE(found.notes.empty());
        EXPECT_EQ(found.images, 4);
    }
    EXPECT_DOUBLE_EQ(parseStatement("ImageJ=1\r\nunit=mm\r\n", {0.0, 0.0}).lengthsMm[2], 1.0);
    EXPECT_EQ(parseStatement("ImageJ=1\nunit=pixel\nspacing=1.0\n", {1.0, 1.0}).lengthsMm[0], 0.0);
    const ImageStatement bare = parseStatement("ImageJ=1\nspacing=2.5\n", {0.0, 0.0});
    EXPECT_TRUE(bare.isWithoutUnit);
    EXPECT_DOUBLE_EQ(bare.lengthsMm[2], 2.5);
    const ImageStatement furlongs = parseStatement("ImageJ=1\nunit=furlong\n", {1.0, 1.0});
    EXPECT_EQ(furlongs.lengthsMm[0], 0.0);
    EXPECT_EQ(furlongs.notes, Names{"its unit of length 'furlong' is not known"});
}

TEST(ImageTexts, imageJGivesStraightLinesOfValues) {
    const ImageStatement line =
        parseStatement("ImageJ=1\ncf=0\nc0=-1000.5\nc1=0.5\nvunit=HU\n", {});
    EXPECT_EQ(line.slope, 0.5);
    EXPECT_EQ(line.intercept, -1000.5);
    EXPECT_EQ(line.unit, "HU");
    const ImageStatement curve = parseStatement("ImageJ=1\ncf=3\nc0=1\nc1=2\nc2=3\n", {});
    EXPECT_EQ(curve.slope, 1.0);
    ASSERT_EQ(curve.notes.size(), 1U);
    EXPECT_NE(curve.notes[0].find("calibration"), std::string::npos);
    EXPECT_EQ(parseStatement("ImageJ=1\ncf=0\nc0=nan\nc1=1\n", {}).intercept, 0.0);
    EXPECT_EQ(parseStatement("ImageJ=1\ncf=0\nc0=1\nc1=0\n", {}).slope, 1.0);
}

TEST(ImageTexts, omeGivesLengthsAndOrder) {
    const ImageStatement found = parseStatement(
        "<?xml version=\"1.0\"?><!-- x --><OME><Image><Pixels DimensionOrder='XYZTC' SizeC = \"2\" "
        "SizeZ=\"3\" SizeT=\"4\" PhysicalSizeX=\"0.5\" PhysicalSizeY=\"1.5\" "
        "PhysicalSizeYUnit=\"nm\" PhysicalSizeZ=\"2\" PhysicalSizeZUnit=\"mm\">"
        "<TiffData FirstC=\"1\" FirstZ=\"2\" FirstT=\"3\" IFD=\"5\"/></Pixels></Image></OME>",
        {});
    EXPECT_EQ(found.program, ImageStatement::Program::Ome);
    EXPECT_EQ(found.order, "ZTC");
    EXPECT_EQ(found.channels, 2);
    EXPECT_EQ(found.slices, 3);
    EXPECT_EQ(found.frames, 4);
    EXPECT_DOUBLE_EQ(found.lengthsMm[0], 0.5e-3); // micrometres, where no unit is given
    EXPECT_DOUBLE_EQ(found.lengthsMm[1], 1.5e-6);
    EXPECT_DOUBLE_EQ(found.lengthsMm[2], 2.0);
    ASSERT_EQ(found.places.size(), 1U);
    EXPECT_EQ(found.places[0].page, 5);
    EXPECT_EQ(found.places[0].count, 1);
    EXPECT_EQ(found.volumes, 1);
}

TEST(ImageTexts, brokenTextsSayNothing) {
    for (const char* text :
         {"", "ImageJ", "<", "<OME", "<OME><Pixels", "<OME><Pixels SizeZ=", "<OME><Pixels SizeZ=\"",
          "<OME><Pixels SizeZ=\"4", "<OME><Pixels SizeZ=\"-4\" PhysicalSizeX=\"inf\"/>",
          "<OME><Pixels SizeC=\"0\" SizeT=\"nan\"/>", "<OME Pixels=\"3\"/>",
          "ImageJ=1\nimages=-3\nchannels=0\nframes=x\nspacing=nan\nunit=pixel\n",
          "{\"shape\": [3]}"}) {
        const ImageStatement found = parseStatement(text, {});
        EXPECT_EQ(found.channels, 1) << text;
        EXPECT_EQ(found.frames, 1) << text;
        EXPECT_EQ(found.lengthsMm[0], 0.0) << text;
        EXPECT_EQ(found.slope, 1.0) << text;
    }
}

} // namespace
} // namespace slabcast::test
