// slabcast-read: reads one volume for another process, which read_apart.cpp starts it from.

#include <array>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <vector>

#include <sys/mman.h>
#include <sys/socket.h>
#include <unistd.h>

#include "platform/io/apart/confine.h"
#include "platform/io/apart/wire.h"
#include "platform/io/load_volume.h"

namespace slabcast::apart {
namespace {

/// Memory that can be handed over.
struct Shared {
    int file = -1;
    std::byte* bytes = nullptr;
};

std::vector<Shared>& allShared() {
    static std::vector<Shared> all;
    return all;
}

VoxelBytes allocateShared(std::size_t size) {
    const int file = memfd_create("slabcast voxels", MFD_CLOEXEC | MFD_ALLOW_SEALING);
    if (file < 0 || size == 0) {
        return VoxelBytes(size);
    }
    if (ftruncate(file, static_cast<off_t>(size)) != 0) {
        close(file);
        throw std::bad_alloc();
    }
    void* mapping = mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
    if (mapping == MAP_FAILED) {
        throw std::bad_alloc();
    }
    allShared().push_back({file, static_cast<std::byte*>(mapping)});
    return VoxelBytes::adopted(allShared().back().bytes, size, [size, file](std::byte* bytes) {
        munmap(bytes, size);
        close(file);
        std::erase_if(allShared(), [&](const Shared& shared) { return shared.bytes == bytes; });
    });
}

/// The file behind these bytes, which are moved into one where they are not there already.
int sharedFile(VoxelBytes& bytes) {
    for (int attempt = 0; attempt < 2; ++attempt) {
        for (const Shared& shared : allShared()) {
            if (shared.bytes == bytes.data()) {
                return shared.file;
            }
        }
        VoxelBytes moved = allocateShared(bytes.size());
        std::copy(bytes.begin(), bytes.end(), moved.begin());
        bytes = std::move(moved);
    }
    return -1;
}

int run() {
    const Received received = receive(kReaderSocket);
    std::optional<Request> request =
        kindOf(received.packet) == Packet::Request ? decodeRequest(received.packet) : std::nullopt;
    if (!request) {
        std::fputs("slabcast-read: is started by Slabcast's library, which tells it what to read; "
                   "run slabcast info FILE\n",
                   stderr);
        return 1;
    }
    setenv("DCMDICTPATH", "/dev/null", 0); // until a file needs DCMTK's dictionary: dicom_dataset.h
    confine(request->options.limits);
    std::signal(SIGXFSZ, SIG_IGN); // an error where room is made for too many voxels
    LoadOptions& options = request->options;
    options.process = ReadIn::ThisProcess;
    options.allocate = allocateShared;
    options.progress = [](const LoadProgress& progress) {
        if (!send(kReaderSocket, encodeProgress(progress))) {
            _exit(1); // nobody waits for it any more
        }
    };
    options.admit = [](const Volume& header) -> Result<void> {
        send(kReaderSocket, encodeVolume(Packet::Header, header));
        if (receive(kReaderSocket).packet.empty()) {
            _exit(1); // who does not want it has gone
        }
        return {};
    };
    Result<Volume> volume = loadVolume(request->path, options);
    if (volume) {
        const int file = sharedFile(volume->voxels);
        const auto size = static_cast<off_t>(volume->voxels.size());
        if (file >= 0 && ftruncate(file, size) != 0) { // of narrowed voxels some room is left
            return 1;
        }
        send(kReaderSocket, encodeVolume(Packet::Done, *volume), file);
    } else {
        send(kReaderSocket, encodeFailed(volume.error()));
    }
    _exit(0); // nothing is left to tidy up, and libraries' exit handlers may break on what was read
}

} // namespace
} // namespace slabcast::apart

int main() {
    return slabcast::apart::run();
}
