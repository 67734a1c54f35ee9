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
          "ElementNumberOfChannels", "Modality", "HeaderSize", "ElementType", "ElementDataFile"}) {
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
        {{{"ElementType", "MET_LONG_LONG"}}, ErrorCode::UnsupportedType, "convert"},
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
