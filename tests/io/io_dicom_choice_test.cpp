#include "tests/support/dicom_test_support.h"

namespace slabcast::test {
namespace {

class DicomChoiceTest : public DicomFilesTest {
protected:
    static Result<Volume> load(const std::filesystem::path& path, std::vector<Selection> select,
                               std::optional<int> time = {}) {
        LoadOptions options;
        options.select = std::move(select);
        options.time = time;
        return loadVolume(path, options);
    }
    /// Slices of the codes plus `more`.
    template <class Change>
    void writeMore(const std::string& prefix, int more, const Change& change) const {
        writeSlices(
            [&](DicomElements& elements, int z) {
                elements.text(0x00281052, "DS", std::to_string(more)).text(0x00281053, "DS", "1");
                change(elements, z);
            },
            prefix);
    }
};

TEST_F(DicomChoiceTest, echoesAreToldApart) {
    for (int echo = 1; echo <= 2; ++echo) {
        writeMore("echo" + std::to_string(echo), 100 * echo, [&](DicomElements& elements, int z) {
            elements.text(0x00180081, "DS", std::to_string(10 * echo) + ".0")
                .text(0x00200013, "IS", std::to_string(3 * echo + z));
        });
    }
    const Result<Volume> both = loadVolume(folder_);
    for (const char* part :
         {"2 images lie at each of 3 places", "EchoTime is 10, 20", "--select EchoTime=10"}) {
        expectFailure(both, ErrorCode::AmbiguousSeries, folder_.string(), part);
    }
    const Result<Volume> second = load(folder_, {{"EchoTime", "20"}});
    ASSERT_LOADED(second);
    EXPECT_EQ(second->valueAt({0, 0, 0}), 200);
    expectGeometry(*second, {0.5, 2, 3}, {10, -20, 30});
    const Result<Volume> byNumber = load(folder_, {}, 1);
    ASSERT_LOADED(byNumber);
    EXPECT_EQ(byNumber->valueAt({0, 0, 0}), 200);
    expectFailure(load(folder_, {{"EchoTime", "30"}}), ErrorCode::InvalidArgument, folder_.string(),
                  "10, 20");
    expectFailure(load(folder_, {{"NoSuchKey", "30"}}), ErrorCode::InvalidArgument,
                  folder_.string(), "NoSuchKey");
    expectFailure(load(folder_, {}, 2), ErrorCode::InvalidArgument, folder_.string(), "0 to 1");
}

TEST_F(DicomChoiceTest, timesAreCounted) {
    for (int time = 0; time < 3; ++time) {
        writeMore("t" + std::to_string(9 - time), 100 * time, [&](DicomElements& elements, int z) {
            elements.text(0x00080032, "TM", "1203" + std::to_string(10 + 10 * time + z));
        });
    }
    expectFailure(loadVolume(folder_), ErrorCode::AmbiguousSeries, folder_.string(),
                  "--time N, 0 to 2 in the order of AcquisitionTime");
    for (int time = 0; time < 3; ++time) {
        const Result<Volume> volume = load(folder_, {}, time);
        ASSERT_LOADED(volume);
        EXPECT_EQ(volume->valueAt({0, 0, 2}), 100 * time + codeAt(0, 0, 2));
    }
}

TEST_F(DicomChoiceTest, filesOfAWholeVolumeEachAreTimes) {
    for (int file = 0; file < 2; ++file) {
        std::vector<std::int16_t> values(60, static_cast<std::int16_t>(file));
        DicomElements elements = enhanced(bytesOf(values), {30, 33, 36});
        writeDicom(std::string(1, static_cast<char>('a' + file)) + ".dcm",
                   elements.text(0x00200013, "IS", std::to_string(file + 1)));
    }
    expectFailure(loadVolume(folder_), ErrorCode::AmbiguousSeries, "a.dcm",
                  "2 files hold a whole volume each");
    const Result<Volume> second = load(folder_, {}, 1);
    ASSERT_LOADED(second);
    EXPECT_EQ(second->valueAt({0, 0, 0}), 1);
    ASSERT_LOADED(loadVolume(at("b.dcm")));
}

TEST_F(DicomChoiceTest, framesOfAFileAreToldApart) {
    std::vector<DicomElements> groups;
    for (int i = 0; i < 6; ++i) {
        DicomElements diffusion;
        diffusion.real(0x00189087, i < 3 ? 0.0 : 1000.0);
        DicomElements group;
        groups.push_back(group.items(0x00189117, {diffusion}));
    }
    std::vector<std::int16_t> values(120, 0);
    std::fill(values.begin() + 60, values.end(), std::int16_t{7});
    const auto path =
        writeDicom("a.dcm", enhanced(bytesOf(values), {30, 33, 36, 30, 33, 36}, groups));
    expectFailure(loadVolume(path), ErrorCode::AmbiguousSeries, "a.dcm",
                  "DiffusionBValue is 0, 1000; choose with --select DiffusionBValue=0");
    const Result<Volume> weighted = load(path, {{"DiffusionBValue", "1000"}});
    ASSERT_LOADED(weighted);
    EXPECT_EQ(weighted->geometry.dims, kDims);
    EXPECT_EQ(weighted->valueAt({0, 0, 0}), 7);
}

TEST_F(DicomChoiceTest, framesThatNothingTellsApartGoByOrder) {
    const std::string pixels = codes<std::int16_t>() + codes<std::int16_t>();
    const auto path = writeDicom("a.dcm", enhanced(pixels, {30, 33, 36, 30, 33, 36}));
    expectFailure(loadVolume(path), ErrorCode::AmbiguousSeries, "a.dcm",
                  "2 images lie at each of 3 places");
    const Result<Volume> second = load(path, {}, 1);
    ASSERT_LOADED(second);
    expectCodes(*second);
}

TEST_F(DicomChoiceTest, imageThatIsThereTwiceIsNamed) {
    writeSlices([](DicomElements&, int) {});
    writeDicom("twice.dcm", slice(2));
    expectFailure(loadVolume(folder_), ErrorCode::AmbiguousSeries, folder_.string(), "twice.dcm");
}

TEST_F(DicomChoiceTest, imagesAtOnePlaceAreNoVolume) {
    writeSlices([](DicomElements& elements, int z) {
        place(elements, {10, -20, 30}).text(0x00181060, "DS", std::to_string(40 * z));
    });
    expectFailure(loadVolume(folder_), ErrorCode::InvalidGeometry, folder_.string(),
                  "all 3 images lie at one place");
}

} // namespace
} // namespace slabcast::test
