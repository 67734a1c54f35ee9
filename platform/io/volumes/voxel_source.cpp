#include "platform/io/volumes/voxel_source.h"

#include <algorithm>
#include <array>
#include <bit>
#include <fstream>
#include <limits>
#include <optional>

#include <fmt/format.h>
#include <unistd.h>

#include "platform/io/volumes/inflater.h"
#include "platform/io/volumes/voxel_text.h"

namespace slabcast {

namespace {

using Path = std::filesystem::path;

constexpr std::int64_t kMaxDeflateRatio =
    1032; // RFC 1951 allows no more, so longer data cannot be inside

constexpr std::int64_t kChunkBytes = 1 << 22; // a multiple of every voxel's
constexpr std::int64_t kFarBeyondAnyFile = std::int64_t{1} << 60;

tl::unexpected<Error> tooShort(const std::string& name, const Path& file, std::int64_t bytes,
                               std::int64_t fileBytes) {
    return fail(ErrorCode::FileTruncated,
                fmt::format("{}: the header asks for {} bytes of voxels, {} has {} bytes in all; "
                            "fetch the file again or correct the sizes in the header",
                            name, bytes, file.string(), fileBytes));
}

Result<std::int64_t> sizeOf(const std::string& name, const Path& file) {
    std::error_code error;
    const auto bytes = static_cast<std::int64_t>(std::filesystem::file_size(file, error));
    if (error) {
        return fail(ErrorCode::FileNotFound,
                    fmt::format("{}: its voxels should be in {}, which is not there; keep both "
                                "files in one folder",
                                name, file.string()));
    }
    return bytes;
}

/// Of the first voxel, or of the deflated stream; behind the end where there is none.
std::int64_t placeOfBegin(std::ifstream& stream, const Path& file, const VoxelSource& source,
                          std::int64_t bytes, std::int64_t fileBytes) {
    std::int64_t place = source.headerBytes;
    if (source.lineSkip > 0) { // opened only now: often its size tells enough
        if (!stream.is_open()) {
            stream.open(file, std::ios::binary);
        }
        stream.seekg(place);
        for (std::int64_t i = 0; i < source.lineSkip && stream; ++i) {
            stream.ignore(std::numeric_limits<std::streamsize>::max(), '\n');
        }
        place = stream ? static_cast<std::int64_t>(stream.tellg()) : fileBytes;
    }
    if (source.encoding != DataEncoding::Deflate) {
        const std::int64_t behind = bytes > fileBytes ? -1 : fileBytes - bytes;
        place = source.byteSkip >= 0 ? place + std::min(source.byteSkip, fileBytes + 1)
                                     : behind + source.byteSkip + 1;
        place = place < source.headerBytes ? fileBytes + 1 : place;
    }
    return place;
}

/// The least that a file can hold `bytes` of voxels in.
std::int64_t leastFileBytes(DataEncoding encoding, StoredType type, std::int64_t bytes) {
    const auto twice = [](std::int64_t count) { return std::min(count, kFarBeyondAnyFile) * 2; };
    switch (encoding) {
    case DataEncoding::Deflate:
        return bytes / kMaxDeflateRatio;
    case DataEncoding::Text: // a digit and what parts it from the next
        return twice(bytes / static_cast<std::int64_t>(bytesPerVoxel(type.type))) - 1;
    case DataEncoding::Hex:
        return twice(bytes);
    default:
        return bytes;
    }
}

/// What to read of one file, and what to say of it.
struct Wanted {
    const std::string& name;     // of the header
    const Path& file;            // as many bytes of voxels
    std::int64_t bytes;          // are in it,
    std::int64_t skip;           // these come before the wanted ones,
    std::span<std::byte> voxels; // which go here
    const Going& going;
    double doneBefore; // of all files, from 0 to 1
    double share;      // of this one

    /// After `done` of its `of` parts.
    Result<void> tell(std::int64_t done, std::int64_t of) const {
        const double part =
            static_cast<double>(done) / static_cast<double>(std::max<std::int64_t>(of, 1));
        return going ? going(file, doneBefore + share * std::min(part, 1.0)) : Result<void>();
    }
};

/// Calls `read(from, count)` for each few MiB of `all` bytes until one fails. What is left out
/// counts as no progress.
template <class Read>
Result<void> inChunks(const Wanted& wanted, std::int64_t all, bool leftOut, const Read& read) {
    for (std::int64_t from = 0; from < all; from += kChunkBytes) {
        const Result<void> sound = wanted.tell(leftOut ? 0 : from, all).and_then([&]() {
            return read(from, std::min(all - from, kChunkBytes));
        });
        if (!sound) {
            return sound;
        }
    }
    return {};
}

Result<void> readRaw(std::ifstream& stream, std::int64_t place, std::int64_t fileBytes,
                     const Wanted& wanted) {
    stream.seekg(place + wanted.skip);
    const auto size = static_cast<std::int64_t>(wanted.voxels.size());
    return inChunks(wanted, size, false,
                    [&](std::int64_t from, std::int64_t count) -> Result<void> {
                        stream.read(reinterpret_cast<char*>(wanted.voxels.data() + from), count);
                        return stream ? Result<void>()
                                      : tooShort(wanted.name, wanted.file, wanted.bytes, fileBytes);
                    });
}

tl::unexpected<Error> damaged(const Wanted& wanted, const char* how) {
    return fail(ErrorCode::FileTruncated,
                fmt::format("{}: the {} voxels in {} end early or are damaged; fetch the file "
                            "again or correct the sizes in the header",
                            wanted.name, how, wanted.file.string()));
}

/// How many bytes of the stream come before the first voxel of the file.
Result<std::int64_t> inflatedBegin(const VoxelSource& source, std::ifstream& stream,
                                   std::int64_t place, const Wanted& wanted) {
    if (source.byteSkip >= 0) {
        return source.byteSkip;
    }
    Inflater inflater(stream, source.deflatedBytes); // only its end tells where they begin
    std::int64_t all = 0;
    for (std::int64_t now = kChunkBytes; now == kChunkBytes; all += now) {
        now = inflater.take(nullptr, kChunkBytes);
        if (const Result<void> told = wanted.tell(0, 1); !told) {
            return tl::unexpected(told.error());
        }
    }
    stream.clear();
    stream.seekg(place);
    return all - wanted.bytes + source.byteSkip + 1;
}

Result<void> readDeflated(const VoxelSource& source, std::ifstream& stream, std::int64_t place,
                          const Wanted& wanted) {
    const Result<std::int64_t> begin = inflatedBegin(source, stream, place, wanted);
    if (!begin) {
        return tl::unexpected(begin.error());
    }
    if (*begin < 0 || *begin > std::numeric_limits<std::int64_t>::max() - wanted.bytes) {
        return damaged(wanted, "compressed");
    }
    Inflater inflater(stream, source.deflatedBytes);
    const auto take = [&](std::byte* to, std::int64_t size) {
        const auto some = [&](std::int64_t from, std::int64_t count) -> Result<void> {
            const bool whole = inflater.take(to ? to + from : nullptr, count) == count;
            return whole ? Result<void>() : damaged(wanted, "compressed");
        };
        return inChunks(wanted, size, to == nullptr, some);
    };
    const auto size = static_cast<std::int64_t>(wanted.voxels.size());
    return take(nullptr, *begin + wanted.skip)
        .and_then([&]() { return take(wanted.voxels.data(), size); })
        .and_then([&]() { return take(nullptr, wanted.bytes - wanted.skip - size); })
        .and_then([&]() -> Result<void> {
            while (inflater.goesOn()) { // to the checksum, whatever else is there
                inflater.take(nullptr, kChunkBytes);
                if (const Result<void> told = wanted.tell(1, 1); !told) {
                    return told;
                }
            }
            return inflater.endedWhole() ? Result<void>() : damaged(wanted, "compressed");
        });
}

/// Numbers in text. Those before the wanted ones are read as well, for they differ in length.
Result<void> readText(std::ifstream& stream, StoredType type, const Wanted& wanted) {
    const auto each = static_cast<std::int64_t>(bytesPerVoxel(type.type));
    TextVoxels text(stream, type);
    const auto named = [&](const Error& error) {
        return Error{error.code, fmt::format("{}: the text of its voxels in {}: {}", wanted.name,
                                             wanted.file.string(), error.detail)};
    };
    const auto size = static_cast<std::int64_t>(wanted.voxels.size());
    return inChunks(wanted, wanted.skip, true,
                    [&](std::int64_t, std::int64_t count) {
                        return text.skip(count / each).map_error(named);
                    })
        .and_then([&]() {
            return inChunks(wanted, size, false, [&](std::int64_t from, std::int64_t count) {
                return text
                    .take(wanted.voxels.subspan(static_cast<std::size_t>(from),
                                                static_cast<std::size_t>(count)))
                    .map_error(named);
            });
        });
}

Result<void> readFile(const VoxelSource& source, StoredType type, const Wanted& wanted) {
    const Result<std::int64_t> fileBytes = sizeOf(wanted.name, wanted.file);
    if (!fileBytes) {
        return tl::unexpected(fileBytes.error());
    }
    std::ifstream stream(wanted.file, std::ios::binary);
    const std::int64_t place = placeOfBegin(stream, wanted.file, source, wanted.bytes, *fileBytes);
    stream.clear();
    stream.seekg(place);
    switch (source.encoding) {
    case DataEncoding::Deflate:
        return readDeflated(source, stream, place, wanted);
    case DataEncoding::Text:
        return readText(stream, type, wanted);
    case DataEncoding::Hex:
        return readHex(stream, wanted.skip, wanted.voxels) ? Result<void>()
                                                           : damaged(wanted, "hexadecimal");
    default:
        return readRaw(stream, place, *fileBytes, wanted);
    }
}

template <std::size_t Bytes>
void swapEach(std::span<std::byte> voxels) {
    for (std::size_t at = 0; at + Bytes <= voxels.size(); at += Bytes) {
        std::reverse(voxels.begin() + static_cast<std::ptrdiff_t>(at),
                     voxels.begin() + static_cast<std::ptrdiff_t>(at + Bytes));
    }
}

void swapBytes(std::span<std::byte> voxels, std::size_t bytesEach) {
    if (bytesEach == 2) {
        swapEach<2>(voxels);
    } else if (bytesEach == 4) {
        swapEach<4>(voxels);
    } else if (bytesEach == 8) {
        swapEach<8>(voxels);
    }
}

} // namespace

Result<void> checkVoxelFiles(const std::string& name, const VoxelSource& source, StoredType type,
                             std::int64_t bytes) {
    const std::int64_t each = bytes / static_cast<std::int64_t>(source.files.size());
    for (const Path& file : source.files) {
        const Result<std::int64_t> fileBytes = sizeOf(name, file);
        if (!fileBytes) {
            return tl::unexpected(fileBytes.error());
        }
        if (access(file.c_str(), R_OK) != 0) {
            return fail(ErrorCode::FileUnreadable,
                        fmt::format("{}: its voxels are in {}, which cannot be opened; check its "
                                    "permissions",
                                    name, file.string()));
        }
        const std::int64_t least = leastFileBytes(source.encoding, type, each);
        std::ifstream stream;
        const std::int64_t behind =
            source.encoding == DataEncoding::Deflate
                ? *fileBytes
                : *fileBytes - placeOfBegin(stream, file, source, each, *fileBytes);
        if (behind < least) {
            return tooShort(name, file, each, *fileBytes);
        }
    }
    return {};
}

Result<void> readVoxelBytes(const std::string& name, const VoxelSource& source, StoredType type,
                            std::int64_t bytes, std::int64_t first, std::span<std::byte> voxels,
                            const Going& going) {
    const std::int64_t each = bytes / static_cast<std::int64_t>(source.files.size());
    const std::int64_t last = first + static_cast<std::int64_t>(voxels.size());
    std::int64_t fileBegin = 0;
    for (const Path& file : source.files) {
        const std::int64_t begin = std::max(first, fileBegin);
        const std::int64_t end = std::min(last, fileBegin + each);
        if (begin < end) {
            const auto part = voxels.subspan(static_cast<std::size_t>(begin - first),
                                             static_cast<std::size_t>(end - begin));
            const auto all = static_cast<double>(voxels.size());
            const Result<void> read = readFile(source, type,
                                               {name, file, each, begin - fileBegin, part, going,
                                                static_cast<double>(begin - first) / all,
                                                static_cast<double>(end - begin) / all});
            if (!read) {
                return read;
            }
        }
        fileBegin += each;
    }
    const bool bigMachine = std::endian::native == std::endian::big;
    if (source.encoding != DataEncoding::Text && source.bigEndian != bigMachine) {
        swapBytes(voxels, bytesPerVoxel(type.type));
    }
    return {};
}

} // namespace slabcast
