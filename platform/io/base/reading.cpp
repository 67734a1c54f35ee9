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

} // namespace slabcast
