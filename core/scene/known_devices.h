#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/scene/device.h"

namespace slabcast {

/// A device that is not at hand, as far as others have published what it can do: for measuring by
/// its compiler, under which nothing is drawn, so that no self-test passes.
struct KnownDevice {
    const char* name;     // as --device takes it
    const char* renderer; // as its GL_RENDERER begins
    const char* vendor;
    std::span<const char* const> extensions; // of those that Caps has a flag for
    double filterErrorPerAxis;               // at most, as a share of the texels' difference
};

std::span<const KnownDevice> knownDevices();

/// Null where no device has this name.
const KnownDevice* findKnownDevice(std::string_view name);

/// "g71, g52, ...".
std::string knownDeviceNames();

/// What a context of GL can take of a known device: its extensions where the context has them too.
/// Limits, which GL's calls must keep to, and what only measures stay the context's own. Pure.
/// Tested by: known_devices_test.cpp
gl::Caps assumedCaps(const KnownDevice& known, const gl::Caps& running);

/// What the self-tests would find there: each format as wrong as the device's filter may be.
std::vector<TexelFormatTest> assumedFormats(const KnownDevice& known);
TableFilterTest assumedTableFilter(const KnownDevice& known);

/// As Device::open(), but nothing is drawn: capabilities and results of self-tests are the known
/// device's. What a driver is slow at or wrong in stays that of the one that runs. Tested by:
/// known_devices_test.cpp
Result<Device> openAs(const KnownDevice& known, gl::GetProc getProc, DeviceOptions options = {});

} // namespace slabcast
