#include "tests/support/io_test_support.h"

#include <map>

namespace slabcast::test {
namespace {

class MetaTest : public IoTest {};

using Fields = std::map<std::string, std::string>;

std::string header(const Fields& changes = {}) {
    Fields fields = {{"ObjectType", "Image"},
                     {"NDims", "3"},
                     {"BinaryData", "True"},
                     {"BinaryDataByteOrderMSB", "False"},
                     {"TransformMatrix", "0.6 0.8 0 -0.8 0.6 0 0 0 1"},
                     {"Offset", "10 -20 30"},
                     {"ElementSpacing", "0.5 2 3"},
                     {"DimSize", "5 4 3"},
                     {"ElementType", "MET_SHORT"},
                     {"ElementDataFile", "LOCAL"}};
    for (const auto& [name, value] : changes) {
        fields[name] = value;
    }
    std::string text;
    for (const char* name :
         {"ObjectType", "NDims", "BinaryData", "BinaryDataByteOrderMSB", "CompressedData",
          "CompressedDataSize", "TransformMatrix", "Offset", "ElementSpacing", "DimSize",
          "ElementNumberOfChannels", "ElementToIntensityFunctionSlope",
          "ElementToIntensityFunctionOffset", "DistanceUnits", "Modality", "HeaderSize",
          "ElementType", "ElementDataFile"}) {
        const auto field = fields.find(name);
        if (field != fields.end() && !field->second.empty()) {
            text += field->first + " = " + field->second + "\n";
        }
    }
    return text;
}

void expectWhole(const Result<Volume>& volume) {
    ASSERT_LOADED(volume);
    EXPECT_EQ(volume->type, VoxelType::I16);
    expectCodes(*volume);
    expectGeometry(*volume, {0.5, 2, 3}, {10, -20, 30},
                   glm::dmat3(0.6, 0.8, 0, -0.8, 0.6, 0, 0, 0, 1));
}

TEST_F(MetaTest, localFileKeepsVoxelsAndGeometry) {
    expectWhole(loadVolume(write("a.mha", header() + codes<std::int16_t>())));
}

TEST_F(MetaTest, detachedFileIsReadFromBesideTheHeader) {
    write("a.raw", "12345678" + codes<std::int16_t>());
    expectWhole(
        loadVolume(write("a.mhd", header({{"ElementDataFile", "a.raw"}, {"HeaderSize", "8"}}))));
    expectWhole(
        loadVolume(write("b.mhd", header({{"ElementDataFile", "a.raw"}, {"HeaderSize", "-1"}}))));
}

TEST_F(MetaTest, bigEndianIsSwapped) {
    expectWhole(loadVolume(write("a.mha", header({{"BinaryDataByteOrderMSB", "True"}}) +
                                              codes<std::int16_t>(kDims, true))));
}

TEST_F(MetaTest, modalityIsTaken) {
    const Result<Volume> volume =
        loadVolume(write("a.mha", header({{"Modality", "MET_MOD_CT"}}) + codes<std::int16_t>()));
    ASSERT_LOADED(volume);
    EXPECT_EQ(volume->modality, Modality::Ct);
}

std::string deflated(const std::string& plain) {
    uLongf size = compressBound(plain.size());
    std::string packed(size, '\0');
    compress(reinterpret_cast<Bytef*>(packed.data()), &size,
             reinterpret_cast<const Bytef*>(plain.data()), plain.size());
    packed.resize(size);
    return packed;
}

TEST_F(MetaTest, compressedFileIsReadAndItsTruncationNamed) {
    const std::string packed = deflated(codes<std::int16_t>());
    const std::string head =
        header({{"CompressedData", "True"}, {"CompressedDataSize", std::to_string(packed.size())}});
    expectWhole(loadVolume(write("a.mha", head + packed)));
    expectFailure(loadVolume(write("b.mha", header({{"CompressedData", "True"}}) + packed)),
                  ErrorCode::FileUnreadable, "b.mha", "CompressedDataSize");
    for (const std::size_t kept : {packed.size() - 10, packed.size() / 2, std::size_t{1}}) {
        SCOPED_TRACE(kept);
        expectFailure(loadVolume(write("c.mha", head + packed.substr(0, kept))),
                      ErrorCode::FileTruncated, "c.mha", "fetch");
    }
}

TEST_F(MetaTest, negativeSpacingIsADirection) {
    const Result<Volume> volume = loadVolume(
        write("a.mha", header({{"ElementSpacing", "0.5 2 -3"}, {"TransformMatrix", ""}}) +
                           codes<std::int16_t>()));
    ASSERT_LOADED(volume);
    expectCodes(*volume);
    expectGeometry(*volume, {0.5, 2, 3}, {10, -20, 30}, glm::dmat3(1, 0, 0, 0, 1, 0, 0, 0, -1));
}

TEST_F(MetaTest, headersThatLieAreNamed) {
    struct Bad {
        Fields changes;
        ErrorCode code;
        std::string_view remedy;
    };
    const std::vector<Bad> cases = {
        {{{"DimSize", "5 4 4"}}, ErrorCode::FileTruncated, "fetch"},
        {{{"DimSize", "4000000000 4000000000 4000000000"}}, ErrorCode::SizeOverflow, ";"},
        {{{"DimSize", "5 0 3"}}, ErrorCode::EmptyVolume, "export"},
        {{{"NDims", "2"}, {"DimSize", "5 4"}}, ErrorCode::UnsupportedDims, "stack"},
        {{{"NDims", "4"}, {"DimSize", "5 4 1 3"}}, ErrorCode::UnsupportedDims, "extract"},
        {{{"NDims", "0"}, {"DimSize", ""}}, ErrorCode::UnsupportedDims, "stack"},
        {{{"NDims", "2"}}, ErrorCode::FileUnreadable, "check"},
        {{{"ElementNumberOfChannels", "3"}}, ErrorCode::UnsupportedType, "grey"},
        {{{"ElementType", "MET_STRING"}}, ErrorCode::UnsupportedType, "convert"},
        {{{"ElementType", "MET_LONG_LONG"}}, ErrorCode::FileTruncated, "fetch"},
        {{{"ElementToIntensityFunctionSlope", "x"}},
         ErrorCode::FileUnreadable,
         "'ElementToIntensityFunctionSlope'"},
        {{{"Offset", "1 2"}}, ErrorCode::FileUnreadable, "'Offset' should hold 3 numbers"},
        {{{"TransformMatrix", "1 0 0"}}, ErrorCode::FileUnreadable, "9 numbers"},
        {{{"HeaderSize", "-2"}}, ErrorCode::FileUnreadable, "'HeaderSize'"},
        {{{"ElementSpacing", "0.5 0 3"}}, ErrorCode::InvalidGeometry, "spacing"},
        {{{"ElementSpacing", "0.5 nan 3"}}, ErrorCode::InvalidGeometry, "spacing"},
        {{{"ElementDataFile", "gone.raw"}}, ErrorCode::FileNotFound, "keep both"},
        {{{"ElementDataFile", ""}}, ErrorCode::FileUnreadable, "check"},
        {{{"TransformMatrix", "1 0 0 1 0 0 0 0 1"}}, ErrorCode::InvalidGeometry, "correct"},
    };
    for (std::size_t i = 0; i < cases.size(); ++i) {
        SCOPED_TRACE(i);
        const auto path = write("a.mha", header(cases[i].changes) + codes<std::int16_t>());
        expectFailure(loadVolume(path), cases[i].code, path.string(), cases[i].remedy);
    }
}

TEST_F(MetaTest, deflatedFilesOfTheirOwnNeedNoSize) {
    const std::string packed = deflated(codes<std::int16_t>());
    write("a.zraw", packed);
    for (const char* yes : {"True", "true", "1", "T"}) {
        SCOPED_TRACE(yes);
        expectWhole(loadVolume(
            write("a.mhd", header({{"CompressedData", yes}, {"ElementDataFile", "a.zraw"}}))));
        expectWhole(loadVolume(
            write("a.mha", header({{"CompressedData", yes},
                                   {"CompressedDataSize", std::to_string(packed.size())}}) +
                               packed)));
    }
    write("a.zraw", packed.substr(0, packed.size() - 3));
    const auto path =
        write("b.mhd", header({{"CompressedData", "True"}, {"ElementDataFile", "a.zraw"}}));
    expectFailure(loadVolume(path), ErrorCode::FileTruncated, path.string(), "a.zraw");
}

TEST_F(MetaTest, truthIsWrittenInSeveralWays) {
    for (const char* yes : {"True", "true", "1"}) {
        expectWhole(loadVolume(
            write("a.mha", header({{"BinaryData", yes}, {"BinaryDataByteOrderMSB", yes}}) +
                               codes<std::int16_t>(kDims, true))));
    }
    for (const char* no : {"False", "false", "0"}) {
        std::string text;
        for (int i = 0; i < 60; ++i) {
            text += std::to_string(i) + (i % 5 == 4 ? "\n" : " ");
        }
        expectWhole(loadVolume(write("a.mha", header({{"BinaryData", no}}) + text)));
    }
}

TEST_F(MetaTest, slicesInFilesOfTheirOwnAreRead) {
    const std::string voxels = codes<std::int16_t>();
    for (int i = 0; i < 3; ++i) {
        write("s00" + std::to_string(i + 1) + ".raw",
              voxels.substr(static_cast<std::size_t>(40 * i), 40));
    }
    const std::string names = "\ns001.raw\ns002.raw\ns003.raw\n";
    for (const std::string& files :
         {"LIST" + names, "LIST 2D" + names, std::string("s%03d.raw 1 3 1")}) {
        expectWhole(loadVolume(write("a.mhd", header({{"ElementDataFile", files}}))));
    }
    const auto path = write("b.mhd", header({{"ElementDataFile", "LIST" + names}}));
    truncate(at("s002.raw"), 39);
    expectFailure(loadVolume(path), ErrorCode::FileTruncated, path.string(),
                  "s002.raw has 39 bytes");
    std::filesystem::remove(at("s002.raw"));
    expectFailure(loadVolume(path), ErrorCode::FileNotFound, path.string(), "s002.raw");
    const auto few = write("c.mhd", header({{"ElementDataFile", "LIST\ns001.raw\n"}}));
    expectFailure(loadVolume(few), ErrorCode::FileUnreadable, few.string(), "lists 1 files");
}

TEST_F(MetaTest, intensityFunctionIsApplied) {
    const Result<Volume> volume =
        loadVolume(write("a.mha", header({{"ElementToIntensityFunctionSlope", "2"},
                                          {"ElementToIntensityFunctionOffset", "-24"}}) +
                                      codes<std::int16_t>()));
    ASSERT_LOADED(volume);
    EXPECT_EQ(volume->valueAt({0, 0, 0}), -24.0);
    EXPECT_EQ(volume->valueAt({4, 3, 2}), 2.0 * codeAt(4, 3, 2) - 24.0);
    expectWhole(loadVolume(write("b.mha", header({{"ElementToIntensityFunctionSlope", "1"},
                                                  {"ElementToIntensityFunctionOffset", "0"}}) +
                                              codes<std::int16_t>())));
}

TEST_F(MetaTest, oneOfSeveralTimesIsTaken) {
    const Fields four = {{"NDims", "4"},
                         {"DimSize", "5 4 3 2"},
                         {"TransformMatrix", "0.6 0.8 0 0 -0.8 0.6 0 0 0 0 1 0 0 0 0 1"},
                         {"Offset", "10 -20 30 0"},
                         {"ElementSpacing", "0.5 2 3 1"}};
    const auto path = write("a.mha", header(four) + std::string(120, 'x') + codes<std::int16_t>());
    expectFailure(loadVolume(path), ErrorCode::UnsupportedDims, path.string(),
                  "--time 0 to --time 1");
    LoadOptions options;
    options.time = 1;
    expectWhole(loadVolume(path, options));
    Fields one = four;
    one["DimSize"] = "5 4 3 1";
    expectWhole(loadVolume(write("b.mha", header(one) + codes<std::int16_t>())));
}

TEST_F(MetaTest, unitsOfDistanceScale) {
    const Result<Volume> volume =
        loadVolume(write("a.mha", header({{"DistanceUnits", "um"}}) + codes<std::int16_t>()));
    ASSERT_LOADED(volume);
    expectNear(volume->geometry.spacingMm, {5e-4, 2e-3, 3e-3}, 1e-12);
    expectNear(volume->geometry.originMm, {0.01, -0.02, 0.03}, 1e-12);
}

TEST_F(MetaTest, integersOf64BitsAreReadWhereTheyFit) {
    const Result<Volume> volume = loadVolume(
        write("a.mha", header({{"ElementType", "MET_LONG_LONG"}}) + codes<std::int64_t>()));
    ASSERT_LOADED(volume);
    EXPECT_EQ(volume->type, VoxelType::I32);
    expectCodes(*volume);
}

TEST_F(MetaTest, truncatedFileIsNamed) {
    const auto path = write("a.mha", header() + codes<std::int16_t>());
    truncate(path, std::filesystem::file_size(path) - 1);
    expectFailure(loadVolume(path), ErrorCode::FileTruncated, path.string(), "fetch");
    expectFailure(loadVolume(write("b.mha", "")), ErrorCode::FileUnreadable, "b.mha", "check");
    expectFailure(loadVolume(write("c.mha", "NDims = 3\n")), ErrorCode::FileUnreadable, "c.mha",
                  "check");
}

} // namespace
} // namespace slabcast::test
