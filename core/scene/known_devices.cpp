#include "core/scene/known_devices.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "core/gl/api.h"

namespace slabcast {

namespace {

// Arm's drivers fetch the target by an extension of their own, GL_ARM_shader_framebuffer_fetch, and
// filter no 32-bit floats. Lists of extensions that owners sent in: Mali-G51 in
// github.com/google-ai-edge/mediapipe/issues/2332 (2021), a later one in
// github.com/mozilla-mobile/fenix/issues/20041 (2021); of the fetch
// github.com/google/filament/issues/4313. GL_EXT_texture_norm16 is offered by some and its filter
// fails on real ones: it is not counted on.
constexpr const char* kMali[] = {"GL_OVR_multiview2"};

// Qualcomm's: the list in github.com/FNA-XNA/FNA3D/pull/257 (2025, Adreno 830), of which only what
// those of 2018 and later share is here. Coherent fetching and multiview are Qualcomm's own offer
// to headsets (Quest's documentation on multiview). norm16 as above.
constexpr const char* kAdreno[] = {"GL_OES_texture_float_linear", "GL_OVR_multiview2",
                                   "GL_EXT_shader_framebuffer_fetch"};

// Weights of eight bits, as Mesa's Vulkan driver says of Adreno (tu_device.c,
// subTexelPrecisionBits); of Mali nothing is published, and what Direct3D 11 asks for at least is
// taken (functional specification 7.18.8: 8 bits). Cut off, such a weight is wrong by up to 1/256.
constexpr double kEightBits = 1.0 / 256.0;

constexpr KnownDevice kDevices[] = {
    {"g71", "Mali-G71", "ARM", kMali, kEightBits},
    {"g52", "Mali-G52", "ARM", kMali, kEightBits},
    {"g57", "Mali-G57", "ARM", kMali, kEightBits},
    {"adreno630", "Adreno (TM) 630", "Qualcomm", kAdreno, kEightBits},
    {"adreno650", "Adreno (TM) 650", "Qualcomm", kAdreno, kEightBits},
    {"adreno660", "Adreno (TM) 660", "Qualcomm", kAdreno, kEightBits},
    {"adreno740", "Adreno (TM) 740", "Qualcomm", kAdreno, kEightBits},
};

} // namespace

std::span<const KnownDevice> knownDevices() {
    return kDevices;
}

const KnownDevice* findKnownDevice(std::string_view name) {
    const auto found = std::find_if(std::begin(kDevices), std::end(kDevices),
                                    [=](const KnownDevice& known) { return known.name == name; });
    return found == std::end(kDevices) ? nullptr : found;
}

std::string knownDeviceNames() {
    std::string names;
    for (const KnownDevice& known : kDevices) {
        names += (names.empty() ? "" : ", ") + std::string(known.name);
    }
    return names;
}

gl::Caps assumedCaps(const KnownDevice& known, const gl::Caps& running) {
    std::vector<std::string> shared;
    for (const char* extension : known.extensions) {
        if (std::binary_search(running.extensions.begin(), running.extensions.end(),
                               std::string(extension))) {
            shared.emplace_back(extension);
        }
    }
    const std::string version =
        "OpenGL ES 3.2, assumed; what runs is " + running.renderer + ", " + running.driver;
    gl::Caps caps = running; // with its limits
    const Result<gl::Caps> flags =
        gl::capsFrom({known.vendor, known.renderer, version, std::move(shared)}, {});
    SLABCAST_EXPECTS(flags.has_value(), 0);
    const auto take = [&](auto member) { caps.*member = (*flags).*member; };
    take(&gl::Caps::vendor);
    take(&gl::Caps::renderer);
    take(&gl::Caps::driver);
    take(&gl::Caps::extensions);
    // Not those that only measure, as floatBlend, by which work is counted: what runs is measured.
    for (bool gl::Caps::*flag :
         {&gl::Caps::norm16, &gl::Caps::floatLinear, &gl::Caps::framebufferFetch,
          &gl::Caps::multiview, &gl::Caps::imageFormats, &gl::Caps::isSoftware}) {
        take(flag);
    }
    caps.assumed = known.name;
    return caps;
}

std::vector<TexelFormatTest> assumedFormats(const KnownDevice& known) {
    constexpr double kAxes = 3.0;
    // The result's own step, of full scale: of 8 bits, and of fp16 at its coarsest (2048 of 4096).
    const double byteStep = 0.5 / 255.0;
    const double halfStep = 0.5 / 4096.0;
    const double weights = kAxes * known.filterErrorPerAxis;
    const std::string why = "assumed: weights of eight bits along each axis, cut off";
    return {
        {TexelFormat::R8, true, weights + byteStep, 0.0, why},
        {TexelFormat::R16, false, 0.0, 0.0, "assumed: its filter fails on such devices"},
        {TexelFormat::R16F, true, weights + halfStep, 0.0, why},
        {TexelFormat::Rg8Exact, true, 0.0, 0.0, "assumed: texels are fetched as stored"},
        {TexelFormat::R32fExact, true, 0.0, 0.0, "assumed: texels are fetched as stored"},
    };
}

TableFilterTest assumedTableFilter(const KnownDevice& known) {
    // Weighted means of zeros are zero, however coarse the weights.
    return {true, known.filterErrorPerAxis, "assumed: weights of eight bits, cut off"};
}

Result<Device> openAs(const KnownDevice& known, gl::GetProc getProc, DeviceOptions options) {
    if (Result<void> loaded = gl::loadApi(getProc); !loaded) {
        return tl::unexpected(loaded.error());
    }
    const Result<gl::Caps> running = gl::queryCaps(options.maskedExtensions);
    if (!running) {
        return tl::unexpected(running.error());
    }
    if (!options.quirks) {
        options.quirks = knownQuirks(*running);
    }
    return Device(assumedCaps(known, *running), assumedFormats(known), std::move(options),
                  assumedTableFilter(known));
}

} // namespace slabcast
