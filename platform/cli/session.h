#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/scene/device.h"
#include "core/volume/statistics.h"
#include "platform/egl/egl_context.h"
#include "platform/io/load_volume.h"

namespace slabcast {

/// A headless context and what it can do.
struct Session {
    EglContext context;
    Device device;
};

/// What a command that draws says of the device.
struct SessionOptions {
    /// By its name in core/scene/known_devices.h, the device whose capabilities and self-test
    /// results are assumed; empty: SLABCAST_DEVICE, or what is there is asked and tested.
    std::string device;
};

/// Extensions named in SLABCAST_MASK_EXTENSIONS behave as absent. Says on stderr what is assumed.
/// Fails: as Device::open(); InvalidArgument (SLABCAST_DEVICE names no device that is known).
Result<Session> openSession(const SessionOptions& options);

/// What is common to all commands that read a volume.
struct InputOptions {
    std::string volume; // a file, a folder, or phantom:NAME[:SIZE]
    LoadOptions load;
    int downsample = 1;
    int cubeEdge = 0; // resampled to so many voxels along each axis; 0: as it is
    bool exact = false;
    std::optional<double> gpuBudgetMib;
    bool keepValues = false; // the volume's own values too, for references
};

/// Shows at the terminal how far it is.
Result<Volume> openVolume(const InputOptions& options);
/// What its reader assumed or left out, on stderr.
void sayNotes(const InputOptions& options, const Volume& volume);
/// computeStatistics(), with a line at the terminal.
VolumeStatistics statisticsOf(const Volume& volume);

/// Host memory at its peak so far, bytes (VmHWM).
std::int64_t peakHostBytes();

} // namespace slabcast
