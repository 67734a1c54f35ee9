#pragma once

#include <cstdint>
#include <filesystem>

#include "core/base/error.h"
#include "core/base/executor.h"
#include "core/volume/volume.h"
#include "platform/io/base/load_options.h"

namespace slabcast {

/// What the module slabcast_dicom can do, which holds all that needs DCMTK. That library fills its
/// tables whenever a program that links it starts, for 9 to 13 ms; opened on first use, that time
/// is only theirs who read DICOM. The module is made by the same build as what opens it, so C++
/// types may cross.
struct DicomModule {
    static constexpr std::uint32_t kVersion = 1;

    std::uint32_t version;
    std::size_t sizes[2]; // of what crosses: another build's is not taken
    /// As base/readers.h has it, on the threads of `threads`.
    Result<Volume> (*readFile)(const std::filesystem::path& path, const LoadOptions& options,
                               Executor& threads);
    Result<Volume> (*readSeries)(const std::filesystem::path& folder, const LoadOptions& options,
                                 Executor& threads);
};

inline constexpr std::size_t kDicomModuleSizes[2] = {sizeof(LoadOptions), sizeof(Volume)};

/// The module's only symbol, of type `const DicomModule*()`.
inline constexpr const char* kDicomModuleEntry = "slabcastDicomModule";

} // namespace slabcast
