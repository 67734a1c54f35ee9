#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "core/base/error.h"
#include "core/volume/volume.h"
#include "platform/io/base/load_options.h"

namespace slabcast::apart {

// What the library and its reader in a process of its own say to each other: packets over a socket
// of SOCK_SEQPACKET. Both ends are of one build; still, the reader is not trusted, since a file may
// have taken it over: what comes from it is checked as a file is.

enum class Packet : std::uint8_t { Request, Progress, Header, Done, Failed };

/// A path and how to read it: not `allocate`, `progress`, `cancel` and `process`.
std::string encodeRequest(const std::string& path, const LoadOptions& options);
std::string encodeProgress(const LoadProgress& progress);
/// The volume without its voxels, which travel as a file of memory; `kind`: Header, before they are
/// read, or Done. They are read once any packet comes back for the header.
std::string encodeVolume(Packet kind, const Volume& volume);
std::string encodeFailed(const Error& error);

struct Request {
    std::string path;
    LoadOptions options;
};

/// What came; nothing where it is not what its kind should be.
std::optional<Packet> kindOf(std::string_view packet);
std::optional<Request> decodeRequest(std::string_view packet);
std::optional<LoadProgress> decodeProgress(std::string_view packet);
std::optional<Volume> decodeVolume(std::string_view packet);
std::optional<Error> decodeFailed(std::string_view packet);

inline constexpr std::size_t kLongestPacket = 64 * 1024;
inline constexpr int kReaderSocket = 3; // the reader finds its end there

/// One packet, and with it a file if `file` is one. False where the other end is gone.
bool send(int socket, std::string_view packet, int file = -1);

struct Received {
    std::string packet; // empty: the other end is gone
    int file = -1;      // the receiver's to close
};
Received receive(int socket);

} // namespace slabcast::apart
