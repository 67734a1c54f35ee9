// Headers in memory: no file is there but where one is named.
#include "tests/support/io_test_support.h"

#include "platform/io/volumes/file_header.h"
#include "platform/io/volumes/length_unit.h"
#include "platform/io/volumes/text_header.h"

namespace slabcast::test {
namespace {

TEST(LengthUnit, namesAndSignsOfUnitsAreKnown) {
    for (const char* unit : {"mm", "MM", "millimeters", "millimetre", " mm "}) {
        EXPECT_EQ(millimetresPer(unit), 1.0) << unit;
    }
    for (const char* unit : {"um", "microns", "Micron", "micrometre", "micrometers", "\xC2\xB5m",
                             "\xCE\xBCm", "\xB5m"}) {
        EXPECT_EQ(millimetresPer(unit), 1e-3) << unit;
    }
    EXPECT_EQ(millimetresPer("m"), 1e3);
    EXPECT_EQ(millimetresPer("metres"), 1e3);
    EXPECT_EQ(millimetresPer("cm"), 10.0);
    EXPECT_EQ(millimetresPer("nm"), 1e-6);
    EXPECT_EQ(millimetresPer("s"), std::nullopt);
    EXPECT_EQ(millimetresPer("furlong"), std::nullopt);
    EXPECT_TRUE(isNoUnit("???"));
    EXPECT_FALSE(isNoUnit("furlong"));
}

TEST(TextHeader, fieldsKeysAndTheirEndAreFound) {
    const std::string text = "NRRD0005\n# type: float\nType: short\r\nkey:=a: b\n\nvoxels: 3\n";
    const Result<TextHeader> header = parseNrrdText("a.nrrd", text);
    ASSERT_TRUE(header) << header.error().detail;
    EXPECT_EQ(header->findOr({"type"}, ""), "short");
    EXPECT_EQ(header->keys.at("key"), "a: b");
    EXPECT_EQ(header->bytes, static_cast<std::int64_t>(text.find("voxels")));
    EXPECT_TRUE(header->ended);
    EXPECT_EQ(header->find({"voxels"}), std::nullopt);
}

TEST(TextHeader, whatIsNoFieldOrTwoIsRefused) {
    for (const char* text :
         {"NRRD0005\ntype: short\ntype: float\n", "NRRD0005\nnonsense\n", "MZ0005\n", ""}) {
        const Result<TextHeader> header = parseNrrdText("a.nrrd", text);
        ASSERT_FALSE(header) << text;
        EXPECT_EQ(header.error().code, ErrorCode::FileUnreadable);
    }
    EXPECT_TRUE(parseNrrdText("a.nrrd", "NRRD0005\ntype: short\ntype: short\n"));
    EXPECT_FALSE(parseMetaText("a.mha", "NDims = 3\nNDims = 2\n"));
}

TEST(TextHeader, messagesHoldNoControlCharacters) {
    EXPECT_EQ(printable("a\tb\x1B[31m"), "a?b?[31m");
    EXPECT_LT(printable(std::string(1000, 'x')).size(), 70U);
}

using Sizes = std::vector<std::int64_t>;

std::vector<std::string> filesOf(const std::string& written, const Sizes& sizes,
                                 std::vector<std::string> listed = {}) {
    TextHeader text;
    text.listed = std::move(listed);
    const auto files = dataFiles("/in/a.nhdr", text, written, sizes);
    std::vector<std::string> names;
    if (!files) {
        EXPECT_EQ(files.error().code, ErrorCode::FileUnreadable);
        return {"refused"};
    }
    for (const auto& file : *files) {
        names.push_back(file.string());
    }
    return names;
}

TEST(DataFiles, listsAndPatternsNameThem) {
    using Names = std::vector<std::string>;
    EXPECT_EQ(filesOf("my voxels.raw", {5, 4, 3}), Names{"/in/my voxels.raw"});
    EXPECT_EQ(filesOf("/else/a.raw", {5, 4, 3}), Names{"/else/a.raw"});
    EXPECT_EQ(filesOf("LIST", {5, 4, 2}, {"b.raw", "a.raw"}), (Names{"/in/b.raw", "/in/a.raw"}));
    EXPECT_EQ(filesOf("LIST 2D", {5, 4, 2}, {"b.raw", "a.raw"}), (Names{"/in/b.raw", "/in/a.raw"}));
    EXPECT_EQ(filesOf("LIST 1", {5, 2, 1}, {"b.raw", "a.raw"}), (Names{"/in/b.raw", "/in/a.raw"}));
    EXPECT_EQ(filesOf("LIST 3", {5, 4, 6}, {"b.raw", "a.raw"}), (Names{"/in/b.raw", "/in/a.raw"}));
    EXPECT_EQ(filesOf("s%03d.raw 9 11 1", {5, 4, 3}),
              (Names{"/in/s009.raw", "/in/s010.raw", "/in/s011.raw"}));
    EXPECT_EQ(filesOf("s%d.raw 10 6 -2", {5, 4, 3}),
              (Names{"/in/s10.raw", "/in/s8.raw", "/in/s6.raw"}));
    EXPECT_EQ(filesOf("s%d.raw 0 1 1 3", {5, 4, 6}), (Names{"/in/s0.raw", "/in/s1.raw"}));
}

TEST(DataFiles, asManyAsTheSizesAskFor) {
    const std::vector<std::string> refused = {"refused"};
    EXPECT_EQ(filesOf("LIST", {5, 4, 3}, {"b.raw", "a.raw"}), refused);
    EXPECT_EQ(filesOf("LIST", {5, 4, 2}), refused);
    EXPECT_EQ(filesOf("LIST 4", {5, 4, 2}, {"b.raw", "a.raw"}), refused);
    EXPECT_EQ(filesOf("LIST 3", {5, 4, 3}, {"b.raw", "a.raw"}), refused);
    EXPECT_EQ(filesOf("LIST x", {5, 4, 2}, {"b.raw", "a.raw"}), refused);
    EXPECT_EQ(filesOf("s%d.raw 0 5 1", {5, 4, 3}), refused);
    EXPECT_EQ(filesOf("s%d.raw 0 5 0", {5, 4, 3}), refused);
    EXPECT_EQ(filesOf("s%s.raw 0 2 1", {5, 4, 3}), refused);
    EXPECT_EQ(filesOf("s%d%n.raw 0 2 1", {5, 4, 3}), refused);
    EXPECT_EQ(filesOf("s%d.raw 0 2", {5, 4, 3}), refused);
    EXPECT_EQ(filesOf("s%d.raw 1 9223372036854775807 1", {5, 4, 9223372036854775807}), refused);
    EXPECT_EQ(filesOf("s%d.raw -9223372036854775808 9223372036854775807 1 1",
                      {5, 9223372036854775807, 9223372036854775807}),
              refused);
}

TEST(Headers, areParsedFromMemory) {
    const Result<FileHeader> nrrd = parseNrrdHeader(
        "NRRD0004\ntype: int64\ndimension: 3\nsizes: 5 4 3\nencoding: hex\nendian: big\n"
        "data file: b.hex\n",
        "/in/a.nhdr");
    ASSERT_TRUE(nrrd) << nrrd.error().detail;
    EXPECT_EQ(nrrd->sizes, (Sizes{5, 4, 3}));
    EXPECT_EQ(nrrd->type->wide, Wide::Signed);
    EXPECT_EQ(nrrd->source.files, std::vector<std::filesystem::path>{"/in/b.hex"});
    EXPECT_EQ(nrrd->bigEndian, true);
    const Result<FileHeader> meta = parseMetaHeader(
        "NDims = 4\nDimSize = 5 4 3 7\nElementType = MET_FLOAT\nElementDataFile = LOCAL\n",
        "a.mha");
    ASSERT_TRUE(meta) << meta.error().detail;
    EXPECT_EQ(meta->times, 7);
    EXPECT_EQ(meta->sizes, (Sizes{5, 4, 3}));
    EXPECT_EQ(parseNiftiHeader(std::string(352, '\0'), "a.nii", false).error().code,
              ErrorCode::FileUnreadable);
    EXPECT_EQ(parseNiftiHeader("\x5c", "a.nii", false).error().code, ErrorCode::FileTruncated);
}

TEST(Headers, cutAnywhereDoNoHarm) {
    const std::string nrrd =
        "NRRD0004\ntype: short\ndimension: 4\nspace: RAST\nsizes: 5 4 3 1\nspace directions: "
        "(1,0,0,0) (0,1,0,0) (0,0,1,0) (0,0,0,1)\nspace units: \"mm\" \"um\" \"m\" \"s\"\nspace "
        "origin: (1,2,3,4)\naxis mins: 1 2 3 4\nkinds: domain domain domain time\ndata file: "
        "s%d.raw 1 3 1 2\n\n";
    for (std::size_t kept = 0; kept <= nrrd.size(); ++kept) {
        parseNrrdHeader(nrrd.substr(0, kept), "a.nrrd");
    }
    const std::string meta =
        "NDims = 3\nDimSize = 5 4 3\nTransformMatrix = 1 0 0 0 1 0 0 0 1\nOffset = 1 2 3\n"
        "ElementSpacing = 1 -2 3\nElementType = MET_SHORT\nElementDataFile = LIST 2D\na\nb\nc\n";
    for (std::size_t kept = 0; kept <= meta.size(); ++kept) {
        parseMetaHeader(meta.substr(0, kept), "a.mha");
    }
}

} // namespace
} // namespace slabcast::test
