#include "platform/io/apart/wire.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <type_traits>

#include <sys/socket.h>
#include <unistd.h>

namespace slabcast::apart {

namespace {

/// Longer texts are cut: a packet has an end.
constexpr std::size_t kLongestText = 8 * 1024;
constexpr std::size_t kMostNotes = 64;
constexpr std::size_t kLongestNote = 512;

/// Appends values to a packet.
class Writer {
public:
    explicit Writer(Packet kind) { (*this)(static_cast<std::uint8_t>(kind)); }

    template <class T>
    Writer& operator()(const T& value) {
        if constexpr (std::is_convertible_v<T, std::string_view>) {
            const std::string_view text = std::string_view(value).substr(0, kLongestText);
            (*this)(static_cast<std::uint32_t>(text.size()));
            bytes_.append(text);
        } else {
            static_assert(std::is_trivially_copyable_v<T>);
            bytes_.append(reinterpret_cast<const char*>(&value), sizeof(T));
        }
        return *this;
    }

    std::string bytes() && { return std::move(bytes_); }

private:
    std::string bytes_;
};

/// Takes them again in the same order. Once a packet has ended early, everything fails.
class Reader {
public:
    explicit Reader(std::string_view packet) : left_(packet.substr(1)) {}

    template <class T>
    Reader& operator()(T& value) {
        if constexpr (std::is_same_v<T, std::string>) {
            std::uint32_t size = 0;
            (*this)(size);
            failed_ = failed_ || size > left_.size();
            value = failed_ ? std::string() : std::string(left_.substr(0, size));
            left_.remove_prefix(value.size());
        } else {
            static_assert(std::is_trivially_copyable_v<T>);
            failed_ = failed_ || left_.size() < sizeof(T);
            if (!failed_) {
                std::memcpy(&value, left_.data(), sizeof(T));
                left_.remove_prefix(sizeof(T));
            }
        }
        return *this;
    }

    /// An enumerator from `first` to `last`.
    template <class Enum>
    Reader& operator()(Enum& value, Enum last) {
        std::uint8_t number = 0;
        (*this)(number);
        failed_ = failed_ || number > static_cast<std::uint8_t>(last);
        value = failed_ ? last : static_cast<Enum>(number);
        return *this;
    }

    /// How many elements follow, at most `most`.
    std::uint32_t count(std::uint32_t most) {
        std::uint32_t count = 0;
        (*this)(count);
        failed_ = failed_ || count > most;
        return failed_ ? 0 : count;
    }

    template <class T>
    std::optional<T> finished(T value) const {
        return failed_ || !left_.empty() ? std::nullopt : std::optional<T>(std::move(value));
    }

private:
    std::string_view left_;
    bool failed_ = false;
};

template <class Enum>
std::uint8_t number(Enum value) {
    return static_cast<std::uint8_t>(value);
}

constexpr std::uint32_t kMostSelections = 64;
constexpr std::uint32_t kVersion = 2; // of what is said: ends of two builds part at once

} // namespace

std::string encodeRequest(const std::string& path, const LoadOptions& o) {
    Writer write(Packet::Request);
    write(kVersion)(path)(o.series)(static_cast<std::uint32_t>(o.select.size()));
    for (const Selection& selection : o.select) {
        write(selection.key)(selection.value);
    }
    const RawLayout raw = o.raw.value_or(RawLayout{});
    write(o.time.value_or(-1))(number(o.resampleUneven))(number(o.raw.has_value()))(raw.dims);
    write(number(raw.type))(raw.spacingMm)(number(raw.bigEndian))(o.rawSkipBytes);
    write(number(o.spacingMm.has_value()))(o.spacingMm.value_or(glm::dvec3(0.0)))(o.unit);
    return std::move(write(o.limits)).bytes();
}

std::optional<Request> decodeRequest(std::string_view packet) {
    Request request;
    LoadOptions& o = request.options;
    Reader read(packet);
    std::uint32_t version = 0;
    read(version)(request.path)(o.series);
    o.select.resize(read.count(kMostSelections));
    for (Selection& selection : o.select) {
        read(selection.key)(selection.value);
    }
    int time = -1;
    bool hasRaw = false;
    bool hasSpacing = false;
    RawLayout raw;
    glm::dvec3 spacing(0.0);
    read(time)(o.resampleUneven, true)(hasRaw, true)(raw.dims)(raw.type, VoxelType::F64);
    read(raw.spacingMm)(raw.bigEndian, true)(o.rawSkipBytes)(hasSpacing, true)(spacing)(o.unit);
    read(o.limits);
    o.time = time >= 0 ? std::optional(time) : std::nullopt;
    o.raw = hasRaw ? std::optional(raw) : std::nullopt;
    o.spacingMm = hasSpacing ? std::optional(spacing) : std::nullopt;
    return version == kVersion ? read.finished(std::move(request)) : std::nullopt;
}

std::string encodeProgress(const LoadProgress& progress) {
    return std::move(Writer(Packet::Progress)(progress.file.string())(progress.done)).bytes();
}

std::optional<LoadProgress> decodeProgress(std::string_view packet) {
    std::string file;
    LoadProgress progress;
    Reader read(packet);
    read(file)(progress.done);
    progress.file = file;
    return read.finished(std::move(progress));
}

std::string encodeVolume(Packet kind, const Volume& volume) {
    const auto notes = std::min(volume.notes.size(), kMostNotes);
    Writer write(kind);
    write(volume.name)(volume.unit)(number(volume.modality))(number(volume.type))(volume.geometry);
    write(volume.rescaleSlope)(volume.rescaleIntercept)(volume.nonFiniteVoxels);
    write(static_cast<std::uint64_t>(volume.voxels.size()))(static_cast<std::uint32_t>(notes));
    for (std::size_t i = 0; i < notes; ++i) {
        write(volume.notes[i].substr(0, kLongestNote));
    }
    return std::move(write).bytes();
}

std::optional<Volume> decodeVolume(std::string_view packet) {
    Volume volume;
    std::uint64_t bytes = 0;
    Reader read(packet);
    read(volume.name)(volume.unit)(volume.modality, Modality::Mr)(volume.type, VoxelType::F64);
    read(volume.geometry)(volume.rescaleSlope)(volume.rescaleIntercept)(volume.nonFiniteVoxels);
    read(bytes);
    volume.notes.resize(read.count(kMostNotes));
    for (std::string& note : volume.notes) {
        read(note);
    }
    return read.finished(std::move(volume));
}

std::string encodeFailed(const Error& error) {
    return std::move(Writer(Packet::Failed)(number(error.code))(error.detail)).bytes();
}

std::optional<Error> decodeFailed(std::string_view packet) {
    Error error;
    Reader read(packet);
    read(error.code, ErrorCode::Cancelled)(error.detail);
    return read.finished(std::move(error));
}

std::optional<Packet> kindOf(std::string_view packet) {
    const bool known = !packet.empty() && static_cast<unsigned char>(packet[0]) <=
                                              static_cast<unsigned char>(Packet::Failed);
    return known ? std::optional(static_cast<Packet>(packet[0])) : std::nullopt;
}

bool send(int socket, std::string_view packet, int file) {
    iovec part{const_cast<char*>(packet.data()), packet.size()};
    alignas(cmsghdr) std::array<char, CMSG_SPACE(sizeof(int))> control{};
    msghdr message{};
    message.msg_iov = &part;
    message.msg_iovlen = 1;
    if (file >= 0) {
        message.msg_control = control.data();
        message.msg_controllen = control.size();
        cmsghdr* header = CMSG_FIRSTHDR(&message);
        header->cmsg_level = SOL_SOCKET;
        header->cmsg_type = SCM_RIGHTS;
        header->cmsg_len = CMSG_LEN(sizeof(int));
        std::memcpy(CMSG_DATA(header), &file, sizeof(int));
    }
    return sendmsg(socket, &message, MSG_NOSIGNAL) == static_cast<ssize_t>(packet.size());
}

Received receive(int socket) {
    Received received;
    received.packet.resize(kLongestPacket);
    iovec part{received.packet.data(), received.packet.size()};
    alignas(cmsghdr) std::array<char, CMSG_SPACE(sizeof(int))> control{};
    msghdr message{};
    message.msg_iov = &part;
    message.msg_iovlen = 1;
    message.msg_control = control.data();
    message.msg_controllen = control.size();
    const ssize_t size = recvmsg(socket, &message, MSG_CMSG_CLOEXEC);
    received.packet.resize(size > 0 ? static_cast<std::size_t>(size) : 0);
    cmsghdr* header = size > 0 ? CMSG_FIRSTHDR(&message) : nullptr;
    if (header != nullptr && header->cmsg_level == SOL_SOCKET && header->cmsg_type == SCM_RIGHTS) {
        std::memcpy(&received.file, CMSG_DATA(header), sizeof(int));
    }
    return received;
}

} // namespace slabcast::apart
