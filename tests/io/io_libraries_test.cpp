// A program of its own, for the other importers' tests link OpenImageIO to write what they read.
#include "tests/support/io_test_support.h"

#include "platform/io/pictures/image_module.h"
#include "platform/io/save_image.h"

namespace slabcast::test {
namespace {

class LibrariesTest : public IoTest {
protected:
    static bool isLoaded(std::string_view library) {
        std::ifstream maps("/proc/self/maps");
        for (std::string line; std::getline(maps, line);) {
            if (line.find(library) != std::string::npos) {
                return true;
            }
        }
        return false;
    }
};

// First: OpenImageIO brings DCMTK along.
TEST_F(LibrariesTest, dcmtkIsLoadedOnFirstUse) {
    EXPECT_FALSE(isLoaded("libdcmdata"));
    const Result<Volume> none =
        loadVolume(write("a.dcm", "no DICOM"), {.process = ReadIn::ThisProcess});
    ASSERT_FALSE(none);
    EXPECT_NE(none.error().detail.find("is not DICOM"), std::string::npos) << none.error().detail;
    EXPECT_TRUE(isLoaded("slabcast_dicom"));
    EXPECT_TRUE(isLoaded("libdcmdata"));
}

TEST_F(LibrariesTest, openImageIoIsLoadedOnFirstUse) {
    const auto nrrd = write("a.nrrd", "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 5 4 3\n"
                                      "encoding: raw\n\n" +
                                          codes<std::uint8_t>());
    const Result<Volume> volume = loadVolume(nrrd, {.process = ReadIn::ThisProcess});
    ASSERT_LOADED(volume);
    expectCodes(*volume);
    const std::vector<std::uint8_t> pixels(4);
    ASSERT_TRUE(savePng(at("a.png"), 1, 1, pixels.data()));
    EXPECT_TRUE(isLoaded("libpng")); // so that a name which is found nowhere says something
    EXPECT_FALSE(isLoaded("slabcast_images"));
    EXPECT_FALSE(isLoaded("libOpenImageIO"));

    const std::vector<float> light(4);
    const Result<void> saved = saveExr(at("a.exr"), 1, 1, light.data());
    ASSERT_TRUE(saved) << saved.error().detail;
    EXPECT_TRUE(isLoaded("slabcast_images"));
    EXPECT_TRUE(isLoaded("libOpenImageIO"));
}

TEST_F(LibrariesTest, filesThatAreNoModuleAreNamed) {
    const std::string empty = write("empty.so", "").string();
    const std::array<std::pair<std::string, std::string>, 3> cases = {{
        {"no_such_module.so", "No such file"},
        {empty, "too short"},
        {"libz.so.1", "version"}, // a library like others
    }};
    for (const auto& [file, cause] : cases) {
        const Result<const ImageModule*> module = openImageModule(file.c_str());
        ASSERT_FALSE(module) << file;
        const std::string& detail = module.error().detail;
        EXPECT_NE(detail.find(file), std::string::npos) << detail;
        EXPECT_NE(detail.find(cause), std::string::npos) << detail;
        EXPECT_EQ(detail.find('\n'), std::string::npos) << detail;
    }
}

} // namespace
} // namespace slabcast::test
