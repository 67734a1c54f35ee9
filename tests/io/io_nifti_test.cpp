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
    float voxOffset = 352;
    char units = 2; // mm
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
        put(all, 108, voxOffset);
        put(all, 112, sclSlope);
        put(all, 116, sclInter);
        put(all, 123, units);
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

/// The same header in the form of nifti2.h.
std::string versionTwo(const NiftiHeader& header, double voxOffset = 544.0) {
    std::string all(544, '\0');
    header.put(all, 0, std::int32_t{540});
    all.replace(4, 8, std::string("n+2\0\r\n\x1A\n", 8));
    header.put(all, 12, header.datatype);
    header.put(all, 14, header.bitpix);
    for (std::size_t i = 0; i < 8; ++i) {
        header.put(all, 16 + 8 * i, std::int64_t{header.dim[i]});
        header.put(all, 104 + 8 * i, double{header.pixdim[i]});
    }
    header.put(all, 168, static_cast<std::int64_t>(voxOffset));
    header.put(all, 176, double{header.sclSlope});
    header.put(all, 184, double{header.sclInter});
    header.put(all, 344, std::int32_t{header.qformCode});
    header.put(all, 348, std::int32_t{header.sformCode});
    for (std::size_t i = 0; i < 3; ++i) {
        header.put(all, 352 + 8 * i, double{header.quatern[i]});
        header.put(all, 376 + 8 * i, double{header.qoffset[i]});
        for (std::size_t k = 0; k < 4; ++k) {
            header.put(all, 400 + 32 * i + 8 * k, double{header.srow[i][k]});
        }
    }
    header.put(all, 500, std::int32_t{header.units});
    return all;
}

const glm::dmat3 kLpsFromRas(-1, 0, 0, 0, -1, 0, 0, 0, 1);

TEST_F(NiftiTest, versionTwoIsRead) {
    NiftiHeader header;
    for (const bool bigEndian : {false, true}) {
        header.bigEndian = bigEndian;
        const Result<Volume> volume =
            loadVolume(write("a.nii", versionTwo(header) + codes<std::int16_t>(kDims, bigEndian)));
        ASSERT_LOADED(volume);
        expectCodes(*volume);
        expectGeometry(*volume, {0.5, 2, 3}, {-10, 20, 30}, kLpsFromRas);
    }
    expectFailure(loadVolume(write("b.nii", versionTwo({}).substr(0, 400))),
                  ErrorCode::FileTruncated, "b.nii", "fetch");
    expectFailure(loadVolume(write("b.nii", versionTwo({}, 540) + codes<std::int16_t>())),
                  ErrorCode::FileUnreadable, "b.nii", "vox_offset");
}

TEST_F(NiftiTest, gzipBehindAPlainNameIsRead) {
    const Result<Volume> volume =
        loadVolume(writeGz("a.nii", NiftiHeader{}.bytes() + codes<std::int16_t>()));
    ASSERT_LOADED(volume);
    expectCodes(*volume);
}

TEST_F(NiftiTest, slopeOfZeroScalesNothing) {
    for (const float slope : {0.0F, -0.0F, std::numeric_limits<float>::quiet_NaN()}) {
        const Result<Volume> volume = loadVolume(write("a.nii", changed([&](NiftiHeader& h) {
                                                                    h.sclSlope = slope;
                                                                    h.sclInter = 100.0F;
                                                                }).bytes() +
                                                                    codes<std::int16_t>()));
        ASSERT_LOADED(volume);
        EXPECT_EQ(volume->type, VoxelType::I16);
        expectCodes(*volume);
        EXPECT_EQ(volume->notes.size(), slope == 0.0F ? 0U : 1U);
    }
}

Result<Volume> loadChanged(const std::filesystem::path& path, const NiftiHeader& header) {
    std::ofstream(path, std::ios::binary) << header.bytes() + codes<std::int16_t>();
    return loadVolume(path);
}

TEST_F(NiftiTest, unitsScaleSpacingAndOrigin) {
    NiftiHeader header;
    for (const auto& [units, millimetres] : {std::pair(char{1}, 1e3),
                                             {char{2}, 1.0},
                                             {char{3}, 1e-3},
                                             {char{0}, 1.0},
                                             {char{11}, 1e-3}}) {
        SCOPED_TRACE(static_cast<int>(units));
        header.units = units;
        const Result<Volume> volume = loadChanged(at("a.nii"), header);
        ASSERT_LOADED(volume);
        expectNear(volume->geometry.spacingMm / millimetres, {0.5, 2, 3});
        expectNear(volume->geometry.originMm / millimetres, {-10, 20, 30});
        EXPECT_TRUE(volume->notes.empty());
    }
    header.units = 7;
    const Result<Volume> odd = loadChanged(at("a.nii"), header);
    ASSERT_LOADED(odd);
    ASSERT_EQ(odd->notes.size(), 1U);
    EXPECT_NE(odd->notes[0].find("xyzt_units"), std::string::npos);
}

TEST_F(NiftiTest, smallVoxelsAndFarOriginsAreStraight) {
    for (const float scale : {1e-5F, 1e-2F, 1e3F}) {
        SCOPED_TRACE(scale);
        const Result<Volume> volume = loadChanged(at("a.nii"), changed([&](NiftiHeader& h) {
                                                      for (std::size_t i = 0; i < 3; ++i) {
                                                          h.pixdim[i + 1] *= scale;
                                                          h.srow[i][i] *= scale;
                                                          h.srow[i][3] = 50000.0F;
                                                      }
                                                  }));
        ASSERT_LOADED(volume);
        expectGeometry(*volume, glm::dvec3(0.5, 2, 3) * double{scale}, {-50000, -50000, 50000},
                       kLpsFromRas);
    }
}

TEST_F(NiftiTest, pixdimThatIsRoundedIsFine) {
    const Result<Volume> volume =
        loadChanged(at("a.nii"), changed([](NiftiHeader& h) { h.pixdim[2] = 2.003F; }));
    ASSERT_LOADED(volume);
    expectGeometry(*volume, {0.5, 2, 3}, {-10, 20, 30}, kLpsFromRas);
    EXPECT_TRUE(volume->notes.empty());
    const Result<Volume> far =
        loadChanged(at("a.nii"), changed([](NiftiHeader& h) { h.pixdim[2] = 5.0F; }));
    ASSERT_LOADED(far);
    expectGeometry(*far, {0.5, 2, 3}, {-10, 20, 30}, kLpsFromRas);
    ASSERT_EQ(far->notes.size(), 1U);
    EXPECT_NE(far->notes[0].find("pixdim"), std::string::npos);
}

TEST_F(NiftiTest, sformOfDirectionsOnlyTakesPixdim) {
    const Result<Volume> volume =
        loadChanged(at("a.nii"), changed([](NiftiHeader& h) {
                        h.srow = {{{-1, 0, 0, 10}, {0, 1, 0, -20}, {0, 0, 1, 30}}};
                    }));
    ASSERT_LOADED(volume);
    expectGeometry(*volume, {0.5, 2, 3}, {-10, 20, 30}, glm::dmat3(1, 0, 0, 0, -1, 0, 0, 0, 1));
    ASSERT_EQ(volume->notes.size(), 1U);
    EXPECT_NE(volume->notes[0].find("directions only"), std::string::npos);
}

TEST_F(NiftiTest, sformThatCannotServeLeavesItToTheQform) {
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
    constexpr float kInf = std::numeric_limits<float>::infinity();
    const std::vector<std::pair<NiftiHeader, std::string_view>> cases = {
        {changed([&](NiftiHeader& h) {
             h.srow = {{{kNan, kNan, kNan, kNan}}};
         }),
         "NaN"},
        {changed([&](NiftiHeader& h) { h.srow[1][3] = kNan; }), "NaN"},
        {changed([&](NiftiHeader& h) { h.srow[2][2] = kInf; }), "infinite"},
        {changed([&](NiftiHeader& h) { h.srow = {}; }), "spans no space"},
        {changed([&](NiftiHeader& h) { h.srow[0][1] = 1; }), "right angles"},
        {changed([&](NiftiHeader& h) { h.srow[1] = h.srow[0]; }), "o"},
    };
    for (auto [header, word] : cases) {
        SCOPED_TRACE(word);
        const Result<Volume> refused = loadChanged(at("a.nii"), header);
        expectFailure(refused, ErrorCode::InvalidGeometry, at("a.nii").string(), word);
        header.qformCode = 1;
        header.quatern = {0, 0, 1};
        header.qoffset = {1, 2, 3};
        const Result<Volume> volume = loadChanged(at("a.nii"), header);
        ASSERT_LOADED(volume);
        expectGeometry(*volume, {0.5, 2, 3}, {-1, -2, 3});
        ASSERT_EQ(volume->notes.size(), 1U);
        EXPECT_NE(volume->notes[0].find(word), std::string::npos) << volume->notes[0];
        header.quatern[0] = kNan;
        EXPECT_FALSE(loadChanged(at("a.nii"), header));
    }
}

TEST_F(NiftiTest, qformServesWhereTheSformIsOfAnotherSpace) {
    NiftiHeader header;
    header.qformCode = 1;
    header.quatern = {0, 0, 1}; // half a turn about z
    header.qoffset = {1, 2, 3};
    header.sformCode = 4;
    Result<Volume> volume = loadChanged(at("a.nii"), header);
    ASSERT_LOADED(volume);
    expectGeometry(*volume, {0.5, 2, 3}, {-1, -2, 3});
    header.sformCode = 1; // of the scanner
    volume = loadChanged(at("a.nii"), header);
    ASSERT_LOADED(volume);
    expectGeometry(*volume, {0.5, 2, 3}, {-10, 20, 30}, kLpsFromRas);
    header.sformCode = 0;
    header.pixdim[0] = -1; // left-handed
    volume = loadChanged(at("a.nii"), header);
    ASSERT_LOADED(volume);
    expectGeometry(*volume, {0.5, 2, 3}, {-1, -2, 3}, glm::dmat3(1, 0, 0, 0, 1, 0, 0, 0, -1));
    header.qformCode = 0;
    volume = loadChanged(at("a.nii"), header);
    ASSERT_LOADED(volume);
    expectGeometry(*volume, {0.5, 2, 3}, {0, 0, 0});
}

TEST_F(NiftiTest, offsetsBeforeTheVoxelsAreRefused) {
    for (const float offset :
         {348.0F, 350.0F, 1.0F, -1.0F, 352.5F, 1e30F, std::numeric_limits<float>::quiet_NaN()}) {
        expectFailure(
            loadChanged(at("a.nii"), changed([&](NiftiHeader& h) { h.voxOffset = offset; })),
            ErrorCode::FileUnreadable, at("a.nii").string(), "vox_offset");
    }
    const Result<Volume> volume =
        loadChanged(at("a.nii"), changed([](NiftiHeader& h) { h.voxOffset = 0.0F; }));
    ASSERT_LOADED(volume);
    expectCodes(*volume);
    ASSERT_EQ(volume->notes.size(), 1U);
    EXPECT_NE(volume->notes[0].find("vox_offset"), std::string::npos);
    const Result<Volume> behind =
        loadVolume(write("b.nii", changed([](NiftiHeader& h) { h.voxOffset = 368.0F; }).bytes() +
                                      std::string(16, 'x') + codes<std::int16_t>()));
    ASSERT_LOADED(behind);
    expectCodes(*behind);
}

TEST_F(NiftiTest, integersOf64BitsAreReadWhereTheyFit) {
    for (const std::int16_t type : {std::int16_t{1024}, std::int16_t{1280}}) {
        NiftiHeader header;
        header.datatype = type;
        Result<Volume> volume = loadVolume(write("a.nii", header.bytes() + codes<std::int64_t>()));
        ASSERT_LOADED(volume);
        EXPECT_EQ(volume->type, VoxelType::I32);
        expectCodes(*volume);
        header.sclSlope = 2.0F;
        volume = loadVolume(write("a.nii", header.bytes() + codes<std::int64_t>()));
        ASSERT_LOADED(volume);
        EXPECT_EQ(volume->type, VoxelType::F64);
        EXPECT_EQ(volume->valueAt({4, 3, 2}), 2.0 * codeAt(4, 3, 2));
    }
    NiftiHeader header;
    header.datatype = 1024;
    std::string voxels = codes<std::int64_t>();
    voxels[7] = 0x7F;
    voxels[0] = 1;
    expectFailure(loadVolume(write("a.nii", header.bytes() + voxels)), ErrorCode::UnsupportedType,
                  at("a.nii").string(), "int64");
}

TEST_F(NiftiTest, typesAreNamedInWords) {
    const std::vector<std::pair<std::int16_t, std::string_view>> types = {
        {1, "bit"},           {32, "complex64"},    {128, "rgb24"},   {1536, "float128"},
        {1792, "complex128"}, {2048, "complex256"}, {2304, "rgba32"}, {77, "code 77"}};
    for (const auto& [code, word] : types) {
        NiftiHeader header;
        header.datatype = code;
        expectFailure(loadChanged(at("a.nii"), header), ErrorCode::UnsupportedType,
                      at("a.nii").string(), word);
    }
}

TEST_F(NiftiTest, oneOfSeveralTimesIsTaken) {
    NiftiHeader header;
    header.dim = {4, 5, 4, 3, 2, 1, 1, 1};
    const std::string bytes = header.bytes() + std::string(120, 'x') + codes<std::int16_t>();
    LoadOptions options;
    options.time = 1;
    for (const auto& path : {write("a.nii", bytes), writeGz("a.nii.gz", bytes)}) {
        expectFailure(loadVolume(path), ErrorCode::UnsupportedDims, path.string(),
                      "--time 0 to --time 1");
        const Result<Volume> volume = loadVolume(path, options);
        ASSERT_LOADED(volume);
        expectCodes(*volume);
    }
    const auto path = write("b.nii", NiftiHeader{}.bytes() + codes<std::int16_t>());
    expectFailure(loadVolume(path, options), ErrorCode::InvalidArgument, path.string(), "0");
    options.time = 0;
    ASSERT_LOADED(loadVolume(path, options));
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
