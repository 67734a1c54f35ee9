#pragma once

#include <iosfwd>
#include <span>
#include <string>

#include "core/base/error.h"
#include "platform/io/volumes/voxel_source.h"

namespace slabcast {

/// Numbers of `type`. The errors' texts lack the file's name. Fail: FileTruncated, FileUnreadable
/// (no number, or none of this type). Tested by: io_voxel_source_test.cpp
class TextVoxels {
public:
    TextVoxels(std::istream& stream, StoredType type) : stream_(stream), type_(type) {}

    Result<void> skip(std::int64_t count);
    /// Fills `voxels`, in the machine's byte order.
    Result<void> take(std::span<std::byte> voxels);

private:
    template <class T>
    Result<void> takeNumbers(const char* typeName, std::span<std::byte> voxels);
    Result<void> nextWord();

    std::istream& stream_;
    StoredType type_;
    std::string word_;
    std::int64_t count_ = 0; // of words so far
};

/// Bytes of two hexadecimal digits each; false where they end early or are none.
/// Tested by: io_voxel_source_test.cpp
bool readHex(std::istream& stream, std::int64_t skip, std::span<std::byte> bytes);

} // namespace slabcast
