#include "tests/support/dicom_test_support.h"

namespace slabcast::test {
namespace {

class DicomStackTest : public DicomFilesTest {
protected:
    /// Slices whose every pixel holds their height.
    void writeAt(const std::vector<double>& heights) const {
        for (std::size_t i = 0; i < heights.size(); ++i) {
            DicomElements elements = image(
                bytesOf(std::vector<std::int16_t>(20, static_cast<std::int16_t>(heights[i]))));
            place(elements, {0, 0, heights[i]});
            writeDicom(std::to_string(i) + ".dcm", elements);
        }
    }
};

TEST_F(DicomStackTest, missingSliceIsNamed) {
    writeAt({0, 3, 9, 12});
    for (const char* part :
         {"1.dcm", "2.dcm", "6 mm where 3 mm", "a slice is missing", "--resample"}) {
        expectFailure(loadVolume(folder_), ErrorCode::InvalidGeometry, folder_.string(), part);
    }
}

TEST_F(DicomStackTest, changeOfDistanceIsNamed) {
    writeAt({0, 4, 8, 15, 22});
    expectFailure(loadVolume(folder_), ErrorCode::InvalidGeometry, folder_.string(),
                  "4 mm up to 2.dcm, 7 mm from there on");
}

TEST_F(DicomStackTest, unevenSlicesAreResampledOnDemand) {
    writeAt({0, 4, 8, 15, 22});
    LoadOptions options;
    options.resampleUneven = true;
    const Result<Volume> volume = loadVolume(folder_, options);
    ASSERT_LOADED(volume);
    ASSERT_EQ(volume->geometry.dims, glm::ivec3(5, 4, 6));
    expectGeometry(*volume, {0.5, 2, 4}, {0, 0, 0});
    for (int z = 0; z < 6; ++z) {
        EXPECT_EQ(volume->valueAt({1, 1, z}), 4 * z); // as high as it lies
    }
    EXPECT_EQ(volume->notes.size(), 1u);
}

TEST_F(DicomStackTest, roundedPlacesAreEven) {
    writeAt({0, 3, 6, 9});
    DicomElements elements = slice(1);
    place(elements, {0, 0, 3.1});
    writeDicom("1.dcm", elements);
    ASSERT_LOADED(loadVolume(folder_));
}

TEST_F(DicomStackTest, stepAsideIsNamed) {
    writeAt({0, 3, 6, 9});
    for (int i = 2; i < 4; ++i) {
        DicomElements elements = slice(0);
        place(elements, {20, 0, 3.0 * i});
        writeDicom(std::to_string(i) + ".dcm", elements);
    }
    expectFailure(loadVolume(folder_), ErrorCode::InvalidGeometry, "2.dcm", "20 mm aside");
}

TEST_F(DicomStackTest, oddOneOutIsNamed) {
    writeSlices([](DicomElements&, int) {});
    DicomElements wide = image(std::string(2 * 9 * 8, '\0'));
    place(wide.word(0x00280010, 8).word(0x00280011, 9), {0, 0, -40}, "-1\\0\\0\\0\\0\\-1");
    writeDicom("00_scout.dcm", wide);
    expectFailure(loadVolume(folder_), ErrorCode::InvalidGeometry, "00_scout.dcm",
                  "9 x 8 pixels where most have 5 x 4");
    DicomElements turned = slice(0);
    place(turned, {0, 0, -40}, "0\\1\\0\\-1\\0\\0");
    writeDicom("00_scout.dcm", turned);
    expectFailure(loadVolume(folder_), ErrorCode::InvalidGeometry, "00_scout.dcm", "orientation");
    writeDicom("00_scout.dcm", turned.text(0x00080008, "CS", "ORIGINAL\\LOCALIZER"));
    writeSlices(
        [](DicomElements& elements, int) { elements.text(0x00080008, "CS", "ORIGINAL\\AXIAL"); });
    expectFailure(loadVolume(folder_), ErrorCode::InvalidGeometry, "00_scout.dcm",
                  "--select 'ImageType=ORIGINAL\\AXIAL'");
    LoadOptions options;
    options.select = {{"ImageType", "ORIGINAL\\AXIAL"}};
    ASSERT_LOADED(loadVolume(folder_, options));
}

TEST_F(DicomStackTest, missingPlaceIsNamed) {
    writeSlices([](DicomElements& elements, int) { elements.without(0x00200032); });
    expectFailure(loadVolume(folder_), ErrorCode::InvalidGeometry, folder_.string(),
                  "ImagePositionPatient is missing");
    LoadOptions options;
    options.spacingMm = glm::dvec3(0.5, 2, 3);
    const Result<Volume> volume = loadVolume(folder_, options); // the remedy that the line names
    ASSERT_LOADED(volume);
    expectCodes(*volume);
    expectGeometry(*volume, {0.5, 2, 3}, {0, 0, 0});
    writeSlices([](DicomElements& elements, int z) {
        if (z == 1) {
            elements.without(0x00200032);
        }
    });
    expectFailure(loadVolume(folder_), ErrorCode::InvalidGeometry, folder_.string(), "1.dcm");
}

} // namespace
} // namespace slabcast::test
