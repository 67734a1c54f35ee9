#pragma once

#include <cstddef>
#include <cstdint>
#include <iosfwd>
#include <vector>

#include <zlib.h>

namespace slabcast {

/// Inflates zlib or gzip data from where `stream` stands; gzip members may be strung together.
/// Tested by: io_voxel_source_test.cpp
class Inflater {
public:
    /// `deflatedBytes`: as many and no more; 0: to the end.
    Inflater(std::istream& stream, std::int64_t deflatedBytes);
    ~Inflater();
    Inflater(const Inflater&) = delete;
    Inflater& operator=(const Inflater&) = delete;

    /// The next bytes; returns how many, fewer where the data end or are damaged. Without a place
    /// they are thrown away.
    std::int64_t take(std::byte* place, std::int64_t bytes);
    /// Whether the data of a member go on behind what was taken.
    bool goesOn() const { return status_ == Z_OK; }
    /// Whether the last member came to its end, checksum included.
    bool endedWhole() const { return status_ == Z_STREAM_END; }

private:
    bool refill();

    std::istream& stream_;
    std::int64_t packedLeft_;
    std::vector<char> packed_;
    std::vector<std::byte> unwanted_;
    z_stream inflate_{};
    int status_;
};

} // namespace slabcast
