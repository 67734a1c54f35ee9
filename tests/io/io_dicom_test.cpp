#include "tests/support/dicom_test_support.h"

namespace slabcast::test {
namespace {

class DicomTest : public DicomFilesTest {};

TEST_F(DicomTest, seriesIsStackedInOrderOfPlace) {
    for (int z = 0; z < kDims.z; ++z) { // named against their order
        writeDicom(std::to_string(9 - z) + ".dcm", slice(z));
    }
    const Result<Volume> volume = loadVolume(folder_);
    ASSERT_LOADED(volume);
    EXPECT_EQ(volume->type, VoxelType::I16);
    EXPECT_EQ(volume->modality, Modality::Ct);
    EXPECT_EQ(volume->unit, "HU");
    EXPECT_EQ(volume->name, folder_.filename().string());
    EXPECT_TRUE(volume->notes.empty());
    expectCodes(*volume);
    expectGeometry(*volume, {0.5, 2, 3}, {10, -20, 30});
}

TEST_F(DicomTest, rescalingIsAppliedOnce) {
    writeSlices([](DicomElements& elements, int) {
        elements.text(0x00080060, "CS", "MR")
            .text(0x00281052, "DS", "-1024")
            .text(0x00281053, "DS", "1");
    });
    const Result<Volume> volume = loadVolume(folder_);
    ASSERT_LOADED(volume);
    EXPECT_EQ(volume->type, VoxelType::I16);
    EXPECT_EQ(volume->valueAt({0, 0, 0}), -1024);
    EXPECT_EQ(volume->valueAt({4, 3, 2}), codeAt(4, 3, 2) - 1024);
    EXPECT_EQ(volume->modality, Modality::Mr);
    EXPECT_EQ(volume->unit, "");
}

TEST_F(DicomTest, obliqueSlicesAreHonoured) {
    writeSlices([](DicomElements& elements, int z) { // sagittal: rows to the back, columns down
        place(elements, {10 - 3.0 * z, -20, 30}, "0\\1\\0\\0\\0\\-1");
    });
    const Result<Volume> volume = loadVolume(folder_);
    ASSERT_LOADED(volume);
    expectCodes(*volume);
    expectGeometry(*volume, {0.5, 2, 3}, {10, -20, 30}, glm::dmat3(0, 1, 0, 0, 0, -1, -1, 0, 0));
}

TEST_F(DicomTest, tiltedGantryShearsTheBox) {
    writeSlices([](DicomElements& elements, int z) { // 3 mm up, 4 mm back: slices 5 mm apart
        place(elements, {10, -20 + 4.0 * z, 30 + 3.0 * z});
    });
    const Result<Volume> volume = loadVolume(folder_);
    ASSERT_LOADED(volume);
    expectCodes(*volume);
    expectGeometry(*volume, {0.5, 2, 5}, {10, -20, 30}, glm::dmat3(1, 0, 0, 0, 1, 0, 0, 0.8, 0.6));
}

TEST_F(DicomTest, anyClassIsRead) {
    for (const char* sopClass : {"1.3.46.670589.5.0.1", "1.2.840.10008.5.1.4.1.1.12.1"}) {
        writeSlices(
            [&](DicomElements& elements, int) { elements.text(0x00080016, "UI", sopClass); });
        const Result<Volume> volume = loadVolume(folder_);
        ASSERT_LOADED(volume);
        expectCodes(*volume);
        expectGeometry(*volume, {0.5, 2, 3}, {10, -20, 30});
    }
}

TEST_F(DicomTest, spacingThatIsNoNumberIsRefused) {
    writeSlices([](DicomElements& elements, int) { elements.text(0x00280030, "DS", "2,0\\0,5"); });
    expectFailure(loadVolume(folder_), ErrorCode::InvalidGeometry, "0.dcm",
                  "PixelSpacing is '2,0\\0,5'");
    LoadOptions options;
    options.spacingMm = glm::dvec3(0.5, 2, 3);
    const Result<Volume> volume = loadVolume(folder_, options); // the remedy that the line names
    ASSERT_LOADED(volume);
    expectGeometry(*volume, {0.5, 2, 3}, {10, -20, 30});
}

TEST_F(DicomTest, detectorsSpacingIsTakenWithANote) {
    writeSlices([](DicomElements& elements, int) {
        elements.without(0x00280030).text(0x00181164, "DS", "2\\0.5");
    });
    const Result<Volume> volume = loadVolume(folder_);
    ASSERT_LOADED(volume);
    expectGeometry(*volume, {0.5, 2, 3}, {10, -20, 30});
    ASSERT_EQ(volume->notes.size(), 1u);
    EXPECT_NE(volume->notes[0].find("ImagerPixelSpacing"), std::string::npos);
}

TEST_F(DicomTest, enhancedFramesAreSortedByPlace) {
    const std::string all = codes<std::int16_t>();
    const std::size_t size = all.size() / 3;
    const std::string pixels = all.substr(0, size) + all.substr(2 * size) + all.substr(size, size);
    const auto path = writeDicom("a.dcm", enhanced(pixels, {30, 36.002, 32.999}));
    const Result<Volume> volume = loadVolume(path);
    ASSERT_LOADED(volume);
    expectCodes(*volume);
    expectNear(volume->geometry.spacingMm, {0.5, 2, 3.001});
    EXPECT_EQ(volume->modality, Modality::Mr);
    EXPECT_EQ(volume->name, "a.dcm");
}

TEST_F(DicomTest, dosePlanesLieAtTheirOffsets) {
    const auto dose = [&](const std::string& offsets) {
        DicomElements elements = image(codes<std::uint32_t>(), 3);
        place(elements, {10, -20, 30});
        return elements.text(0x00080016, "UI", kDose)
            .text(0x00080060, "CS", "RTDOSE")
            .word(0x00280100, 32)
            .word(0x00280101, 32)
            .word(0x00280102, 31)
            .word(0x00280103, 0)
            .text(0x30040002, "CS", "GY")
            .text(0x3004000e, "DS", "0.5")
            .text(0x3004000c, "DS", offsets);
    };
    for (const char* offsets : {"0\\3\\6", "30\\33\\36"}) {
        const Result<Volume> volume = loadVolume(writeDicom("dose.dcm", dose(offsets)));
        ASSERT_LOADED(volume);
        EXPECT_EQ(volume->unit, "Gy");
        EXPECT_EQ(volume->valueAt({4, 3, 2}), 0.5 * codeAt(4, 3, 2));
        expectGeometry(*volume, {0.5, 2, 3}, {10, -20, 30});
    }
    const auto uneven = writeDicom("dose.dcm", dose("0\\3\\9"));
    expectFailure(loadVolume(uneven), ErrorCode::InvalidGeometry, "dose.dcm",
                  "6 mm where 3 mm are usual");
}

TEST_F(DicomTest, framesOverTimeAreNoSlices) {
    DicomElements film = image(codes<std::int16_t>(), 3);
    film.text(0x00181063, "DS", "33.3").text(0x00180050, "DS", "5");
    expectFailure(loadVolume(writeDicom("film.dcm", film)), ErrorCode::InvalidGeometry, "film.dcm",
                  "time");
    const DicomElements captures = image(codes<std::int16_t>(), 3);
    const auto path = writeDicom("captures.dcm", captures);
    expectFailure(loadVolume(path), ErrorCode::InvalidGeometry, "captures.dcm",
                  "ImagePositionPatient is missing");
    LoadOptions options;
    options.spacingMm = glm::dvec3(1, 1, 2);
    const Result<Volume> volume = loadVolume(path, options);
    ASSERT_LOADED(volume);
    expectCodes(*volume);
    EXPECT_FALSE(volume->notes.empty());
}

TEST_F(DicomTest, framesAtOneDistanceAreStackedWithANote) {
    DicomElements frames = image(codes<std::int16_t>(), 3);
    place(frames, {10, -20, 30}).text(0x00180088, "DS", "3");
    const Result<Volume> volume = loadVolume(writeDicom("a.dcm", frames));
    ASSERT_LOADED(volume);
    expectCodes(*volume);
    expectGeometry(*volume, {0.5, 2, 3}, {10, -20, 30});
    EXPECT_EQ(volume->notes.size(), 1u);
}

} // namespace
} // namespace slabcast::test
