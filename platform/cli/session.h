#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/draw/renderer.h"
#include "core/scene/memory_forecast.h"
#include "core/scene/scene.h"
#include "core/scene/texel_format.h"
#include "platform/egl/egl_context.h"

namespace slabcast {

/// A headless context and what it can do.
struct Session {
    EglContext context;
    gl::Caps caps;
    std::vector<TexelFormatTest> formats;
};

/// Extensions named in SLABCAST_MASK_EXTENSIONS behave as absent.
Result<Session> openSession();

/// What is common to all commands that read a volume.
struct InputOptions {
    std::string volume; // a file, a folder, or phantom:NAME[:SIZE]
    std::string series;
    std::string raw;
    int downsample = 1;
    int cubeEdge = 0; // resampled to so many voxels along each axis; 0: as it is
    bool exact = false;
    std::optional<double> gpuBudgetMib;
    bool keepValues = false; // the volume's own values too, for references
};

Result<Volume> openVolume(const InputOptions& options);

/// What the texture unit's filter may add to a sample, in sampled units.
double filterErrorSampled(const Session& session, TexelFormat format);

/// What statistics say of the volume after its voxels are gone.
struct VolumeInfo {
    std::string name;
    VoxelType type = VoxelType::U8;
    std::string unit;
    glm::ivec3 dims{0};
    glm::dvec3 spacingMm{0.0};
    std::int64_t bytes = 0;
    Modality modality = Modality::Unknown;
    std::string formatReason;
    MemoryForecast forecast;
};

struct LoadedScene {
    Scene scene;
    VolumeInfo info;
    std::optional<Texels> values; // exact, where they are to be kept
};

/// What the texels take where they are classified so. Fails: as checkFits() and forecastMemory().
Result<MemoryForecast> checkMemory(const VolumeInfo& info, TexelFormat format,
                                   Classification classification, const InputOptions& options,
                                   const gl::Caps& caps);

/// Chooses the texel format, checks that what this classification uploads fits before anything is
/// allocated on the GPU, builds the scene.
Result<LoadedScene> openScene(const InputOptions& options, Classification classification,
                              const Session& session);

/// Host memory at its peak so far, bytes (VmHWM).
std::int64_t peakHostBytes();

} // namespace slabcast
