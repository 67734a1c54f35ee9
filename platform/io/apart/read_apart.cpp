#include "platform/io/apart/read_apart.h"

#include <array>
#include <cerrno>
#include <csignal>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <vector>

#include <dlfcn.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "platform/io/apart/wire.h"

namespace slabcast::apart {

namespace {

constexpr int kTickMs = 50; // how often cancelling and being stuck are looked for

/// A file descriptor that is closed in the end.
class File {
public:
    explicit File(int number = -1) : number_(number) {}
    File(File&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
    File& operator=(File&& other) noexcept {
        std::swap(number_, other.number_);
        return *this;
    }
    ~File() {
        if (number_ >= 0) {
            close(number_);
        }
    }
    int number() const { return number_; }

private:
    int number_;
};

/// The folders in which the dynamic linker looks for this program's libraries.
std::vector<std::filesystem::path> libraryFolders() {
    std::vector<std::filesystem::path> folders;
#ifdef __GLIBC__ // RTLD_DI_SERINFO is its own
    void* program = dlopen(nullptr, RTLD_LAZY);
    Dl_serinfo size{};
    if (program != nullptr && dlinfo(program, RTLD_DI_SERINFOSIZE, &size) == 0) {
        std::vector<std::max_align_t> room(size.dls_size / sizeof(std::max_align_t) + 1);
        auto* info = reinterpret_cast<Dl_serinfo*>(room.data());
        *info = size;
        if (dlinfo(program, RTLD_DI_SERINFO, info) == 0) {
            for (unsigned k = 0; k < info->dls_cnt; ++k) {
                folders.emplace_back(info->dls_serpath[k].dls_name);
            }
        }
    }
    if (program != nullptr) {
        dlclose(program);
    }
#endif
    return folders;
}

Result<std::string> findReader(const std::filesystem::path& path) {
    const auto runs = [](const std::filesystem::path& file) {
        return access(file.c_str(), X_OK) == 0;
    };
    const char* named = std::getenv("SLABCAST_READER");
    if (named != nullptr && !runs(named)) {
        return fail(ErrorCode::FileUnreadable,
                    fmt::format("{}: SLABCAST_READER names {}, which is no program; name "
                                "slabcast-read there, or leave the variable out",
                                path.string(), named));
    }
    if (named != nullptr) {
        return named;
    }
    for (const std::filesystem::path& folder : libraryFolders()) {
        if (runs(folder / "slabcast-read")) {
            return (folder / "slabcast-read").string();
        }
    }
    return fail(ErrorCode::FileUnreadable,
                fmt::format("{}: the program slabcast-read, which reads files, is not found; "
                            "install Slabcast again, name it in SLABCAST_READER, or its folder in "
                            "LD_LIBRARY_PATH",
                            path.string()));
}

/// The running reader. Killed, if need be, and gone with this.
class Child {
public:
    Child(pid_t pid, File socket) : pid_(pid), socket_(std::move(socket)) {}
    Child(Child&& other) noexcept
        : pid_(std::exchange(other.pid_, -1)), socket_(std::move(other.socket_)) {}
    ~Child() {
        if (pid_ > 0) {
            end();
        }
    }

    int socket() const { return socket_.number(); }

    double cpuSeconds() const {
        clockid_t clock{};
        timespec used{};
        const bool known =
            clock_getcpuclockid(pid_, &clock) == 0 && clock_gettime(clock, &used) == 0;
        return known ? double(used.tv_sec) + double(used.tv_nsec) * 1e-9 : 0.0;
    }

    /// The signal that it died of; 0: it had not died of one.
    int end() {
        int status = 0;
        kill(pid_, SIGKILL); // where it has ended already, its own status stays
        while (waitpid(pid_, &status, 0) < 0 && errno == EINTR) {
        }
        pid_ = -1;
        return WIFSIGNALED(status) ? WTERMSIG(status) : 0;
    }

private:
    pid_t pid_;
    File socket_;
};

Result<Child> start(const std::filesystem::path& path) {
    const Result<std::string> reader = findReader(path);
    if (!reader) {
        return tl::unexpected(reader.error());
    }
    std::array<int, 2> ends{-1, -1};
    if (socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends.data()) != 0) {
        return fail(ErrorCode::FileUnreadable,
                    fmt::format("{}: cannot talk to its reader ({}); close other programs",
                                path.string(), std::strerror(errno)));
    }
    File ours(ends[0]);
    const File theirs(ends[1]);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    // First: in a program that closed its standard streams the socket may be one of them.
    posix_spawn_file_actions_adddup2(&actions, theirs.number(), kReaderSocket);
    // Its libraries' chatter goes nowhere: what matters is in the error that it sends.
    for (const int standard : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
        posix_spawn_file_actions_addopen(&actions, standard, "/dev/null", O_RDWR, 0);
    }
    // In a group of its own: Ctrl-C at the terminal is for the program, which ends its reader.
    posix_spawnattr_t attributes;
    posix_spawnattr_init(&attributes);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
    posix_spawnattr_setpgroup(&attributes, 0);
    std::string program = *reader;
    std::array<char*, 2> arguments = {program.data(), nullptr};
    pid_t pid = -1;
    const int failed =
        posix_spawn(&pid, program.c_str(), &actions, &attributes, arguments.data(), environ);
    posix_spawnattr_destroy(&attributes);
    posix_spawn_file_actions_destroy(&actions);
    if (failed != 0) {
        return fail(ErrorCode::FileUnreadable,
                    fmt::format("{}: its reader {} cannot be started ({}); install Slabcast again",
                                path.string(), program, std::strerror(failed)));
    }
    return Child(pid, std::move(ours));
}

tl::unexpected<Error> broken(const LoadProgress& last, std::string_view what) {
    return fail(ErrorCode::FileUnreadable,
                fmt::format("{}: {}; the file may be damaged: fetch it again, or convert it to "
                            "another format",
                            last.file.string(), what));
}

/// The voxels in the file that the reader sent, which the header must agree with.
Result<Volume> adopt(Volume volume, File memory, const LoadProgress& last) {
    const Result<std::int64_t> asked = checkedByteCount(volume.geometry.dims, volume.type);
    struct stat found {};
    // Nobody can shorten it any more, which would end whoever reads from the mapping.
    const bool sealed = fcntl(memory.number(), F_ADD_SEALS, F_SEAL_SHRINK | F_SEAL_GROW) == 0;
    if (!asked || !sealed || fstat(memory.number(), &found) != 0 || found.st_size < *asked) {
        return broken(last, "its reader sent no voxels");
    }
    const auto size = static_cast<std::size_t>(*asked);
    // Shared with nobody, for the reader has ended; written to without a copy.
    void* mapping = mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_SHARED, memory.number(), 0);
    if (mapping == MAP_FAILED) {
        return fail(ErrorCode::FileUnreadable,
                    fmt::format("{}: out of memory for {} bytes of voxels; close other programs or "
                                "take a smaller volume",
                                last.file.string(), size));
    }
    volume.voxels = VoxelBytes::adopted(static_cast<std::byte*>(mapping), size,
                                        [size](std::byte* voxels) { munmap(voxels, size); });
    return volume;
}

} // namespace

Result<Volume> readApart(const std::filesystem::path& path, const LoadOptions& options) {
    Result<Child> child = start(path);
    if (!child) {
        return tl::unexpected(child.error());
    }
    send(child->socket(), encodeRequest(path.string(), options));
    LoadProgress last{path, 0.0};
    double cpuAtProgress = 0.0;
    while (true) {
        if (options.cancel != nullptr && options.cancel->load()) {
            return fail(ErrorCode::Cancelled, fmt::format("{}: cancelled", path.string()));
        }
        pollfd ready{child->socket(), POLLIN, 0};
        if (poll(&ready, 1, kTickMs) == 0) {
            if (child->cpuSeconds() - cpuAtProgress > options.limits.stuckSeconds) {
                return broken(last, fmt::format("reading it got no further in {:g} s of computing",
                                                options.limits.stuckSeconds));
            }
            continue;
        }
        Received received = receive(child->socket());
        File file(received.file);
        const std::optional<Packet> kind = kindOf(received.packet);
        if (kind == Packet::Progress) {
            last = decodeProgress(received.packet).value_or(last);
            cpuAtProgress = child->cpuSeconds();
            if (options.progress) {
                options.progress(last);
            }
            continue;
        }
        if (kind == Packet::Header) {
            const std::optional<Volume> header = decodeVolume(received.packet);
            const Result<void> wanted =
                header && options.admit ? options.admit(*header) : Result<void>();
            if (!wanted) {
                return tl::unexpected(wanted.error());
            }
            send(child->socket(), std::string(1, static_cast<char>(Packet::Header)));
            continue;
        }
        const int signal = child->end();
        if (kind == Packet::Failed) {
            return tl::unexpected(decodeFailed(received.packet).value_or(Error{}));
        }
        std::optional<Volume> volume =
            kind == Packet::Done ? decodeVolume(received.packet) : std::nullopt;
        if (volume) {
            return adopt(std::move(*volume), std::move(file), last).and_then(validated);
        }
        return broken(last, signal == 0 || signal == SIGKILL
                                ? "its reader ended without an answer"
                                : fmt::format("its reader broke on it ({})", strsignal(signal)));
    }
}

} // namespace slabcast::apart
