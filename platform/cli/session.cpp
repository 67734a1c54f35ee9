#include "platform/cli/session.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include <fmt/core.h>

#include "core/scene/known_devices.h"
#include "core/volume/downsample.h"
#include "core/volume/phantoms.h"
#include "core/volume/resample.h"
#include "platform/cli/progress.h"

namespace slabcast {

namespace {

/// Of masked extensions by name; a set of them is of many drivers. In the current context.
void sayUnknownMasks(const std::string& mask) {
    const std::vector<std::string> named = gl::parseExtensionMask(mask);
    const Result<gl::Caps> caps = gl::queryCaps();
    if (!caps || named == gl::mobileStrictMask()) {
        return;
    }
    for (const std::string& extension : named) {
        if (!std::binary_search(caps->extensions.begin(), caps->extensions.end(), extension)) {
            say(fmt::format("SLABCAST_MASK_EXTENSIONS: this driver has no {}; `slabcast device` "
                            "names what drawing may use",
                            extension));
        }
    }
}

/// Null where none is to be assumed.
Result<const KnownDevice*> assumedDevice(const SessionOptions& options) {
    const char* variable = std::getenv("SLABCAST_DEVICE");
    const std::string name = !options.device.empty() ? options.device
                             : variable != nullptr   ? variable
                                                     : "";
    const KnownDevice* known = findKnownDevice(name);
    if (known == nullptr && !name.empty()) {
        return fail(
            ErrorCode::InvalidArgument,
            fmt::format("SLABCAST_DEVICE: '{}' is not one of {}", name, knownDeviceNames()));
    }
    return known;
}

bool isPhantom(const InputOptions& options) {
    return options.volume.starts_with("phantom:");
}

Result<Volume> phantomOf(const InputOptions& options) {
    const Progress progress("making " + options.volume);
    Result<Volume> phantom = makePhantom(options.volume);
    return phantom && options.load.admit
               ? options.load.admit(*phantom).map([&] { return std::move(*phantom); })
               : phantom;
}

Result<Volume> fileOf(const InputOptions& options) {
    Progress progress("reading " + options.volume);
    std::string shown;
    LoadOptions load = options.load;
    load.progress = [&](const LoadProgress& now) {
        std::string line =
            fmt::format("reading {}: {:.0f} %", now.file.filename().string(), 100.0 * now.done);
        if (line != shown) {
            progress.show(line);
            shown = std::move(line);
        }
    };
    return loadVolume(options.volume, load);
}

} // namespace

Result<Session> openSession(const SessionOptions& options) {
    const Result<const KnownDevice*> known = assumedDevice(options);
    if (!known) {
        return tl::unexpected(known.error());
    }
    Result<EglContext> context = EglContext::create();
    if (!context) {
        return tl::unexpected(context.error());
    }
    const char* mask = std::getenv("SLABCAST_MASK_EXTENSIONS");
    DeviceOptions asked = {.maskedExtensions = gl::parseExtensionMask(mask == nullptr ? "" : mask),
                           .log = say};
    Result<Device> device = *known == nullptr
                                ? Device::open(context->getProc(), std::move(asked))
                                : openAs(**known, context->getProc(), std::move(asked));
    if (!device) {
        return tl::unexpected(device.error());
    }
    if (*known != nullptr) {
        say(fmt::format("what the {} can do is assumed, and nothing of it tested; {}",
                        (*known)->renderer, device->caps().driver));
    }
    sayUnknownMasks(mask == nullptr ? "" : mask);
    return Session{std::move(*context), std::move(*device)};
}

Result<Volume> openVolume(const InputOptions& options) {
    Result<Volume> volume = isPhantom(options) ? phantomOf(options) : fileOf(options);
    const Progress progress(options.downsample > 1 || options.cubeEdge > 0 ? "averaging voxels"
                                                                           : "");
    if (volume && options.downsample > 1) {
        volume = downsample(*volume, glm::ivec3(options.downsample));
    }
    if (volume && options.cubeEdge > 0) {
        volume = resample(*volume, glm::ivec3(options.cubeEdge));
    }
    return volume;
}

void sayNotes(const InputOptions& options, const Volume& volume) {
    for (const std::string& note : volume.notes) {
        say(fmt::format("{}: {}", options.volume, note));
    }
}

VolumeStatistics statisticsOf(const Volume& volume) {
    const Progress progress("looking at the values of " + volume.name);
    return computeStatistics(volume);
}

std::int64_t peakHostBytes() {
    std::ifstream status("/proc/self/status");
    std::string key;
    while (status >> key) {
        if (key == "VmHWM:") {
            std::int64_t kib = 0;
            status >> kib;
            return kib * 1024;
        }
        status.ignore(4096, '\n');
    }
    return 0;
}

} // namespace slabcast
