#include "platform/io/file_header.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <memory>

#include <fmt/format.h>
#include <zlib.h>

namespace slabcast {

namespace {

constexpr int kHeaderBytes = 348;

// Byte positions in the header: nifti1.h, "struct nifti_1_header".
constexpr std::size_t kDimAt = 40;
constexpr std::size_t kDatatypeAt = 70;
constexpr std::size_t kPixdimAt = 76;
constexpr std::size_t kVoxOffsetAt = 108;

/// Reads numbers of either byte order; the first field, a small number, tells which.
class HeaderBytes {
public:
    std::array<char, kHeaderBytes> bytes{};

    template <class T>
    T at(std::size_t position) const {
        std::array<char, sizeof(T)> raw{};
        std::copy_n(bytes.begin() + position, sizeof(T), raw.begin());
        if (swapped_) {
            std::reverse(raw.begin(), raw.end());
        }
        return std::bit_cast<T>(raw);
    }

    std::int32_t detectOrder() {
        const auto size = at<std::int32_t>(0);
        swapped_ = size < 0 || size > 0xFFFF;
        return at<std::int32_t>(0);
    }

private:
    bool swapped_ = false;
};

struct NiftiType {
    std::int16_t code;
    VoxelType type;
    const char* name;
};

constexpr std::array<NiftiType, 8> kTypes = {{{2, VoxelType::U8, "uint8"},
                                              {4, VoxelType::I16, "int16"},
                                              {8, VoxelType::I32, "int32"},
                                              {16, VoxelType::F32, "float32"},
                                              {64, VoxelType::F64, "float64"},
                                              {256, VoxelType::I8, "int8"},
                                              {512, VoxelType::U16, "uint16"},
                                              {768, VoxelType::U32, "uint32"}}};

constexpr std::int16_t kRgb24 = 128;
constexpr std::int16_t kRgba32 = 2304;

/// gzread also passes plain files through, so one path serves .nii and .nii.gz.
bool readStart(const std::filesystem::path& path, HeaderBytes& header, bool& compressed) {
    const std::unique_ptr<gzFile_s, int (*)(gzFile)> file(gzopen(path.c_str(), "rb"), gzclose);
    if (!file || gzread(file.get(), header.bytes.data(), kHeaderBytes) != kHeaderBytes) {
        return false;
    }
    compressed = gzdirect(file.get()) == 0;
    return true;
}

void setType(FileHeader& header, std::int16_t code) {
    const auto found = std::find_if(kTypes.begin(), kTypes.end(),
                                    [&](const NiftiType& entry) { return entry.code == code; });
    header.typeKnown = found != kTypes.end();
    header.type = header.typeKnown ? found->type : VoxelType::U8;
    header.typeName = header.typeKnown ? found->name : fmt::format("code {}", code);
    if (code == kRgb24 || code == kRgba32) {
        header.components = code == kRgb24 ? 3 : 4;
    }
}

} // namespace

Result<FileHeader> readNiftiHeader(const std::filesystem::path& path) {
    HeaderBytes bytes;
    bool compressed = false;
    if (!readStart(path, bytes, compressed)) {
        return fail(ErrorCode::FileTruncated,
                    fmt::format("{}: ends within the NIfTI header, or its gzip stream is damaged; "
                                "fetch or export the file again",
                                path.string()));
    }
    const std::int32_t headerSize = bytes.detectOrder();
    if (headerSize == 540) {
        return fail(ErrorCode::UnsupportedType,
                    fmt::format("{}: is NIfTI-2, which is not read; convert it to NIfTI-1 or NRRD",
                                path.string()));
    }
    const auto rank = bytes.at<std::int16_t>(kDimAt);
    if (headerSize != kHeaderBytes || rank < 0 || rank > 7) {
        return fail(ErrorCode::FileUnreadable,
                    fmt::format("{}: does not begin with a NIfTI header; check that the file is "
                                "whole and of the format that its name says",
                                path.string()));
    }
    FileHeader header;
    for (std::size_t axis = 1; axis <= static_cast<std::size_t>(rank); ++axis) {
        header.sizes.push_back(bytes.at<std::int16_t>(kDimAt + 2 * axis));
        header.spacings.push_back(bytes.at<float>(kPixdimAt + 4 * axis));
    }
    setType(header, bytes.at<std::int16_t>(kDatatypeAt));
    header.encoding = compressed ? DataEncoding::Deflate : DataEncoding::Raw;
    header.dataFile = path;
    const auto offset = bytes.at<float>(kVoxOffsetAt);
    const std::int64_t begin =
        offset >= kHeaderBytes && offset < 1e9F ? static_cast<std::int64_t>(offset) : kHeaderBytes;
    (compressed ? header.inflatedOffset : header.fileOffset) = begin;
    for (std::size_t axis = 0; axis < std::min<std::size_t>(header.spacings.size(), 3); ++axis) {
        if (header.spacings[axis] <
            0.0) { // direction is in the transforms alone: nifti1.h, "pixdim"
            return fail(
                ErrorCode::InvalidGeometry,
                fmt::format("{}: the spacing of axis {} is {}, and NIfTI wants it positive; "
                            "correct 'pixdim' in the header",
                            path.string(), axis, header.spacings[axis]));
        }
    }
    return header;
}

} // namespace slabcast
