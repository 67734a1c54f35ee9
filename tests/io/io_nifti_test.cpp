#include "tests/support/io_test_support.h"

#include <cmath>
#include <limits>

namespace slabcast::test {
namespace {

class NiftiTest : public IoTest {};

/// The 348 bytes of nifti1.h, and what a test changes in them. RAS, as the format has it.
struct NiftiHeader {
    std::array<std::int16_t, 8> dim{3, 5, 4, 3, 1, 1, 1, 1};
    std::int16_t datatype = 4; // int16
    std::int16_t bitpix = 16;
    std::array<float, 8> pixdim{1, 0.5F, 2, 3, 0, 0, 0, 0};
    float sclSlope = 0;
    float sclInter = 0;
    std::int16_t qformCode = 0;
    std::array<float, 3> quatern{};
    std::array<float, 3> qoffset{};
    std::int16_t sformCode = 1;
    std::array<std::array<float, 4>, 3> srow{{{0.5F, 0, 0, 10}, {0, 2, 0, -20}, {0, 0, 3, 30}}};
    bool bigEndian = false;

    template <class T>
    void put(std::string& bytes, std::size_t position, const T& value) const {
        auto raw = std::bit_cast<std::array<char, sizeof(T)>>(value);
        if (bigEndian) {
            std::reverse(raw.begin(), raw.end());
        }
        bytes.replace(position, sizeof(T), raw.data(), sizeof(T));
    }

    std::string bytes() const {
        std::string all(352, '\0');
        put(all, 0, std::int32_t{348});
        for (std::size_t i = 0; i < 8; ++i) {
            put(all, 40 + 2 * i, dim[i]);
            put(all, 76 + 4 * i, pixdim[i]);
        }
        put(all, 70, datatype);
        put(all, 72, bitpix);
        put(all, 108, 352.0F);
        put(all, 112, sclSlope);
        put(all, 116, sclInter);
        put(all, 123, char{2}); // mm
        put(all, 252, qformCode);
        put(all, 254, sformCode);
        for (std::size_t i = 0; i < 3; ++i) {
            put(all, 256 + 4 * i, quatern[i]);
            put(all, 268 + 4 * i, qoffset[i]);
            for (std::size_t k = 0; k < 4; ++k) {
                put(all, 280 + 16 * i + 4 * k, srow[i][k]);
            }
        }
        all.replace(344, 4, std::string("n+1\0", 4));
        return all;
    }
};

TEST_F(NiftiTest, rasIsTurnedToLps) {
    const Result<Volume> volume =
        loadVolume(write("a.nii", NiftiHeader{}.bytes() + codes<std::int16_t>()));
    ASSERT_LOADED(volume);
    EXPECT_EQ(volume->type, VoxelType::I16);
    expectCodes(*volume);
    expectGeometry(*volume, {0.5, 2, 3}, {-10, 20, 30}, glm::dmat3(-1, 0, 0, 0, -1, 0, 0, 0, 1));
}

TEST_F(NiftiTest, gzippedFileIsRead) {
    const Result<Volume> volume =
        loadVolume(writeGz("a.nii.gz", NiftiHeader{}.bytes() + codes<std::int16_t>()));
    ASSERT_LOADED(volume);
    expectCodes(*volume);
}

TEST_F(NiftiTest, bigEndianIsSwapped) {
    NiftiHeader header;
    header.bigEndian = true;
    const Result<Volume> volume =
        loadVolume(write("a.nii", header.bytes() + codes<std::int16_t>(kDims, true)));
    ASSERT_LOADED(volume);
    expectCodes(*volume);
    expectGeometry(*volume, {0.5, 2, 3}, {-10, 20, 30}, glm::dmat3(-1, 0, 0, 0, -1, 0, 0, 0, 1));
}

/// Turned by 30 degrees about z, then by 20 about x, in RAS.
glm::dmat3 obliqueRas() {
    const double a = 30.0 * M_PI / 180.0;
    const double b = 20.0 * M_PI / 180.0;
    const glm::dmat3 aboutZ(std::cos(a), std::sin(a), 0, -std::sin(a), std::cos(a), 0, 0, 0, 1);
    const glm::dmat3 aboutX(1, 0, 0, 0, std::cos(b), std::sin(b), 0, -std::sin(b), std::cos(b));
    return aboutX * aboutZ;
}

void expectOblique(const Volume& volume) {
    const glm::dmat3 lpsFromRas(-1, 0, 0, 0, -1, 0, 0, 0, 1);
    const glm::dmat3 direction = lpsFromRas * obliqueRas();
    expectGeometry(volume, {0.5, 2, 3}, {-10, 20, 30}, direction);
    // and in one go: the centre of voxel (4, 3, 2), by the format's own formula
    const glm::dvec3 ras =
        obliqueRas() * glm::dvec3(0.5 * 4, 2.0 * 3, 3.0 * 2) + glm::dvec3(10, -20, 30);
    const glm::dvec4 uvw = volume.geometry.uvwFromModel() * glm::dvec4(-ras.x, -ras.y, ras.z, 1.0);
    expectNear(glm::dvec3(uvw) * glm::dvec3(kDims), {4.5, 3.5, 2.5}, 1e-5);
}

TEST_F(NiftiTest, obliqueSformIsHonoured) {
    NiftiHeader header;
    const glm::dmat3 ras = obliqueRas();
    for (int row = 0; row < 3; ++row) {
        for (int axis = 0; axis < 3; ++axis) {
            header.srow[row][axis] = static_cast<float>(ras[axis][row] * header.pixdim[axis + 1]);
        }
    }
    const Result<Volume> volume =
        loadVolume(write("a.nii", header.bytes() + codes<std::int16_t>()));
    ASSERT_LOADED(volume);
    expectOblique(*volume);
}

TEST_F(NiftiTest, obliqueQformIsHonoured) {
    NiftiHeader header;
    header.sformCode = 0;
    header.qformCode = 1;
    const double a = 15.0 * M_PI / 180.0; // half angles; quaternion of aboutX * aboutZ
    const double b = 10.0 * M_PI / 180.0;
    header.quatern = {static_cast<float>(std::sin(b) * std::cos(a)),
                      static_cast<float>(-std::sin(b) * std::sin(a)),
                      static_cast<float>(std::cos(b) * std::sin(a))};
    header.qoffset = {10, -20, 30};
    const Result<Volume> volume =
        loadVolume(write("a.nii", header.bytes() + codes<std::int16_t>()));
    ASSERT_LOADED(volume);
    expectOblique(*volume);
}

TEST_F(NiftiTest, rescalingIsAppliedOnce) {
    NiftiHeader header;
    header.sclSlope = 0.25F;
    header.sclInter = -8.0F;
    const Result<Volume> volume =
        loadVolume(write("a.nii", header.bytes() + codes<std::int16_t>()));
    ASSERT_LOADED(volume);
    EXPECT_TRUE(isFloatingPoint(volume->type));
    EXPECT_EQ(volume->valueAt({4, 3, 2}), 0.25 * codeAt(4, 3, 2) - 8.0);
    EXPECT_EQ(volume->valueAt({0, 0, 0}), -8.0);
}

TEST_F(NiftiTest, slopeOfOneKeepsTheType) {
    NiftiHeader header;
    header.sclSlope = 1.0F;
    const Result<Volume> volume =
        loadVolume(write("a.nii", header.bytes() + codes<std::int16_t>()));
    ASSERT_LOADED(volume);
    EXPECT_EQ(volume->type, VoxelType::I16);
    expectCodes(*volume);
}

TEST_F(NiftiTest, trailingDimensionOfOneIsAccepted) {
    NiftiHeader header;
    header.dim = {4, 5, 4, 3, 1, 1, 1, 1};
    const Result<Volume> volume =
        loadVolume(write("a.nii", header.bytes() + codes<std::int16_t>()));
    ASSERT_LOADED(volume);
    expectCodes(*volume);
}

template <class Change>
NiftiHeader changed(const Change& change) {
    NiftiHeader header;
    change(header);
    return header;
}

TEST_F(NiftiTest, headersThatLieAreNamed) {
    struct Bad {
        NiftiHeader header;
        ErrorCode code;
        std::string_view remedy;
    };
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
    using H = NiftiHeader;
    const std::vector<Bad> cases = {
        {changed([](H& h) { h.dim[3] = 4; }), ErrorCode::FileTruncated, "fetch"},
        {changed([](H& h) { h.dim = {3, 32767, 32767, 32767, 1, 1, 1, 1}; }),
         ErrorCode::FileTruncated, "fetch"},
        {changed([](H& h) { h.dim[0] = 2; }), ErrorCode::UnsupportedDims, "stack"},
        {changed([](H& h) { h.dim[0] = 0; }), ErrorCode::UnsupportedDims, "stack"},
        {changed([](H& h) { h.dim = {4, 5, 4, 1, 3, 1, 1, 1}; }), ErrorCode::UnsupportedDims,
         "extract"},
        {changed([](H& h) { h.dim[0] = 99; }), ErrorCode::FileUnreadable, "check"},
        {changed([](H& h) { h.dim[2] = 0; }), ErrorCode::EmptyVolume, "export"},
        {changed([](H& h) { h.dim[2] = -4; }), ErrorCode::EmptyVolume, "export"},
        {changed([](H& h) { h.datatype = 1792; }), ErrorCode::UnsupportedType, "convert"},
        {changed([](H& h) { h.datatype = 128; }), ErrorCode::UnsupportedType, "grey"},
        {changed([](H& h) { h.pixdim[2] = 0; }), ErrorCode::InvalidGeometry, "spacing"},
        {changed([&](H& h) { h.pixdim[2] = kNan; }), ErrorCode::InvalidGeometry, "spacing"},
        {changed([](H& h) { h.pixdim[2] = -2; }), ErrorCode::InvalidGeometry, "pixdim"},
        {changed([](H& h) { h.srow[0][1] = 1; }), ErrorCode::InvalidGeometry, "resample"},
    };
    for (std::size_t i = 0; i < cases.size(); ++i) {
        SCOPED_TRACE(i);
        const auto path = write("a.nii", cases[i].header.bytes() + codes<std::int16_t>());
        expectFailure(loadVolume(path), cases[i].code, path.string(), cases[i].remedy);
    }
}

TEST_F(NiftiTest, versionTwoIsNamed) {
    std::string bytes = NiftiHeader{}.bytes();
    bytes[0] = 0x1c; // 540, the size of the version 2 header
    bytes[1] = 0x02;
    expectFailure(loadVolume(write("a.nii", bytes + codes<std::int16_t>())),
                  ErrorCode::UnsupportedType, "a.nii", "convert");
}

TEST_F(NiftiTest, truncatedFilesAreNamed) {
    const std::string whole = NiftiHeader{}.bytes() + codes<std::int16_t>();
    for (const std::size_t kept :
         {whole.size() - 1, std::size_t{352}, std::size_t{100}, std::size_t{0}}) {
        SCOPED_TRACE(kept);
        expectFailure(loadVolume(write("a.nii", whole.substr(0, kept))), ErrorCode::FileTruncated,
                      "a.nii", "fetch");
    }
}

TEST_F(NiftiTest, truncatedGzipIsNamed) {
    NiftiHeader header;
    header.dim = {3, 50, 40, 30, 1, 1, 1, 1};
    const auto path = writeGz("a.nii.gz", header.bytes() + codes<std::int16_t>({50, 40, 30}));
    ASSERT_LOADED(loadVolume(path));
    const std::uintmax_t size = std::filesystem::file_size(path);
    for (const std::uintmax_t kept : {size - 9, size / 2, std::uintmax_t{30}}) {
        SCOPED_TRACE(kept);
        truncate(path, kept);
        expectFailure(loadVolume(path), ErrorCode::FileTruncated, path.string(), "fetch");
    }
    header.dim[3] = 31;
    expectFailure(
        loadVolume(writeGz("b.nii.gz", header.bytes() + codes<std::int16_t>({50, 40, 30}))),
        ErrorCode::FileTruncated, "b.nii.gz", "fetch");
}

} // namespace
} // namespace slabcast::test
