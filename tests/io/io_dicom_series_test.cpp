#include "tests/support/dicom_test_support.h"
#include "tests/support/open_counter.h"

namespace slabcast::test {
namespace {

class DicomSeriesTest : public DicomFilesTest {
protected:
    void writeSeries(const std::string& uid, const std::string& description,
                     const std::string& prefix) const {
        writeSlices(
            [&](DicomElements& elements, int) {
                elements.text(0x0020000e, "UI", uid).text(0x0008103e, "LO", description);
            },
            prefix);
    }
};

TEST_F(DicomSeriesTest, severalSeriesAreListedAndOneChosen) {
    writeSeries("1.2.3.1", "head", "a");
    writeSeries("1.2.3.2", "chest", "b");
    const Result<Volume> ambiguous = loadVolume(folder_);
    for (const char* part : {"1.2.3.1", "1.2.3.2", "'head'", "'chest'", "3 files", "--series"}) {
        expectFailure(ambiguous, ErrorCode::AmbiguousSeries, folder_.string(), part);
    }
    LoadOptions options;
    options.series = "1.2.3.2";
    ASSERT_LOADED(loadVolume(folder_, options));
    options.series = "9.9";
    expectFailure(loadVolume(folder_, options), ErrorCode::InvalidArgument, folder_.string(),
                  "1.2.3.1");
}

/// Slices whose pixels are long enough to be left in the file for later.
TEST_F(DicomSeriesTest, filesAreOpenedForTheirHeaderAndForTheirPixels) {
    for (int z = 0; z < 3; ++z) {
        DicomElements elements = image(std::string(64 * 64 * 2, '\1'));
        place(elements.word(0x00280010, 64).word(0x00280011, 64), {0, 0, 3.0 * z});
        writeDicom(z == 0 ? "first.dcm" : "IM" + std::to_string(z), elements);
    }
    OpenCounter counter(folder_);
    ASSERT_LOADED(loadVolume(folder_));
    const std::map<std::string, int> twice = {{"first.dcm", 2}, {"IM1", 2}, {"IM2", 2}};
    EXPECT_EQ(counter.take(), twice);

    LoadOptions options;
    options.admit = [](const Volume& header) -> Result<void> {
        EXPECT_EQ(header.geometry.dims, glm::ivec3(64, 64, 3));
        EXPECT_EQ(header.type, VoxelType::I16);
        return fail(ErrorCode::VolumeTooLarge, "too large");
    };
    const Result<Volume> refused = loadVolume(folder_, options);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, ErrorCode::VolumeTooLarge);
    const std::map<std::string, int> once = {{"first.dcm", 1}, {"IM1", 1}, {"IM2", 1}};
    EXPECT_EQ(counter.take(), once);
}

TEST_F(DicomSeriesTest, damagedFilesAreNamed) {
    const auto noChange = [](DicomElements&, int) {};
    writeSlices(noChange);
    const std::uintmax_t whole = std::filesystem::file_size(at("1.dcm"));
    for (const std::uintmax_t kept : {whole - 1, whole - 60, whole - 200, std::uintmax_t{200},
                                      std::uintmax_t{100}, std::uintmax_t{0}}) {
        for (const char* name : {"0.dcm", "2.dcm"}) {
            writeSlices(noChange);
            truncate(at(name), kept);
            const Result<Volume> volume = loadVolume(folder_);
            ASSERT_FALSE(volume) << kept;
            EXPECT_NE(volume.error().detail.find(name), std::string::npos)
                << kept << " " << volume.error().detail;
            EXPECT_NE(volume.error().detail.find("fetch"), std::string::npos)
                << volume.error().detail;
        }
    }
}

TEST_F(DicomSeriesTest, junkBehindPixelsIsPassedOver) {
    for (const std::string& junk : {std::string(37, '\0'), std::string("hello there")}) {
        writeSlices([](DicomElements&, int) {});
        std::ofstream(at("1.dcm"), std::ios::binary | std::ios::app) << junk;
        const Result<Volume> volume = loadVolume(folder_);
        ASSERT_LOADED(volume);
        expectCodes(*volume);
    }
}

TEST_F(DicomSeriesTest, sliceWithoutPixelsIsNamed) {
    writeSlices([](DicomElements& elements, int z) {
        if (z == 0) {
            elements.without(0x7fe00010);
        }
    });
    expectFailure(loadVolume(folder_), ErrorCode::FileUnreadable, "0.dcm", "no pixels");
}

TEST_F(DicomSeriesTest, tooFewPixelsAreRefused) {
    writeSlices([](DicomElements& elements, int) { elements.word(0x00280010, 8); });
    expectFailure(loadVolume(folder_), ErrorCode::FileTruncated, "0.dcm", "take 80");
}

TEST_F(DicomSeriesTest, whatLiesBesideSlicesIsPassedOver) {
    writeSlices([](DicomElements&, int) {});
    write("readme.txt", "nothing here");
    write("empty.txt", "");
    write("DICOMDIR", "no index");
    write("preview.png", "no picture");
    DicomElements report;
    report.text(0x00080016, "UI", "1.2.840.10008.5.1.4.1.1.88.33")
        .text(0x0020000e, "UI", "1.2.3.9");
    writeDicom("report.dcm", report);
    const Result<Volume> volume = loadVolume(folder_);
    ASSERT_LOADED(volume);
    expectCodes(*volume);
}

TEST_F(DicomSeriesTest, filesWithoutImageSayWhatTheyAre) {
    DicomElements report;
    report.text(0x00080016, "UI", "1.2.840.10008.5.1.4.1.1.88.33")
        .text(0x0020000e, "UI", "1.2.3.9");
    expectFailure(loadVolume(writeDicom("report.dcm", report)), ErrorCode::FileUnreadable,
                  "report.dcm", "structured report");
    expectFailure(loadVolume(folder_), ErrorCode::EmptyFolder, folder_.string(),
                  "structured report");
    DicomElements index;
    index.text(0x00080016, "UI", "1.2.840.10008.1.3.10");
    expectFailure(loadVolume(writeDicom("DICOMDIR", index)), ErrorCode::FileUnreadable, "DICOMDIR",
                  "index");
}

TEST_F(DicomSeriesTest, foldersBelowAreSearched) {
    writeSeries("1.2.3.1", "head", "PT0/SE0/");
    const Result<Volume> volume = loadVolume(folder_);
    ASSERT_LOADED(volume);
    expectCodes(*volume);
    EXPECT_EQ(volume->name, folder_.filename().string());
    ASSERT_EQ(volume->notes.size(), 1u);
    EXPECT_NE(volume->notes[0].find("PT0/SE0"), std::string::npos);
    writeSeries("1.2.3.2", "chest", "PT0/SE1/");
    expectFailure(loadVolume(folder_), ErrorCode::AmbiguousSeries, "PT0/SE1", "--series");
}

TEST_F(DicomSeriesTest, singleSliceIsNoVolume) {
    const auto path = writeDicom("a.dcm", slice(0));
    expectFailure(loadVolume(path), ErrorCode::UnsupportedDims, path.string(),
                  "no other of its series");
    expectFailure(loadVolume(folder_), ErrorCode::UnsupportedDims, folder_.string(),
                  "a single slice");
    writeDicom("b.dcm", slice(1));
    expectFailure(loadVolume(path), ErrorCode::UnsupportedDims, path.string(), "name the folder");
}

TEST_F(DicomSeriesTest, foldersWithoutSlicesAreNamed) {
    expectFailure(loadVolume(folder_), ErrorCode::EmptyFolder, folder_.string(), "name a folder");
    write("readme.txt", "nothing here");
    expectFailure(loadVolume(folder_), ErrorCode::EmptyFolder, folder_.string(), "name a folder");
    expectFailure(loadVolume(write("a.dcm", "not DICOM")), ErrorCode::FileUnreadable, "a.dcm",
                  "check");
}

} // namespace
} // namespace slabcast::test
