#include "platform/io/volumes/inflater.h"

#include <algorithm>
#include <istream>
#include <limits>

namespace slabcast {

namespace {

constexpr int kZlibOrGzip = 15 + 32; // zlib.h, inflateInit2()
constexpr std::size_t kChunkBytes = 1 << 18;
constexpr std::int64_t kMostAtOnce = 1 << 30; // zlib counts in 32 bits

} // namespace

Inflater::Inflater(std::istream& stream, std::int64_t deflatedBytes)
    : stream_(stream),
      packedLeft_(deflatedBytes > 0 ? deflatedBytes : std::numeric_limits<std::int64_t>::max()),
      packed_(kChunkBytes), unwanted_(kChunkBytes), status_(inflateInit2(&inflate_, kZlibOrGzip)) {}

Inflater::~Inflater() {
    inflateEnd(&inflate_);
}

/// Whether any input is left.
bool Inflater::refill() {
    if (inflate_.avail_in == 0) {
        stream_.read(packed_.data(),
                     std::min(static_cast<std::int64_t>(packed_.size()), packedLeft_));
        packedLeft_ -= stream_.gcount();
        inflate_.next_in = reinterpret_cast<Bytef*>(packed_.data());
        inflate_.avail_in = static_cast<uInt>(stream_.gcount());
    }
    return inflate_.avail_in > 0;
}

std::int64_t Inflater::take(std::byte* place, std::int64_t bytes) {
    std::int64_t taken = 0;
    while (taken < bytes && (status_ == Z_OK || status_ == Z_STREAM_END)) {
        const bool more = refill();
        if (status_ == Z_STREAM_END && (!more || inflateReset(&inflate_) != Z_OK)) {
            break;
        }
        const std::int64_t most = place ? kMostAtOnce : static_cast<std::int64_t>(unwanted_.size());
        const std::int64_t now = std::min(bytes - taken, most);
        inflate_.next_out = reinterpret_cast<Bytef*>(place ? place + taken : unwanted_.data());
        inflate_.avail_out = static_cast<uInt>(now);
        status_ = inflate(&inflate_, Z_NO_FLUSH); // without input: Z_BUF_ERROR, which ends this
        taken += now - inflate_.avail_out;
    }
    return taken;
}

} // namespace slabcast
