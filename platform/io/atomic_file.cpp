#include "platform/io/atomic_file.h"

#include <atomic>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <system_error>

#include <fmt/format.h>
#include <unistd.h>

#include "platform/io/unfinished.h"

namespace slabcast {

namespace {

tl::unexpected<Error> unwritable(const std::filesystem::path& path, std::string_view why,
                                 std::string_view remedy) {
    return fail(ErrorCode::FileUnwritable, fmt::format("{}: {}; {}", path.string(), why, remedy));
}

/// In the same folder, so that renaming is one step, and with the same ending, which image
/// writers go by.
std::filesystem::path temporaryBeside(const std::filesystem::path& path) {
    static std::atomic<int> counter{0};
    return path.parent_path() / fmt::format(".{}.{}-{}{}", path.stem().string(), getpid(),
                                            ++counter, path.extension().string());
}

/// Takes the temporary file away unless it was renamed.
class TemporaryFile {
public:
    explicit TemporaryFile(std::filesystem::path path)
        : path_(std::move(path)), unfinished_(path_) {}
    ~TemporaryFile() {
        std::error_code ignored;
        std::filesystem::remove(path_, ignored);
    }
    TemporaryFile(const TemporaryFile&) = delete;
    TemporaryFile& operator=(const TemporaryFile&) = delete;

    const std::filesystem::path& path() const { return path_; }

private:
    std::filesystem::path path_;
    Unfinished unfinished_;
};

} // namespace

Result<void> checkWritable(const std::filesystem::path& path) {
    std::error_code error;
    const std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : ".";
    if (!std::filesystem::is_directory(folder, error)) {
        return unwritable(path, fmt::format("there is no folder {}", folder.string()),
                          "make it or name another");
    }
    if (access(folder.c_str(), W_OK) != 0) {
        return unwritable(path, std::strerror(errno), "check the folder's permissions");
    }
    const std::filesystem::file_status status = std::filesystem::status(path, error);
    if (!path.has_filename() || (exists(status) && !is_regular_file(status))) {
        return unwritable(path, "is not a file", "name a file to write");
    }
    return {};
}

Result<void> writeFileAtomically(const std::filesystem::path& path, const FileWriter& write) {
    if (const Result<void> sound = checkWritable(path); !sound) {
        return sound;
    }
    const TemporaryFile temporary(temporaryBeside(path));
    if (const Result<void> written = write(temporary.path()); !written) {
        return written;
    }
    std::error_code error;
    std::filesystem::rename(temporary.path(), path, error);
    if (error) {
        return unwritable(path, error.message(), "check the folder's permissions");
    }
    return {};
}

Result<void> writeFileAtomically(const std::filesystem::path& path, std::string_view content) {
    return writeFileAtomically(path, [&](const std::filesystem::path& temporary) -> Result<void> {
        std::ofstream file(temporary, std::ios::binary);
        file.write(content.data(), static_cast<std::streamsize>(content.size()));
        file.close(); // a full disk may show only now
        if (!file) {
            return unwritable(path, std::strerror(errno),
                              "check the folder's permissions and the space left");
        }
        return {};
    });
}

} // namespace slabcast
