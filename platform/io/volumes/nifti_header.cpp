#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <fstream>
#include <memory>

#include <fmt/format.h>
#include <zlib.h>

#include "platform/io/base/parse_text.h"
#include "platform/io/volumes/file_header.h"

namespace slabcast {

namespace {

using Path = std::filesystem::path;

constexpr std::size_t kBytes1 = 348; // of nifti1.h, "struct nifti_1_header"
constexpr std::size_t kBytes2 = 540; // of nifti2.h, "struct nifti_2_header"

/// Reads numbers of either byte order; the first field, a small number, tells which.
class HeaderBytes {
public:
    explicit HeaderBytes(std::string_view bytes) : bytes_(bytes) {
        bigEndian_ = false;
        const auto size = bytes.size() < sizeof(std::int32_t) ? 0 : at<std::int32_t>(0);
        bigEndian_ = size < 0 || size > 0xFFFF;
    }

    template <class T>
    T at(std::size_t position) const {
        std::array<char, sizeof(T)> raw{};
        std::copy_n(bytes_.begin() + static_cast<std::ptrdiff_t>(position), sizeof(T), raw.begin());
        if (bigEndian_ != (std::endian::native == std::endian::big)) {
            std::reverse(raw.begin(), raw.end());
        }
        return std::bit_cast<T>(raw);
    }

    /// Of any type, as double.
    template <class T>
    std::vector<double> row(std::size_t position, std::size_t count) const {
        std::vector<double> values;
        for (std::size_t i = 0; i < count; ++i) {
            values.push_back(static_cast<double>(at<T>(position + i * sizeof(T))));
        }
        return values;
    }

    std::string_view text(std::size_t position, std::size_t size) const {
        return bytes_.substr(position, size);
    }
    bool isBigEndian() const { return bigEndian_; }

private:
    std::string_view bytes_;
    bool bigEndian_;
};

/// What both versions of the header hold.
struct Fields {
    std::vector<std::int64_t> dim; // [0]: how many follow
    std::vector<double> pixdim;    // [0]: handedness of the qform
    int datatype = 0;
    double voxOffset = 0.0;
    double slope = 0.0;
    double intercept = 0.0;
    int units = 0;
    int qformCode = 0;
    int sformCode = 0;
    std::vector<double> quatern; // b, c, d
    std::vector<double> qoffset;
    std::vector<double> sform; // three rows of four
    std::string magic;         // "n+1": voxels in this file; "ni1": in another
    double firstVoxelAt = 0.0; // at the least, in a single file
};

Fields fieldsOf1(const HeaderBytes& bytes) {
    Fields fields;
    for (std::size_t i = 0; i < 8; ++i) {
        fields.dim.push_back(bytes.at<std::int16_t>(40 + 2 * i));
    }
    fields.datatype = bytes.at<std::int16_t>(70);
    fields.pixdim = bytes.row<float>(76, 8);
    fields.voxOffset = bytes.at<float>(108);
    fields.slope = bytes.at<float>(112);
    fields.intercept = bytes.at<float>(116);
    fields.units = bytes.at<std::uint8_t>(123);
    fields.qformCode = bytes.at<std::int16_t>(252);
    fields.sformCode = bytes.at<std::int16_t>(254);
    fields.quatern = bytes.row<float>(256, 3);
    fields.qoffset = bytes.row<float>(268, 3);
    fields.sform = bytes.row<float>(280, 12);
    fields.magic = bytes.text(344, 3);
    fields.firstVoxelAt = 352.0;
    return fields;
}

Fields fieldsOf2(const HeaderBytes& bytes) {
    Fields fields;
    for (std::size_t i = 0; i < 8; ++i) {
        fields.dim.push_back(bytes.at<std::int64_t>(16 + 8 * i));
    }
    fields.datatype = bytes.at<std::int16_t>(12);
    fields.pixdim = bytes.row<double>(104, 8);
    fields.voxOffset = static_cast<double>(bytes.at<std::int64_t>(168));
    fields.slope = bytes.at<double>(176);
    fields.intercept = bytes.at<double>(184);
    fields.qformCode = bytes.at<std::int32_t>(344);
    fields.sformCode = bytes.at<std::int32_t>(348);
    fields.quatern = bytes.row<double>(352, 3);
    fields.qoffset = bytes.row<double>(376, 3);
    fields.sform = bytes.row<double>(400, 12);
    fields.units = bytes.at<std::int32_t>(500);
    fields.magic = bytes.text(4, 3);
    fields.firstVoxelAt = 544.0;
    return fields;
}

struct NiftiType {
    int code;
    const char* name;
    std::optional<StoredType> type;
    std::int64_t components = 1;
};

constexpr std::array<NiftiType, 16> kTypes = {
    {{1, "binary, of one bit each", {}},
     {2, "uint8", StoredType{VoxelType::U8}},
     {4, "int16", StoredType{VoxelType::I16}},
     {8, "int32", StoredType{VoxelType::I32}},
     {16, "float32", StoredType{VoxelType::F32}},
     {32, "complex64", {}},
     {64, "float64", StoredType{VoxelType::F64}},
     {128, "rgb24", {}, 3},
     {256, "int8", StoredType{VoxelType::I8}},
     {512, "uint16", StoredType{VoxelType::U16}},
     {768, "uint32", StoredType{VoxelType::U32}},
     {1024, "int64", StoredType{VoxelType::F64, Wide::Signed}},
     {1280, "uint64", StoredType{VoxelType::F64, Wide::Unsigned}},
     {1536, "float128", {}},
     {1792, "complex128", {}},
     {2048, "complex256", {}}}};

void setType(FileHeader& header, int code) {
    constexpr int kRgba32 = 2304;
    const auto found = std::find_if(kTypes.begin(), kTypes.end(),
                                    [&](const NiftiType& entry) { return entry.code == code; });
    if (found != kTypes.end()) {
        header.typeName = found->name;
        header.type = found->type;
        header.components = found->components;
    } else if (code == kRgba32) {
        header.typeName = "rgba32";
        header.components = 4;
    } else {
        header.typeName = fmt::format("unknown, code {}", code);
    }
}

double millimetresPerUnit(FileHeader& header, int units) {
    constexpr int kSpaceBits = 7; // those above are of time
    switch (units & kSpaceBits) {
    case 1:
        return 1e3;
    case 0:
    case 2:
        return 1.0;
    case 3:
        return 1e-3;
    default:
        header.notes.push_back(
            fmt::format("its 'xyzt_units' {} is no unit of length; taken as mm", units));
        return 1.0;
    }
}

/// From voxels to the file's space, RAS in its own unit. Columns: steps along the axes.
struct Transform {
    glm::dmat3 steps{1.0};
    glm::dvec3 origin{0.0};
};

Transform sformOf(const Fields& fields) {
    Transform transform;
    for (int row = 0; row < 3; ++row) {
        const auto at = static_cast<std::size_t>(4 * row);
        for (int axis = 0; axis < 3; ++axis) {
            transform.steps[axis][row] = fields.sform[at + static_cast<std::size_t>(axis)];
        }
        transform.origin[row] = fields.sform[at + 3];
    }
    return transform;
}

/// nifti1.h, "METHOD 2": a unit quaternion whose first part is left out.
Transform qformOf(const Fields& fields) {
    double b = fields.quatern[0];
    double c = fields.quatern[1];
    double d = fields.quatern[2];
    double a = 1.0 - (b * b + c * c + d * d);
    if (a < 1e-7) { // a half turn, as good as float has it
        const double length = std::sqrt(b * b + c * c + d * d);
        b /= length;
        c /= length;
        d /= length;
        a = 0.0;
    }
    a = std::sqrt(a);
    glm::dmat3 turn;
    turn[0] = {a * a + b * b - c * c - d * d, 2.0 * (b * c + a * d), 2.0 * (b * d - a * c)};
    turn[1] = {2.0 * (b * c - a * d), a * a + c * c - b * b - d * d, 2.0 * (c * d + a * b)};
    turn[2] = {2.0 * (b * d + a * c), 2.0 * (c * d - a * b), a * a + d * d - b * b - c * c};
    Transform transform;
    for (int axis = 0; axis < 3; ++axis) {
        const double handedness = axis == 2 && fields.pixdim[0] < 0.0 ? -1.0 : 1.0;
        transform.steps[axis] =
            handedness * fields.pixdim[static_cast<std::size_t>(axis) + 1] * turn[axis];
    }
    transform.origin = {fields.qoffset[0], fields.qoffset[1], fields.qoffset[2]};
    return transform;
}

bool isFinite(const Transform& transform) {
    double sum = transform.origin.x + transform.origin.y + transform.origin.z;
    for (int axis = 0; axis < 3; ++axis) {
        sum += glm::dot(transform.steps[axis], glm::dvec3(1.0));
    }
    return std::isfinite(sum);
}

glm::dvec3 lengthsOf(const glm::dmat3& steps) {
    return {glm::length(steps[0]), glm::length(steps[1]), glm::length(steps[2])};
}

constexpr const char* kSheared = "the axes of its sform are not at right angles";

/// Empty where the transform may serve; else what is wrong with it.
std::string faultOf(const Transform& transform) {
    constexpr double kMostCosine = 2e-3; // what rounding and registration leave; measured against 1
    if (!isFinite(transform)) {
        return "its sform holds NaN or infinite numbers";
    }
    const glm::dvec3 lengths = lengthsOf(transform.steps);
    if (!(lengths.x > 0.0 && lengths.y > 0.0 && lengths.z > 0.0)) {
        return "its sform spans no space";
    }
    double cosine = 0.0;
    for (int axis = 0; axis < 3; ++axis) {
        const int next = (axis + 1) % 3;
        cosine = std::max(cosine, std::abs(glm::dot(transform.steps[axis] / lengths[axis],
                                                    transform.steps[next] / lengths[next])));
    }
    return cosine > kMostCosine ? kSheared : "";
}

bool differ(double a, double b, double relative) {
    return std::abs(a - b) > relative * std::max(std::abs(a), std::abs(b));
}

/// The lengths of the sform's columns or, where they differ from it by rounding alone or the sform
/// holds directions only, pixdim's.
void settleSpacing(FileHeader& header, Transform& sform, const glm::dvec3& pixdim) {
    constexpr double kRounding = 1e-4;
    constexpr double kDisagreement = 1e-2;
    const glm::dvec3 lengths = lengthsOf(sform.steps);
    bool same = true;
    bool near = true;
    bool directionsOnly = true;
    for (int axis = 0; axis < 3; ++axis) {
        same = same && !differ(lengths[axis], pixdim[axis], kRounding);
        near = near && !differ(lengths[axis], pixdim[axis], kDisagreement);
        directionsOnly = directionsOnly && !differ(lengths[axis], 1.0, 1e-3);
    }
    if (same || (directionsOnly && !near)) {
        for (int axis = 0; axis < 3; ++axis) {
            sform.steps[axis] *= pixdim[axis] / lengths[axis];
        }
    }
    if (directionsOnly && !near) {
        header.notes.push_back(fmt::format("its sform holds directions only; the spacing {} x {} x "
                                           "{} is that of 'pixdim'",
                                           pixdim.x, pixdim.y, pixdim.z));
    } else if (!near) {
        header.notes.push_back(
            fmt::format("its sform has a spacing of {:.6g} x {:.6g} x {:.6g}, 'pixdim' one of "
                        "{:.6g} x {:.6g} x {:.6g}; the sform's is taken",
                        lengths.x, lengths.y, lengths.z, pixdim.x, pixdim.y, pixdim.z));
    }
}

bool areSimilar(const Transform& a, const Transform& b) {
    const glm::dvec3 lengths = lengthsOf(a.steps);
    for (int axis = 0; axis < 3; ++axis) {
        if (glm::length(a.steps[axis] - b.steps[axis]) > 1e-2 * lengths[axis]) {
            return false;
        }
    }
    return true;
}

/// The sform where there is no qform, where it is of the scanner, or where both turn alike; else
/// the qform, as other readers have it. An sform that cannot serve leaves it to the qform.
Result<Placement> readPlacement(const Path& path, FileHeader& header, const Fields& fields) {
    constexpr int kOfScanner = 1;
    const double unit = millimetresPerUnit(header, fields.units);
    const glm::dvec3 pixdim(fields.pixdim[1], fields.pixdim[2], fields.pixdim[3]);
    if (fields.sformCode <= 0 && fields.qformCode <= 0) {
        Placement placement;
        placement.spacingMm = unit * pixdim;
        return placement;
    }
    const Transform qform = qformOf(fields);
    const bool hasQform = fields.qformCode > 0 && isFinite(qform);
    Transform chosen = qform;
    std::string fault = "its qform holds NaN or infinite numbers";
    if (fields.sformCode > 0) {
        Transform sform = sformOf(fields);
        fault = faultOf(sform);
        if (fault.empty()) {
            settleSpacing(header, sform, pixdim);
            const bool prefer =
                !hasQform || fields.sformCode == kOfScanner || areSimilar(sform, qform);
            chosen = prefer ? sform : qform;
        } else if (hasQform) {
            header.notes.push_back(fault + "; placed by its qform");
        }
    }
    if (!fault.empty() && !hasQform) {
        const char* remedy = fault == kSheared
                                 ? "resample it onto a straight grid"
                                 : "correct the header or set its code to 0, which places it by "
                                   "'pixdim' alone";
        return fail(ErrorCode::InvalidGeometry,
                    fmt::format("{}: {}; {}", path.string(), fault, remedy));
    }
    const glm::dvec3 lpsFromRas(-1.0, -1.0, 1.0);
    glm::dmat3 steps;
    for (int axis = 0; axis < 3; ++axis) {
        steps[axis] = unit * lpsFromRas * chosen.steps[axis];
    }
    return placementOf(steps, unit * lpsFromRas * chosen.origin);
}

/// nifti1.h: a slope of 0 means that values are not scaled.
void setRescaling(FileHeader& header, const Fields& fields) {
    if (fields.slope == 0.0) {
        return;
    }
    if (!std::isfinite(fields.slope) || !std::isfinite(fields.intercept)) {
        header.notes.emplace_back(
            "its 'scl_slope' or 'scl_inter' is no finite number; values are left as stored");
        return;
    }
    header.slope = fields.slope;
    header.intercept = fields.intercept;
}

/// The image of a pair beside its header, deflated or not.
Path imageBeside(const Path& path) {
    Path image = path;
    if (lowerCase(image.extension().string()) == ".gz") {
        image.replace_extension();
    }
    const bool loud = image.extension() == ".HDR";
    image.replace_extension(loud ? ".IMG" : ".img");
    std::error_code error;
    const Path packed(image.string() + ".gz");
    return !std::filesystem::exists(image, error) && std::filesystem::exists(packed, error) ? packed
                                                                                            : image;
}

bool isGzip(const Path& path) {
    std::ifstream file(path, std::ios::binary);
    return file.get() == 0x1F && file.get() == 0x8B;
}

Result<void> setSource(const Path& path, FileHeader& header, const Fields& fields, bool deflated) {
    constexpr double kFarBeyondAnyFile = 1e18;
    const bool single = fields.magic.at(1) == '+';
    double offset = fields.voxOffset;
    if (single && offset == 0.0) {
        offset = fields.firstVoxelAt;
        header.notes.push_back(fmt::format("its 'vox_offset' is 0, which is for pairs of files; "
                                           "voxels are taken from byte {} on",
                                           offset));
    }
    const bool sound = offset >= (single ? fields.firstVoxelAt : 0.0) &&
                       offset < kFarBeyondAnyFile && std::trunc(offset) == offset;
    if (!sound) {
        return fail(ErrorCode::FileUnreadable,
                    fmt::format("{}: its 'vox_offset' is {}, and the voxels begin at byte {} or "
                                "behind; correct it in the header or convert the file again",
                                path.string(), fields.voxOffset, single ? fields.firstVoxelAt : 0));
    }
    const Path file = single ? path : imageBeside(path);
    header.source.files = {file};
    header.source.encoding =
        (single ? deflated : isGzip(file)) ? DataEncoding::Deflate : DataEncoding::Raw;
    header.source.byteSkip = static_cast<std::int64_t>(offset);
    return {};
}

tl::unexpected<Error> noNifti(const Path& path, std::string_view why) {
    return fail(ErrorCode::FileUnreadable,
                fmt::format("{}: {}; check that the file is whole and of the format that its name "
                            "says",
                            path.string(), why));
}

tl::unexpected<Error> endsEarly(const Path& path) {
    return fail(ErrorCode::FileTruncated,
                fmt::format("{}: ends within the NIfTI header, or its gzip stream is damaged; "
                            "fetch or export the file again",
                            path.string()));
}

/// Of either version. Fails: FileTruncated, FileUnreadable.
Result<Fields> parseFields(const Path& path, const HeaderBytes& bytes, std::size_t available) {
    if (available < kBytes1) {
        return endsEarly(path);
    }
    const auto size = static_cast<std::size_t>(bytes.at<std::int32_t>(0));
    if (size == kBytes2 && available < kBytes2) {
        return endsEarly(path);
    }
    if (size != kBytes1 && size != kBytes2) {
        return noNifti(path, "does not begin with a NIfTI header");
    }
    const Fields fields = size == kBytes2 ? fieldsOf2(bytes) : fieldsOf1(bytes);
    const bool known = fields.magic[0] == 'n' &&
                       (fields.magic[1] == '+' || fields.magic[1] == 'i') &&
                       fields.magic[2] == (size == kBytes2 ? '2' : '1');
    if (!known || fields.dim[0] < 0 || fields.dim[0] > 7) {
        return noNifti(path, "does not begin with a NIfTI header");
    }
    if (fields.magic[1] == 'i' && lowerCase(path.string()).find(".hdr") == std::string::npos) {
        return noNifti(path, "is the header of a pair of files, .hdr and .img");
    }
    return fields;
}

} // namespace

Result<FileHeader> parseNiftiHeader(std::string_view start, const Path& path, bool deflated) {
    const HeaderBytes bytes(start);
    const Result<Fields> fields = parseFields(path, bytes, start.size());
    if (!fields) {
        return tl::unexpected(fields.error());
    }
    FileHeader header;
    const auto rank = static_cast<std::ptrdiff_t>(fields->dim[0]);
    setAxes(header, {fields->dim.begin() + 1, fields->dim.begin() + 1 + rank});
    setType(header, fields->datatype);
    header.bigEndian = bytes.isBigEndian();
    for (std::size_t axis = 0; axis < std::min<std::size_t>(fields->dim[0], 3); ++axis) {
        const double spacing = fields->pixdim[axis + 1];
        header.spacings.push_back(spacing);
        if (spacing < 0.0) { // direction is in the transforms alone: nifti1.h, "pixdim"
            return fail(
                ErrorCode::InvalidGeometry,
                fmt::format("{}: the spacing of axis {} is {}, and NIfTI wants it positive; "
                            "correct 'pixdim' in the header",
                            path.string(), axis, spacing));
        }
    }
    if (const Result<void> source = setSource(path, header, *fields, deflated); !source) {
        return tl::unexpected(source.error());
    }
    setRescaling(header, *fields);
    header.placement = readPlacement(path, header, *fields);
    return header;
}

Result<FileHeader> readNiftiHeader(const Path& path) {
    std::string start(kBytes2, '\0');
    const std::unique_ptr<gzFile_s, int (*)(gzFile)> file( // passes plain files through as well
        gzopen(path.c_str(), "rb"), gzclose);
    const int got =
        file ? gzread(file.get(), start.data(), static_cast<unsigned>(start.size())) : 0;
    start.resize(static_cast<std::size_t>(std::max(got, 0)));
    return parseNiftiHeader(start, path, file && gzdirect(file.get()) == 0);
}

} // namespace slabcast
