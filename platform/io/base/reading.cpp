#include <algorithm>
#include <array>
#include <fstream>

#include <fmt/format.h>

#include "platform/io/base/readers.h"

namespace slabcast {

Result<void> going(const LoadOptions& options, const std::filesystem::path& file, double done) {
    if (options.progress) {
        options.progress({file, done});
    }
    if (options.cancel != nullptr && options.cancel->load()) {
        return fail(ErrorCode::Cancelled, fmt::format("{}: cancelled", file.string()));
    }
    return {};
}

Result<void> admitted(const LoadOptions& options, const Volume& header) {
    return options.admit ? options.admit(header) : Result<void>();
}

VoxelBytes makeVoxels(const LoadOptions& options, std::size_t size) {
    return options.allocate ? options.allocate(size) : VoxelBytes(size);
}

bool hasDicomMark(const std::filesystem::path& path) {
    constexpr std::streamoff kPreambleBytes = 128; // DICOM PS3.10, section 7.1
    std::ifstream file(path, std::ios::binary);
    std::array<char, 4> mark{};
    file.seekg(kPreambleBytes).read(mark.data(), mark.size());
    return file && std::string_view(mark.data(), mark.size()) == "DICM";
}

bool holdDicom(const std::vector<std::filesystem::path>& files) {
    return std::any_of(files.begin(), files.end(), hasDicomMark);
}

} // namespace slabcast
