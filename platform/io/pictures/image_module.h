#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>

#include "core/base/error.h"
#include "core/volume/volume.h"

namespace slabcast {

struct ImageFile; // open for reading, in the module's keeping

/// One page of an image file. `typeName` is the library's word for a type; where it is none of
/// ours, `isReadable` is false.
struct ImagePage {
    int width = 0;
    int height = 0;
    int channels = 0;
    VoxelType type = VoxelType::U8;
    bool isReadable = false;
    const char* typeName = "";
    double resolution[2] = {0.0, 0.0}; // pixels per unit along rows and columns, 0: unsaid
    int resolutionUnit = 1;            // as in TIFF: 1 none, 2 inch, 3 centimetre
    int orientation = 1;               // as in TIFF: 1 to 8
};

/// What the module slabcast_images can do, which holds all that needs OpenImageIO. That library
/// brings some 240 others along (OpenVDB, GDAL, FFmpeg, OpenCV): linked, it made `slabcast --help`
/// take 0.3 s and 134 MiB, opened on first use, 0.03 s and 23 MiB. Plain types, and nothing thrown.
/// What fails returns null or false, and lastError() of the same thread says why.
struct ImageModule {
    static constexpr std::uint32_t kVersion = 3; // of this layout

    using TakeBytes = void (*)(void* taker, const char* bytes, std::size_t count);

    std::uint32_t version;
    const char* (*lastError)() noexcept;
    /// Of a file's bytes, which stay where they are until it is closed; `path`: for its ending.
    ImageFile* (*open)(const char* path, const void* bytes, std::size_t count) noexcept;
    void (*close)(ImageFile* file) noexcept;
    /// False also where there is no such page.
    bool (*describe)(ImageFile* file, int index, ImagePage* page) noexcept;
    /// One channel, from 0.
    bool (*read)(ImageFile* file, int index, int channel, void* pixels) noexcept;
    bool (*encodeExr)(int width, int height, const float* rgba, TakeBytes take,
                      void* taker) noexcept;
};

/// The module's only symbol, of type `const ImageModule*()`.
inline constexpr const char* kImageModuleEntry = "slabcastImageModule";

/// The module, opened at the first call: OpenImageIO keeps threads and exit handlers, so it stays.
/// Fails: `failure`, naming `path`, for whose sake it is opened. Tested by: io_libraries_test.cpp,
/// consumer_test.sh
Result<const ImageModule*> imageModule(const std::filesystem::path& path, ErrorCode failure);

/// For tests: of any file, looked for anew. The error's detail is the cause alone.
Result<const ImageModule*> openImageModule(const char* fileName);

} // namespace slabcast
