#include "tests/support/dicom_test_support.h"

namespace slabcast::test {
namespace {

class DicomValuesTest : public DicomFilesTest {};

TEST_F(DicomValuesTest, photometryChangesNoValue) {
    for (const char* photometry : {"MONOCHROME1", "MONOCHROME2"}) {
        writeSlices([&](DicomElements& elements, int) { // 12 bits, signed, an overlay in the others
            std::vector<std::uint16_t> cells;
            for (int i = 0; i < 20; ++i) {
                cells.push_back(static_cast<std::uint16_t>(0x5000 | ((i - 10) & 0xfff)));
            }
            elements.text(0x00280004, "CS", photometry)
                .word(0x00280101, 12)
                .word(0x00280102, 11)
                .text(0x00281052, "DS", "-100")
                .text(0x00281053, "DS", "2")
                .raw(0x7fe00010, "OW", bytesOf(cells));
        });
        const Result<Volume> volume = loadVolume(folder_);
        ASSERT_LOADED(volume);
        EXPECT_EQ(volume->type, VoxelType::I16);
        EXPECT_EQ(volume->valueAt({0, 0, 0}), -120);
        EXPECT_EQ(volume->valueAt({4, 3, 2}), -82);
    }
}

TEST_F(DicomValuesTest, slopesOfSlicesMayDiffer) {
    writeSlices([](DicomElements& elements, int z) {
        elements.text(0x00281052, "DS", "0").text(0x00281053, "DS", z == 1 ? "100" : "1");
    });
    Result<Volume> volume = loadVolume(folder_);
    ASSERT_LOADED(volume);
    EXPECT_EQ(volume->type, VoxelType::I16);
    EXPECT_EQ(volume->valueAt({1, 0, 0}), 1);
    EXPECT_EQ(volume->valueAt({1, 0, 1}), 2100);
    writeSlices([](DicomElements& elements, int z) {
        elements.text(0x00281052, "DS", "0").text(0x00281053, "DS", z == 2 ? "10000" : "1");
    });
    volume = loadVolume(folder_); // wider from the third slice on
    ASSERT_LOADED(volume);
    EXPECT_EQ(volume->type, VoxelType::I32);
    EXPECT_EQ(volume->valueAt({1, 0, 1}), 21);
    EXPECT_EQ(volume->valueAt({1, 0, 2}), 410000);
    writeSlices([](DicomElements& elements, int z) {
        elements.text(0x00281052, "DS", "0").text(0x00281053, "DS", z == 2 ? "0.5" : "1");
    });
    volume = loadVolume(folder_);
    ASSERT_LOADED(volume);
    EXPECT_EQ(volume->type, VoxelType::F32);
    EXPECT_EQ(volume->valueAt({1, 0, 2}), 20.5);
}

TEST_F(DicomValuesTest, slopesOfFramesMayDiffer) {
    std::vector<DicomElements> groups;
    for (int i = 0; i < 3; ++i) {
        DicomElements rescaling;
        rescaling.text(0x00281052, "DS", "5").text(0x00281053, "DS", std::to_string(i + 1));
        DicomElements group;
        groups.push_back(group.items(0x00289145, {rescaling}));
    }
    const auto path = writeDicom("a.dcm", enhanced(codes<std::int16_t>(), {30, 33, 36}, groups));
    const Result<Volume> volume = loadVolume(path);
    ASSERT_LOADED(volume);
    EXPECT_EQ(volume->valueAt({4, 3, 0}), codeAt(4, 3, 0) + 5);
    EXPECT_EQ(volume->valueAt({4, 3, 2}), 3 * codeAt(4, 3, 2) + 5);
}

TEST_F(DicomValuesTest, paddingBecomesAir) {
    writeSlices([](DicomElements& elements, int) {
        std::vector<std::uint16_t> cells(20, 1024);
        cells[0] = 63536; // -2000
        cells[1] = 24;
        elements.word(0x00280103, 0)
            .word(0x00280120, -2000, "SS")
            .text(0x00281052, "DS", "-1024")
            .text(0x00281053, "DS", "1")
            .raw(0x7fe00010, "OW", bytesOf(cells));
    });
    const Result<Volume> volume = loadVolume(folder_);
    ASSERT_LOADED(volume);
    EXPECT_EQ(volume->type, VoxelType::I16);
    EXPECT_EQ(volume->valueAt({0, 0, 1}), -1000);
    EXPECT_EQ(volume->valueAt({1, 0, 1}), -1000);
    EXPECT_EQ(volume->valueAt({2, 0, 1}), 0);
    ASSERT_EQ(volume->notes.size(), 1u);
    EXPECT_EQ(volume->notes[0], "3 voxels of padding (-2000) were set to the lowest value, -1000");
}

TEST_F(DicomValuesTest, paddingMayBeARange) {
    writeSlices([](DicomElements& elements, int) {
        std::vector<std::int16_t> cells(20, 50);
        cells[0] = -2000;
        cells[1] = -1990;
        cells[2] = 10;
        elements
            .word(0x00280120, 63536) // unsigned, of signed pixels
            .word(0x00280121, 63546)
            .raw(0x7fe00010, "OW", bytesOf(cells));
    });
    const Result<Volume> volume = loadVolume(folder_);
    ASSERT_LOADED(volume);
    EXPECT_EQ(volume->valueAt({0, 0, 0}), 10);
    EXPECT_EQ(volume->valueAt({1, 0, 0}), 10);
}

TEST_F(DicomValuesTest, tableOfValuesIsApplied) {
    writeSlices([](DicomElements& elements, int) {
        std::vector<std::uint16_t> descriptor{50, 10, 16};
        std::vector<std::uint16_t> table;
        for (int i = 0; i < 50; ++i) {
            table.push_back(static_cast<std::uint16_t>(2 * (i + 10)));
        }
        DicomElements item;
        item.raw(0x00283002, "US", bytesOf(descriptor)).raw(0x00283006, "US", bytesOf(table));
        elements.items(0x00283000, {item});
    });
    const Result<Volume> volume = loadVolume(folder_);
    ASSERT_LOADED(volume);
    EXPECT_EQ(volume->valueAt({0, 0, 0}), 20); // below the table: its first
    EXPECT_EQ(volume->valueAt({0, 0, 1}), 40);
    EXPECT_EQ(volume->valueAt({4, 3, 2}), 2 * codeAt(4, 3, 2));
}

} // namespace
} // namespace slabcast::test
