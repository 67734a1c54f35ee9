#include "tests/support/io_test_support.h"

#include <map>
#include <sstream>

#include "platform/io/save_nrrd.h"

namespace slabcast::test {
namespace {

class NrrdTest : public IoTest {};

using Fields = std::map<std::string, std::string>;

/// A header of 5 x 4 x 3 shorts; `changes` replaces fields, an empty text removes one.
std::string header(const Fields& changes = {}, std::string_view keys = "") {
    Fields fields = {{"type", "short"},
                     {"dimension", "3"},
                     {"sizes", "5 4 3"},
                     {"encoding", "raw"},
                     {"endian", "little"},
                     {"space", "left-posterior-superior"},
                     {"space directions", "(0.5,0,0) (0,2,0) (0,0,3)"},
                     {"space origin", "(10,-20,30)"}};
    for (const auto& [name, value] : changes) {
        fields[name] = value;
    }
    std::string text = "NRRD0005\n";
    for (const char* name : {"type",
                             "dimension",
                             "space",
                             "space dimension",
                             "sizes",
                             "spacings",
                             "axis mins",
                             "axis maxs",
                             "centers",
                             "units",
                             "space directions",
                             "kinds",
                             "endian",
                             "encoding",
                             "space units",
                             "space origin",
                             "line skip",
                             "byte skip",
                             "spacing",
                             "data file"}) {
        const auto field = fields.find(name);
        if (field != fields.end() && !field->second.empty()) {
            text += field->first + ": " + field->second + "\n";
        }
    }
    return text + std::string(keys) + "\n";
}

TEST_F(NrrdTest, attachedFileKeepsVoxelsGeometryAndKeys) {
    const auto path =
        write("a.nrrd", header({}, "modality:=CT\nunit:=HU\n") + codes<std::int16_t>());
    const Result<Volume> volume = loadVolume(path);
    ASSERT_LOADED(volume);
    EXPECT_EQ(volume->type, VoxelType::I16);
    EXPECT_EQ(volume->name, "a.nrrd");
    EXPECT_EQ(volume->unit, "HU");
    EXPECT_EQ(volume->modality, Modality::Ct);
    expectCodes(*volume);
    expectGeometry(*volume, {0.5, 2, 3}, {10, -20, 30});
}

TEST_F(NrrdTest, detachedFileIsReadFromBesideTheHeader) {
    write("voxels.raw", "skipped!" + codes<std::int16_t>());
    const auto path = write("a.nhdr", header({{"data file", "voxels.raw"}, {"byte skip", "8"}}));
    const Result<Volume> volume = loadVolume(path);
    ASSERT_LOADED(volume);
    expectCodes(*volume);
}

TEST_F(NrrdTest, gzipIsRead) {
    writeGz("z.gz", codes<std::int16_t>());
    std::ifstream stream(at("z.gz"), std::ios::binary);
    const std::string packed{std::istreambuf_iterator<char>(stream), {}};
    const Result<Volume> volume =
        loadVolume(write("a.nrrd", header({{"encoding", "gzip"}}) + packed));
    ASSERT_LOADED(volume);
    expectCodes(*volume);
}

template <class T>
void expectType(const std::filesystem::path& path, VoxelType type) {
    const Result<Volume> volume = loadVolume(path);
    ASSERT_LOADED(volume);
    EXPECT_EQ(volume->type, type);
    EXPECT_EQ(volume->voxels.size(), sizeof(T) * 60);
    expectCodes(*volume);
}

TEST_F(NrrdTest, everyTypeIsKept) {
    expectType<std::uint8_t>(write("a.nrrd", header({{"type", "uchar"}}) + codes<std::uint8_t>()),
                             VoxelType::U8);
    expectType<std::int8_t>(write("b.nrrd", header({{"type", "int8"}}) + codes<std::int8_t>()),
                            VoxelType::I8);
    expectType<std::uint16_t>(
        write("c.nrrd", header({{"type", "ushort"}}) + codes<std::uint16_t>()), VoxelType::U16);
    expectType<std::int32_t>(write("d.nrrd", header({{"type", "int"}}) + codes<std::int32_t>()),
                             VoxelType::I32);
    expectType<std::uint32_t>(
        write("e.nrrd", header({{"type", "uint32"}}) + codes<std::uint32_t>()), VoxelType::U32);
    expectType<float>(write("f.nrrd", header({{"type", "float"}}) + codes<float>()),
                      VoxelType::F32);
    expectType<double>(write("g.nrrd", header({{"type", "double"}}) + codes<double>()),
                       VoxelType::F64);
}

TEST_F(NrrdTest, bigEndianIsSwapped) {
    const Result<Volume> volume =
        loadVolume(write("a.nrrd", header({{"endian", "big"}}) + codes<std::int16_t>(kDims, true)));
    ASSERT_LOADED(volume);
    expectCodes(*volume);
}

TEST_F(NrrdTest, rasIsTurnedToLps) {
    const Result<Volume> volume = loadVolume(
        write("a.nrrd", header({{"space", "right-anterior-superior"}}) + codes<std::int16_t>()));
    ASSERT_LOADED(volume);
    expectGeometry(*volume, {0.5, 2, 3}, {-10, 20, 30}, glm::dmat3(-1, 0, 0, 0, -1, 0, 0, 0, 1));
}

TEST_F(NrrdTest, negativeSpacingIsADirection) {
    const Result<Volume> volume = loadVolume(write("a.nrrd", header({{"space", ""},
                                                                     {"space directions", ""},
                                                                     {"space origin", ""},
                                                                     {"spacings", "1 -2 3"}}) +
                                                                 codes<std::int16_t>()));
    ASSERT_LOADED(volume);
    expectNear(volume->geometry.spacingMm, {1, 2, 3});
    expectNear(volume->geometry.direction[1], {0, -1, 0});
}

TEST_F(NrrdTest, trailingDimensionOfOneIsAccepted) {
    const Result<Volume> volume =
        loadVolume(write("a.nrrd", header({{"dimension", "4"},
                                           {"sizes", "5 4 3 1"},
                                           {"space directions", "(0.5,0,0) (0,2,0) (0,0,3) none"},
                                           {"kinds", "domain domain domain list"}}) +
                                       codes<std::int16_t>()));
    ASSERT_LOADED(volume);
    expectCodes(*volume);
    expectGeometry(*volume, {0.5, 2, 3}, {10, -20, 30});
}

TEST_F(NrrdTest, savedFileComesBackAsItWas) {
    const auto source =
        write("a.nrrd", header({{"space directions", "(0.3,0.4,0) (-0.8,0.6,0) (0,0,-1.5)"}},
                               "modality:=MR\nunit:=mm\n") +
                            codes<std::int16_t>());
    const Result<Volume> volume = loadVolume(source);
    ASSERT_LOADED(volume);
    ASSERT_TRUE(saveNrrd(at("b.nrrd"), *volume));
    const Result<Volume> again = loadVolume(at("b.nrrd"));
    ASSERT_LOADED(again);
    EXPECT_EQ(again->voxels, volume->voxels);
    EXPECT_EQ(again->type, volume->type);
    EXPECT_EQ(again->unit, "mm");
    EXPECT_EQ(again->modality, Modality::Mr);
    expectGeometry(*again, {0.5, 1, 1.5}, {10, -20, 30},
                   glm::dmat3(0.6, 0.8, 0, -0.8, 0.6, 0, 0, 0, -1));
}

TEST_F(NrrdTest, rescaledVolumeIsNotSaved) {
    Volume volume;
    volume.rescaleSlope = 2.0;
    const Result<void> saved = saveNrrd(at("a.nrrd"), volume);
    ASSERT_FALSE(saved);
    EXPECT_EQ(saved.error().code, ErrorCode::InvalidArgument);
}

std::string vectorText(glm::dvec3 v) {
    std::ostringstream text;
    text << '(' << v.x << ',' << v.y << ',' << v.z << ')';
    return text.str();
}

constexpr glm::dvec3 kEdge{0.5, 2, 3};
constexpr glm::dvec3 kOrigin{10, -20, 30};

/// Axis k of the file runs along axis order[k] of the object, backwards where flipped[k].
struct Layout {
    glm::ivec3 order;
    glm::bvec3 flipped;

    glm::ivec3 dims() const { return {kDims[order.x], kDims[order.y], kDims[order.z]}; }

    glm::ivec3 objectVoxel(glm::ivec3 fileVoxel) const {
        glm::ivec3 voxel{0};
        for (int k = 0; k < 3; ++k) {
            voxel[order[k]] = flipped[k] ? dims()[k] - 1 - fileVoxel[k] : fileVoxel[k];
        }
        return voxel;
    }

    std::string file() const {
        std::string directions;
        for (int k = 0; k < 3; ++k) {
            glm::dvec3 step{0.0};
            step[order[k]] = (flipped[k] ? -1.0 : 1.0) * kEdge[order[k]];
            directions += vectorText(step) + " ";
        }
        std::ostringstream sizes;
        sizes << dims().x << ' ' << dims().y << ' ' << dims().z;
        std::string voxels;
        glm::ivec3 i{0};
        for (i.z = 0; i.z < dims().z; ++i.z) {
            for (i.y = 0; i.y < dims().y; ++i.y) {
                for (i.x = 0; i.x < dims().x; ++i.x) {
                    const glm::ivec3 voxel = objectVoxel(i);
                    voxels += static_cast<char>(codeAt(voxel.x, voxel.y, voxel.z));
                }
            }
        }
        const glm::dvec3 first = kOrigin + kEdge * glm::dvec3(objectVoxel({0, 0, 0}));
        return header({{"type", "uchar"},
                       {"sizes", sizes.str()},
                       {"space directions", directions},
                       {"space origin", vectorText(first)}}) +
               voxels;
    }
};

void expectObjectInPlace(const Volume& volume) {
    const glm::dmat4 uvwFromModel = volume.geometry.uvwFromModel();
    glm::ivec3 i{0};
    for (i.z = 0; i.z < kDims.z; ++i.z) {
        for (i.y = 0; i.y < kDims.y; ++i.y) {
            for (i.x = 0; i.x < kDims.x; ++i.x) {
                const glm::dvec3 placeMm = kOrigin + kEdge * glm::dvec3(i);
                const glm::dvec3 uvw(uvwFromModel * glm::dvec4(placeMm, 1.0));
                const glm::dvec3 position = uvw * glm::dvec3(volume.geometry.dims) - 0.5;
                const glm::ivec3 voxel(glm::round(position));
                expectNear(position, glm::dvec3(voxel));
                ASSERT_EQ(volume.valueAt(voxel), codeAt(i.x, i.y, i.z));
            }
        }
    }
}

TEST_F(NrrdTest, permutedAndFlippedAxesKeepEveryVoxelInItsPlace) {
    for (const glm::ivec3& order : std::initializer_list<glm::ivec3>{
             {0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}}) {
        for (int flips = 0; flips < 8; ++flips) {
            const Layout layout{order, {(flips & 1) != 0, (flips & 2) != 0, (flips & 4) != 0}};
            SCOPED_TRACE(vectorText(order) + " flips " + std::to_string(flips));
            const Result<Volume> volume = loadVolume(write("a.nrrd", layout.file()));
            ASSERT_LOADED(volume);
            expectObjectInPlace(*volume);
        }
    }
}

void expectInLps(const Fields& changes, glm::dvec3 spacing, glm::dvec3 origin, glm::dvec3 signs,
                 const std::filesystem::path& path) {
    std::ofstream(path, std::ios::binary) << header(changes) + codes<std::int16_t>();
    const Result<Volume> volume = loadVolume(path);
    ASSERT_LOADED(volume);
    expectCodes(*volume);
    expectGeometry(*volume, spacing, origin,
                   glm::dmat3(signs.x, 0, 0, 0, signs.y, 0, 0, 0, signs.z));
}

TEST_F(NrrdTest, everySpaceIsTurnedToLps) {
    const std::vector<std::pair<const char*, glm::dvec3>> spaces = {
        {"left-posterior-superior", {1, 1, 1}},
        {"LPS", {1, 1, 1}},
        {"lps", {1, 1, 1}},
        {"right-anterior-superior", {-1, -1, 1}},
        {"RAS", {-1, -1, 1}},
        {"left-anterior-superior", {1, -1, 1}},
        {"LAS", {1, -1, 1}},
        {"right-posterior-inferior", {-1, 1, -1}},
    };
    for (const auto& [space, signs] : spaces) {
        SCOPED_TRACE(space);
        expectInLps({{"space", space}}, {0.5, 2, 3}, signs * glm::dvec3(10, -20, 30), signs,
                    at("a.nrrd"));
    }
}

TEST_F(NrrdTest, spacesWithTimeLoseIt) {
    for (const char* space : {"left-anterior-superior-time", "LAST"}) {
        SCOPED_TRACE(space);
        expectInLps({{"dimension", "4"},
                     {"sizes", "5 4 3 1"},
                     {"space", space},
                     {"space directions", "(0.5,0,0,0) (0,2,0,0) (0,0,3,0) (0,0,0,7)"},
                     {"space origin", "(10,-20,30,5)"}},
                    {0.5, 2, 3}, {10, 20, 30}, {1, -1, 1}, at("a.nrrd"));
    }
}

TEST_F(NrrdTest, spacesWithoutSidesAreSaid) {
    for (const char* space : {"scanner-xyz", "3D-right-handed", "3D-left-handed-time", "moon"}) {
        const Result<Volume> volume =
            loadVolume(write("a.nrrd", header({{"space", space}}) + codes<std::int16_t>()));
        ASSERT_LOADED(volume);
        expectGeometry(*volume, {0.5, 2, 3}, {10, -20, 30});
        ASSERT_EQ(volume->notes.size(), 1U);
        EXPECT_NE(volume->notes[0].find(space == std::string("moon") ? "moon" : "d"),
                  std::string::npos);
    }
}

TEST_F(NrrdTest, unitsOfSpaceScaleSpacingAndOrigin) {
    expectInLps({{"space units", "\"microns\" \"microns\" \"microns\""}}, {5e-4, 2e-3, 3e-3},
                {0.01, -0.02, 0.03}, {1, 1, 1}, at("a.nrrd"));
    expectInLps({{"space units", "\"m\" \"cm\" \"mm\""}}, {500, 20, 3}, {1e4, -200, 30}, {1, 1, 1},
                at("a.nrrd"));
    expectInLps({{"space units", "m m m"}, {"space", "RAS"}}, {500, 2000, 3000}, {-1e4, 2e4, 3e4},
                {-1, -1, 1}, at("a.nrrd"));
    expectInLps({{"space", ""},
                 {"space directions", ""},
                 {"space origin", ""},
                 {"spacings", "1 2 3"},
                 {"units", "\"um\" \"um\" \"um\""}},
                {1e-3, 2e-3, 3e-3}, {0, 0, 0}, {1, 1, 1}, at("a.nrrd"));
    const Result<Volume> odd = loadVolume(
        write("b.nrrd", header({{"space units", "\"ell\" \"mm\" \"\""}}) + codes<std::int16_t>()));
    ASSERT_LOADED(odd);
    expectGeometry(*odd, {0.5, 2, 3}, {10, -20, 30});
    ASSERT_EQ(odd->notes.size(), 1U);
    EXPECT_NE(odd->notes[0].find("'ell'"), std::string::npos) << odd->notes[0];
}

TEST_F(NrrdTest, axesWithoutDirectionsRunAlongTheirSpace) {
    Fields fields = {{"space", "left-posterior-superior"},
                     {"space directions", ""},
                     {"space origin", "(10,-20,30)"},
                     {"spacings", "0.5 2 3"}};
    expectInLps(fields, {0.5, 2, 3}, {10, -20, 30}, {1, 1, 1}, at("a.nrrd"));
    fields["space"] = "RAS";
    expectInLps(fields, {0.5, 2, 3}, {-10, 20, 30}, {-1, -1, 1}, at("a.nrrd"));
}

TEST_F(NrrdTest, rangesOfAxesGiveSpacingAndOrigin) {
    Fields fields = {{"space", ""},          {"space directions", ""},
                     {"space origin", ""},   {"axis mins", "1 2 3"},
                     {"axis maxs", "5 8 7"}, {"centers", "node node node"}};
    expectInLps(fields, {1, 2, 2}, {1, 2, 3}, {1, 1, 1}, at("a.nrrd"));
    fields["axis maxs"] = "6 6 6";
    for (const char* centers : {"cell cell cell", ""}) {
        fields["centers"] = centers;
        expectInLps(fields, {1, 1, 1}, {1.5, 2.5, 3.5}, {1, 1, 1}, at("a.nrrd"));
    }
    fields["axis mins"] = "6 2 3";
    fields["axis maxs"] = "1 6 6";
    expectInLps(fields, {1, 1, 1}, {5.5, 2.5, 3.5}, {-1, 1, 1}, at("a.nrrd"));
    fields["spacings"] = "2 4 6";
    fields["axis maxs"] = "";
    fields["centers"] = "node cell ???";
    expectInLps(fields, {2, 4, 6}, {6, 4, 6}, {1, 1, 1}, at("a.nrrd"));
}

TEST_F(NrrdTest, aFurtherAxisOfOneIsDropped) {
    const glm::dvec3 spacing{0.5, 2, 3};
    const glm::dvec3 origin{10, -20, 30};
    for (const char* kind : {"time", "list", "domain", "vector", "scalar", "???"}) {
        SCOPED_TRACE(kind);
        expectInLps({{"dimension", "4"},
                     {"sizes", "5 4 3 1"},
                     {"kinds", std::string("domain domain domain ") + kind},
                     {"space directions", "(0.5,0,0) (0,2,0) (0,0,3) none"}},
                    spacing, origin, {1, 1, 1}, at("a.nrrd"));
        expectInLps({{"dimension", "4"},
                     {"sizes", "1 5 4 3"},
                     {"kinds", std::string(kind) + " domain domain domain"},
                     {"space directions", "none (0.5,0,0) (0,2,0) (0,0,3)"}},
                    spacing, origin, {1, 1, 1}, at("a.nrrd"));
    }
    expectInLps({{"dimension", "5"},
                 {"sizes", "5 4 3 1 1"},
                 {"space directions", "(0.5,0,0) (0,2,0) (0,0,3) none none"}},
                spacing, origin, {1, 1, 1}, at("a.nrrd"));
    expectInLps({{"dimension", "4"},
                 {"sizes", "5 4 3 1"},
                 {"space", ""},
                 {"space directions", ""},
                 {"space origin", ""},
                 {"spacings", "0.5 2 3 nan"}},
                spacing, {0, 0, 0}, {1, 1, 1}, at("a.nrrd"));
}

TEST_F(NrrdTest, oneOfSeveralTimesIsTaken) {
    const std::string voxels =
        std::string(120, 'x') + codes<std::int16_t>() + std::string(120, 'x');
    for (const char* kind : {"time", "list", "???"}) {
        SCOPED_TRACE(kind);
        const auto path =
            write("a.nrrd", header({{"dimension", "4"},
                                    {"sizes", "5 4 3 3"},
                                    {"kinds", std::string("domain domain domain ") + kind},
                                    {"space directions", "(0.5,0,0) (0,2,0) (0,0,3) none"}}) +
                                voxels);
        expectFailure(loadVolume(path), ErrorCode::UnsupportedDims, path.string(),
                      "3 volumes over time; take one with --time 0 to --time 2");
        LoadOptions options;
        options.time = 1;
        const Result<Volume> volume = loadVolume(path, options);
        ASSERT_LOADED(volume);
        expectCodes(*volume);
        options.time = 3;
        expectFailure(loadVolume(path, options), ErrorCode::InvalidArgument, path.string(),
                      "from 0 to 2");
    }
    const auto mixed = write("b.nrrd", header({{"dimension", "4"},
                                               {"sizes", "3 5 4 3"},
                                               {"kinds", "time domain domain domain"},
                                               {"space directions", ""}}) +
                                           voxels);
    expectFailure(loadVolume(mixed), ErrorCode::UnsupportedDims, mixed.string(), "extract");
}

TEST_F(NrrdTest, textVoxelsAreRead) {
    for (const char* between : {" ", ",", ", ", "\n"}) {
        std::string text;
        for (int i = 0; i < 60; ++i) {
            text += std::to_string(i) + between;
        }
        const Result<Volume> volume = loadVolume(
            write("a.nrrd", header({{"encoding", "ascii"}, {"endian", ""}}) + text + "\n"));
        ASSERT_LOADED(volume);
        EXPECT_EQ(volume->type, VoxelType::I16);
        expectCodes(*volume);
    }
    const auto word = write("b.nrrd", header({{"encoding", "ascii"}}) + std::string(5000, '1'));
    expectFailure(loadVolume(word), ErrorCode::FileUnreadable, word.string(), "int16");
    const auto few = write("c.nrrd", header({{"encoding", "txt"}}) + std::string(200, ' ') + "1 2");
    expectFailure(loadVolume(few), ErrorCode::FileTruncated, few.string(), "after 2 voxels");
}

TEST_F(NrrdTest, hexVoxelsAreRead) {
    std::string text;
    for (int i = 0; i < 60; ++i) {
        std::ostringstream byte;
        byte << std::hex << i;
        text += (i < 16 ? "000" : "00") + byte.str() + (i % 9 == 0 ? "\n" : "");
    }
    const Result<Volume> volume =
        loadVolume(write("a.nrrd", header({{"encoding", "hex"}, {"endian", "big"}}) + text));
    ASSERT_LOADED(volume);
    expectCodes(*volume);
}

TEST_F(NrrdTest, skipsComeBeforeAndWithinGzip) {
    writeGz("z.gz", "skipped!" + codes<std::int16_t>());
    std::ifstream stream(at("z.gz"), std::ios::binary);
    const std::string packed{std::istreambuf_iterator<char>(stream), {}};
    const Result<Volume> attached = loadVolume(
        write("a.nrrd", header({{"encoding", "gzip"}, {"line skip", "2"}, {"byte skip", "8"}}) +
                            "one\ntwo\n" + packed));
    ASSERT_LOADED(attached);
    expectCodes(*attached);
    write("b.gz", "one\n" + packed);
    for (const char* skip : {"8", "-1"}) {
        const Result<Volume> detached =
            loadVolume(write("b.nhdr", header({{"encoding", "gz"},
                                               {"line skip", "1"},
                                               {"byte skip", skip},
                                               {"data file", "b.gz"}})));
        ASSERT_LOADED(detached);
        expectCodes(*detached);
    }
    write("c.raw", "one\nxx" + codes<std::int16_t>());
    for (const char* skip : {"2", "-1"}) {
        const Result<Volume> raw = loadVolume(write(
            "c.nhdr", header({{"line skip", "1"}, {"byte skip", skip}, {"data file", "c.raw"}})));
        ASSERT_LOADED(raw);
        expectCodes(*raw);
    }
}

TEST_F(NrrdTest, slicesInFilesOfTheirOwnAreRead) {
    const std::string voxels = codes<std::int16_t>();
    for (int i = 0; i < 3; ++i) {
        write("s" + std::to_string(i + 7) + ".raw",
              voxels.substr(static_cast<std::size_t>(40 * i), 40));
    }
    const std::string list = "LIST\ns7.raw\ns8.raw\n\ns9.raw\n";
    for (const std::string& files :
         {list, std::string("s%d.raw 7 9 1"), "LIST 2" + list.substr(4)}) {
        const auto path = write("a.nhdr", header({{"data file", files}}));
        const Result<Volume> volume = loadVolume(path);
        ASSERT_LOADED(volume);
        expectCodes(*volume);
    }
    truncate(at("s8.raw"), 39);
    const auto path = write("a.nhdr", header({{"data file", list}}));
    expectFailure(loadVolume(path), ErrorCode::FileTruncated, path.string(), "s8.raw has 39 bytes");
    std::filesystem::remove(at("s8.raw"));
    expectFailure(loadVolume(path), ErrorCode::FileNotFound, path.string(), "s8.raw, which is not");
}

TEST_F(NrrdTest, integersOf64BitsAreReadWhereTheyFit) {
    expectType<std::int32_t>(write("a.nrrd", header({{"type", "int64"}}) + codes<std::int64_t>()),
                             VoxelType::I32);
    expectType<std::int32_t>(
        write("a.nrrd", header({{"type", "unsigned long long int"}, {"endian", "big"}}) +
                            codes<std::int64_t>(kDims, true)),
        VoxelType::I32);
}

struct BadHeader {
    Fields changes;
    ErrorCode code;
    std::string_view remedy;
};

TEST_F(NrrdTest, headersThatLieAreNamed) {
    const std::vector<BadHeader> cases = {
        {{{"sizes", "5 4 4"}}, ErrorCode::FileTruncated, "fetch the file again"},
        {{{"sizes", "50000 40000 30000"}}, ErrorCode::FileTruncated, "correct the sizes"},
        {{{"sizes", "4000000000 4000000000 4000000000"}}, ErrorCode::SizeOverflow, ";"},
        {{{"sizes", "5 4 99999999999999999999999999"}}, ErrorCode::SizeOverflow, ";"},
        {{{"sizes", "5 0 3"}}, ErrorCode::EmptyVolume, "export"},
        {{{"sizes", "5 -4 3"}}, ErrorCode::EmptyVolume, "export"},
        {{{"sizes", "5 x 3"}}, ErrorCode::FileUnreadable, "check"},
        {{{"sizes", "5 4"}}, ErrorCode::FileUnreadable, "check"},
        {{{"dimension", "2"}, {"sizes", "5 4"}, {"space directions", ""}, {"space", ""}},
         ErrorCode::UnsupportedDims,
         "stack"},
        {{{"dimension", "0"}, {"sizes", ""}}, ErrorCode::UnsupportedDims, "stack"},
        {{{"dimension", "4"}, {"sizes", "5 4 1 3"}}, ErrorCode::UnsupportedDims, "extract"},
        {{{"dimension", "4"}, {"sizes", "3 5 4 1"}, {"kinds", "RGB-color domain domain domain"}},
         ErrorCode::UnsupportedType,
         "grey"},
        {{{"type", "block"}}, ErrorCode::UnsupportedType, "convert"},
        {{{"type", "int64"}}, ErrorCode::FileTruncated, "fetch"},
        {{{"type", "long double"}}, ErrorCode::UnsupportedType, "'long double'"},
        {{{"endian", ""}}, ErrorCode::FileUnreadable, "'endian: little'"},
        {{{"endian", "middle"}}, ErrorCode::FileUnreadable, "'endian'"},
        {{{"encoding", "bzip2"}},
         ErrorCode::UnsupportedType,
         "bzip2 is not read; save it with gzip"},
        {{{"encoding", "bz2"}}, ErrorCode::UnsupportedType, "bzip2 is not read; save it with gzip"},
        {{{"encoding", ""}}, ErrorCode::FileUnreadable, "'encoding'"},
        {{{"spacing", "1 1 2"}}, ErrorCode::FileUnreadable, "'spacing' is no field"},
        {{{"byte skip", "x"}}, ErrorCode::FileUnreadable, "'byte skip'"},
        {{{"line skip", "-1"}}, ErrorCode::FileUnreadable, "'line skip'"},
        {{{"line skip", "9999999999"}}, ErrorCode::FileTruncated, "fetch"},
        {{{"space directions", "(1,0,0) (0,1,0) (0,0,1) (0,0,1)"}},
         ErrorCode::FileUnreadable,
         "4 vectors for 3"},
        {{{"space", ""}, {"space directions", ""}, {"space origin", ""}, {"spacings", "1 2"}},
         ErrorCode::FileUnreadable,
         "2 numbers for 3"},
        {{{"encoding", "pigeon"}}, ErrorCode::FileUnreadable, "check"},
        {{{"space directions", "(0,0,0) (0,2,0) (0,0,3)"}}, ErrorCode::InvalidGeometry, "spacing"},
        {{{"space directions", "(nan,0,0) (0,2,0) (0,0,3)"}},
         ErrorCode::InvalidGeometry,
         "spacing"},
        {{{"space directions", "(1,0,0) (1,0,0) (0,0,3)"}}, ErrorCode::InvalidGeometry, "correct"},
        {{{"space", ""}, {"space directions", ""}, {"space origin", ""}, {"spacings", "1 0 3"}},
         ErrorCode::InvalidGeometry,
         "spacing"},
        {{{"space", ""}, {"space directions", ""}, {"space origin", ""}, {"spacings", "1 nan 3"}},
         ErrorCode::InvalidGeometry,
         "spacing"},
        {{{"data file", "gone.raw"}}, ErrorCode::FileNotFound, "keep both"},
    };
    for (std::size_t i = 0; i < cases.size(); ++i) {
        SCOPED_TRACE(i);
        const auto path = write("a.nrrd", header(cases[i].changes) + codes<std::int16_t>());
        expectFailure(loadVolume(path), cases[i].code, path.string(), cases[i].remedy);
    }
}

TEST_F(NrrdTest, damagedFilesAreNamed) {
    const auto path = write("a.nrrd", header() + codes<std::int16_t>());
    truncate(path, std::filesystem::file_size(path) - 1);
    expectFailure(loadVolume(path), ErrorCode::FileTruncated, path.string(), "fetch");
    expectFailure(loadVolume(write("b.nrrd", "no header at all")), ErrorCode::FileUnreadable,
                  "b.nrrd", "check");
    expectFailure(loadVolume(write("c.nrrd", "")), ErrorCode::FileUnreadable, "c.nrrd", "check");
}

TEST_F(NrrdTest, truncatedGzipIsNamed) {
    const glm::ivec3 dims{50, 40, 30};
    writeGz("z.gz", codes<std::int16_t>(dims));
    std::ifstream stream(at("z.gz"), std::ios::binary);
    const std::string packed{std::istreambuf_iterator<char>(stream), {}};
    const std::string head = header({{"encoding", "gzip"}, {"sizes", "50 40 30"}});
    ASSERT_LOADED(loadVolume(write("whole.nrrd", head + packed)));
    for (const std::size_t kept :
         {packed.size() - 5, packed.size() - 9, packed.size() / 2, std::size_t{11}}) {
        SCOPED_TRACE(kept);
        expectFailure(loadVolume(write("a.nrrd", head + packed.substr(0, kept))),
                      ErrorCode::FileTruncated, "a.nrrd", "fetch");
    }
    const std::string bigger = header({{"encoding", "gzip"}, {"sizes", "50 40 31"}});
    expectFailure(loadVolume(write("b.nrrd", bigger + packed)), ErrorCode::FileTruncated, "b.nrrd",
                  "fetch");
    const std::string huge = header({{"encoding", "gzip"}, {"sizes", "50000 40000 31"}});
    expectFailure(loadVolume(write("c.nrrd", huge + packed)), ErrorCode::FileTruncated, "c.nrrd",
                  "fetch");
}

} // namespace
} // namespace slabcast::test
