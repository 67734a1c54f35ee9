#pragma once

#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/base/contract_hook.h"
#include "core/base/executor.h"
#include "core/gl/caps.h"
#include "core/gl/get_proc.h"
#include "core/scene/texel_format.h"

namespace slabcast {

/// Known faults and oddities of drivers that no query and no self-test finds: plain booleans, which
/// code asks instead of names.
struct Quirks {
    bool computeIsSlow = false;      // compute shaders run on the host: structures are built there
    bool noNorm16 = false;           // R16 textures are left alone, whatever the self-test says
    bool noFramebufferFetch = false; // shaders do not read the target, whatever is offered

    bool operator==(const Quirks&) const = default;
};

/// Those known of this driver, by its strings. Pure. Tested by: device_test.cpp
Quirks knownQuirks(const gl::Caps& caps);

/// How a volume lies in textures on a device.
struct TextureChoice {
    TexelFormat texels = TexelFormat::R8;
    double filterErrorOfFullScale = 0.0; // what the device's filter may add to a sample
    int maxTableSize = 4096;             // texels of a transfer table, at most
    bool filtersTable = false;           // the device's filter may read the table
    std::string reason;                  // of the format: one line
};

using LogHook = std::function<void(const std::string& line)>;

/// What a host says of itself when it opens a device.
struct DeviceOptions {
    std::vector<std::string> maskedExtensions; // behave as absent
    std::optional<Quirks> quirks;              // instead of those that are known of the driver
    /// Hears one line at a time of what was done instead of what was asked for (a structure built
    /// on the CPU because the GPU's builder does not run here). Called in the GL thread. None:
    /// lines go to stderr, which is lost on Android.
    LogHook log;
    /// Hears of a mistake of the calling code before the process aborts; one hook for the process
    /// (setContractHook()). Null leaves the hook as it is.
    ContractHook contract = nullptr;
    /// Lends its threads to heavy CPU steps: statistics, texels, skip structures, tables. Installed
    /// when the device is made, one for the process (setExecutor()): what is done before, such as
    /// making a volume, runs on what was set then. Not owned: it must outlive all work, that of
    /// other devices too, or be replaced first by setExecutor(). Its run() is called in whatever
    /// thread calls the library; its threads call no GL. Contract: no work is going on. Null leaves
    /// what is set; at first a thread per core of the library's own.
    Executor* executor = nullptr;
};

/// A GL context and what it can do: loaded functions, limits and extensions, the results of drawing
/// into tiny textures (no query tells what a driver really filters), known quirks. Copies are cheap
/// and share all. Holds no GL objects: a lost context leaves nothing behind. Tested by:
/// device_test.cpp, scene_gl_test.cpp
class Device {
public:
    /// Loads GL's functions (one set for the process) and tests the device. Thread: the context is
    /// current here. Restores the GL state (gl::StateGuard). Cost: 40 small draws, once.
    /// Fails: InvalidArgument (no loader), DeviceUnsupported (below GLES 3.2).
    static Result<Device> open(gl::GetProc getProc, DeviceOptions options = {});

    /// Of facts that were found elsewhere; calls no GL.
    Device(gl::Caps caps, std::vector<TexelFormatTest> formats, DeviceOptions options = {},
           TableFilterTest tableFilter = {});

    const gl::Caps& caps() const { return state_->caps; }
    const Quirks& quirks() const { return state_->quirks; }
    /// One entry per texel format: usable or not, and how wrong its filter is.
    std::span<const TexelFormatTest> formats() const { return state_->formats; }
    /// Whether the device's filter may read a transfer function's table, and how wrong it is.
    const TableFilterTest& tableFilter() const { return state_->tableFilter; }

    /// The format for such voxels, with what exact skipping must know of its filter.
    /// `exact`: texels are interpolated in the shader, in float32, whatever the device filters; so
    /// they are where those that it filters have steps above `longestStep` (longestTexelStep()).
    TextureChoice texturesFor(VoxelType type, const VolumeStatistics& statistics,
                              bool exact = false,
                              double longestStep = std::numeric_limits<double>::infinity()) const;

    /// Of a format's filter, as the self-test found it; 0 of one that was not tested.
    double filterErrorOfFullScale(TexelFormat format) const;

    void log(const std::string& line) const;

private:
    struct State {
        gl::Caps caps;
        std::vector<TexelFormatTest> formats;
        TableFilterTest tableFilter;
        Quirks quirks;
        LogHook log;
    };
    std::shared_ptr<const State> state_;
};

} // namespace slabcast
