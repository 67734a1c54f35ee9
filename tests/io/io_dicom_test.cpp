#include "tests/support/io_test_support.h"

#include <itkGDCMImageIO.h>
#include <itkMetaDataObject.h>

namespace slabcast::test {
namespace {

struct SliceSpec {
    std::string seriesUid = "1.2.3.1";
    std::string description = "head";
    std::string modality = "CT";
    int z = 0;          // which slice of the codes it holds
    double placeMm = 0; // along the normal
    double tiltMm = 0;  // along y, per slice of a tilted gantry
    glm::dmat3 direction{1.0};
    double slope = 1.0;
    double intercept = 0.0;
    glm::ivec3 dims = kDims;
};

class DicomTest : public IoTest {
protected:
    std::filesystem::path writeSlice(const std::string& name, const SliceSpec& slice) const {
        const glm::dvec3 origin = glm::dvec3(10, -20, 30) + slice.placeMm * slice.direction[2] +
                                  glm::dvec3(0, slice.tiltMm, 0);
        const auto io = itk::GDCMImageIO::New();
        io->SetFileName(at(name).string());
        io->SetNumberOfDimensions(3);
        io->SetPixelType(itk::IOPixelEnum::SCALAR);
        io->SetComponentType(itk::IOComponentEnum::SHORT);
        io->SetNumberOfComponents(1);
        const glm::dvec3 spacing{0.5, 2, 3};
        for (unsigned axis = 0; axis < 3; ++axis) {
            io->SetDimensions(axis, axis == 2 ? 1 : slice.dims[axis]);
            io->SetSpacing(axis, spacing[axis]);
            io->SetOrigin(axis, origin[axis]);
            const glm::dvec3 along = slice.direction[axis];
            io->SetDirection(axis, std::vector<double>{along.x, along.y, along.z});
        }
        itk::MetaDataDictionary tags;
        const auto set = [&](const char* tag, const std::string& value) {
            itk::EncapsulateMetaData<std::string>(tags, tag, value);
        };
        set("0008|0016",
            "1.2.840.10008.5.1.4.1.1.2"); // CT image storage: keeps position and rescaling
        set("0008|0060", slice.modality);
        set("0008|103e", slice.description);
        set("0020|000d", "1.2.3");
        set("0020|000e", slice.seriesUid);
        set("0020|0013", std::to_string(slice.z + 1));
        set("0028|1052", std::to_string(slice.intercept));
        set("0028|1053", std::to_string(slice.slope));
        io->SetMetaDataDictionary(tags);
        io->KeepOriginalUIDOn();
        io->WriteImageInformation();
        const std::string all = codes<std::int16_t>(slice.dims);
        const std::size_t sliceBytes = all.size() / slice.dims.z;
        std::vector<std::int16_t> voxels(sliceBytes / 2);
        std::memcpy(voxels.data(), all.data() + sliceBytes * slice.z, sliceBytes);
        for (std::int16_t& voxel : voxels) { // the writer undoes the rescaling that the tags name
            voxel = static_cast<std::int16_t>(voxel * slice.slope + slice.intercept);
        }
        io->Write(voxels.data());
        return at(name);
    }

    /// Named against their order in space.
    void writeSeries(const SliceSpec& first = {}) const {
        for (int z = 0; z < 3; ++z) {
            SliceSpec slice = first;
            slice.z = z;
            slice.placeMm = 3.0 * z;
            slice.tiltMm = first.tiltMm * z;
            writeSlice(first.seriesUid + "_" + std::to_string(9 - z) + ".dcm", slice);
        }
    }
};

TEST_F(DicomTest, seriesIsStackedInOrderOfPlace) {
    writeSeries();
    const Result<Volume> volume = loadVolume(folder_);
    ASSERT_LOADED(volume);
    EXPECT_EQ(volume->type, VoxelType::I16);
    EXPECT_EQ(volume->modality, Modality::Ct);
    EXPECT_EQ(volume->unit, "HU");
    EXPECT_EQ(volume->name, folder_.filename().string());
    expectCodes(*volume);
    expectGeometry(*volume, {0.5, 2, 3}, {10, -20, 30});
}

TEST_F(DicomTest, rescalingIsAppliedOnce) {
    SliceSpec slice;
    slice.intercept = -1024;
    slice.modality = "MR";
    writeSeries(slice);
    const Result<Volume> volume = loadVolume(folder_);
    ASSERT_LOADED(volume);
    EXPECT_EQ(volume->valueAt({0, 0, 0}), -1024);
    EXPECT_EQ(volume->valueAt({4, 3, 2}), codeAt(4, 3, 2) - 1024);
    EXPECT_EQ(volume->modality, Modality::Mr);
    EXPECT_EQ(volume->unit, "");
}

TEST_F(DicomTest, obliqueSlicesAreHonoured) {
    SliceSpec slice; // sagittal: rows run down, columns to the back
    slice.direction = glm::dmat3(0, 1, 0, 0, 0, -1, -1, 0, 0);
    writeSeries(slice);
    const Result<Volume> volume = loadVolume(folder_);
    ASSERT_LOADED(volume);
    expectCodes(*volume);
    expectGeometry(*volume, {0.5, 2, 3}, {10, -20, 30}, slice.direction);
}

TEST_F(DicomTest, tiltedGantryShearsTheBox) {
    SliceSpec slice;
    slice.tiltMm = 4.0; // 3 mm up, 4 mm back: slices 5 mm apart
    writeSeries(slice);
    const Result<Volume> volume = loadVolume(folder_);
    ASSERT_LOADED(volume);
    expectCodes(*volume);
    expectGeometry(*volume, {0.5, 2, 5}, {10, -20, 30}, glm::dmat3(1, 0, 0, 0, 1, 0, 0, 0.8, 0.6));
}

TEST_F(DicomTest, severalSeriesAreListedAndOneChosen) {
    writeSeries();
    SliceSpec other;
    other.seriesUid = "1.2.3.2";
    other.description = "chest";
    writeSeries(other);
    const Result<Volume> ambiguous = loadVolume(folder_);
    for (const char* part : {"1.2.3.1", "1.2.3.2", "'head'", "'chest'", "3 files"}) {
        expectFailure(ambiguous, ErrorCode::AmbiguousSeries, folder_.string(), part);
    }
    expectFailure(ambiguous, ErrorCode::AmbiguousSeries, folder_.string(), "--series");
    ASSERT_LOADED(loadVolume(folder_, {.series = "1.2.3.2", .raw = {}}));
    expectFailure(loadVolume(folder_, {.series = "9.9", .raw = {}}), ErrorCode::InvalidArgument,
                  folder_.string(), "1.2.3.1");
}

TEST_F(DicomTest, slicesThatFormNoVolumeAreNamed) {
    writeSeries();
    SliceSpec far;
    far.z = 2;
    far.placeMm = 12;
    const auto gap = writeSlice("far.dcm", far);
    expectFailure(loadVolume(folder_), ErrorCode::InvalidGeometry, "far.dcm", "missing");
    std::filesystem::remove(gap);

    far.placeMm = 6;
    const auto twice = writeSlice("twice.dcm", far);
    expectFailure(loadVolume(folder_), ErrorCode::InvalidGeometry, folder_.string(), "twice");
    std::filesystem::remove(twice);

    far.placeMm = 9;
    far.dims = {6, 4, 3};
    const auto wide = writeSlice("wide.dcm", far);
    expectFailure(loadVolume(folder_), ErrorCode::InvalidGeometry, "wide.dcm", "move");
    std::filesystem::remove(wide);

    far.dims = kDims;
    far.direction = glm::dmat3(0, 1, 0, -1, 0, 0, 0, 0, 1);
    writeSlice("turned.dcm", far);
    expectFailure(loadVolume(folder_), ErrorCode::InvalidGeometry, folder_.string(), "orientation");
}

TEST_F(DicomTest, truncatedSliceIsNamed) {
    writeSeries();
    const auto path = at("1.2.3.1_8.dcm");
    truncate(path, std::filesystem::file_size(path) - 10);
    const Result<Volume> volume = loadVolume(folder_);
    ASSERT_FALSE(volume);
    EXPECT_TRUE(volume.error().code == ErrorCode::FileTruncated ||
                volume.error().code == ErrorCode::FileUnreadable)
        << volume.error().detail;
    EXPECT_NE(volume.error().detail.find("1.2.3.1_8.dcm"), std::string::npos)
        << volume.error().detail;
}

TEST_F(DicomTest, singleSliceIsNoVolume) {
    const auto path = writeSlice("a.dcm", {});
    expectFailure(loadVolume(path), ErrorCode::UnsupportedDims, path.string(), "folder");
    expectFailure(loadVolume(folder_), ErrorCode::UnsupportedDims, folder_.string(), "folder");
}

TEST_F(DicomTest, foldersWithoutSlicesAreNamed) {
    expectFailure(loadVolume(folder_), ErrorCode::EmptyFolder, folder_.string(), "name a folder");
    write("readme.txt", "nothing here");
    expectFailure(loadVolume(folder_), ErrorCode::EmptyFolder, folder_.string(), "name a folder");
    expectFailure(loadVolume(write("a.dcm", "not DICOM")), ErrorCode::FileUnreadable, "a.dcm",
                  "check");
}

} // namespace
} // namespace slabcast::test
