#pragma once

#include <cstdint>
#include <string>
#include <utility>

#include <tl/expected.hpp>

namespace slabcast {

/// What went wrong, as a caller can act on it. The detail beside it is for people.
enum class ErrorCode : std::uint8_t {
    InvalidArgument, // a setting outside its range
    EmptyVolume,     // no voxels, or a dimension of zero
    InvalidGeometry, // spacing, origin or direction cosines that span no space
    SizeOverflow,    // a product of sizes that does not fit
    UnsupportedType, // a voxel type or file format that is not read
    UnsupportedDims, // fewer or more dimensions than three
    FileNotFound,
    FileUnreadable, // present, but not to be opened or parsed
    FileTruncated,  // shorter than its header says
    FileUnwritable,
    EmptyFolder,     // a folder without a readable series
    AmbiguousSeries, // several series where one was asked for
    InvalidTransferFunction,
    DeviceUnsupported, // no GLES 3.2, or a limit that is too low
    DeviceOutOfMemory,
    VolumeTooLarge, // over the device's 3D texture limit or the memory budget
    ShaderCompile,
    Internal,
    Cancelled, // because the caller asked for it
};

/// One line: the cause, then the remedy. Written to be shown to a person as it is.
struct Error {
    ErrorCode code = ErrorCode::Internal;
    std::string detail;
};

template <class T>
using Result = tl::expected<T, Error>;

/// Shorthand for the failing branch: `return fail(ErrorCode::EmptyVolume, "...")`.
inline tl::unexpected<Error> fail(ErrorCode code, std::string detail) {
    return tl::unexpected<Error>(Error{code, std::move(detail)});
}

/// A breached contract: prints function and value, then aborts. For mistakes of the calling code,
/// never for input. Tested by: contracts_test.cpp
[[noreturn]] void contractBreach(const char* function, const char* condition, double value);

#define SLABCAST_EXPECTS(condition, value)                                                         \
    do {                                                                                           \
        if (!(condition)) {                                                                        \
            ::slabcast::contractBreach(__func__, #condition, static_cast<double>(value));          \
        }                                                                                          \
    } while (false)

} // namespace slabcast
