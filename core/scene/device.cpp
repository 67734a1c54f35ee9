#include "core/scene/device.h"

#include <algorithm>
#include <cstdio>
#include <utility>

#include "core/gl/api.h"

namespace slabcast {

namespace {

/// More texels of a table than data of 12 bits have values bring nothing that can be seen.
constexpr std::int64_t kMaxTableSize = 4096;

struct KnownDriver {
    const char* renderer; // found within GL_RENDERER
    Quirks quirks;
};

/// Only what was seen. A row per driver; all rows that match hold.
constexpr KnownDriver kKnownDrivers[] = {
    {"llvmpipe", {.computeIsSlow = true}},
    {"softpipe", {.computeIsSlow = true}},
    {"SwiftShader", {.computeIsSlow = true}},
    {"swrast", {.computeIsSlow = true}},
};

void applyQuirks(const Quirks& quirks, gl::Caps& caps, std::vector<TexelFormatTest>& formats) {
    caps.norm16 &= !quirks.noNorm16;
    caps.framebufferFetch &= !quirks.noFramebufferFetch;
    for (TexelFormatTest& test : formats) {
        if (quirks.noNorm16 && test.format == TexelFormat::R16) {
            test.usable = false;
            test.reason = "left alone on this driver, a known fault";
        }
    }
}

} // namespace

Quirks knownQuirks(const gl::Caps& caps) {
    Quirks quirks;
    for (const KnownDriver& known : kKnownDrivers) {
        if (caps.renderer.find(known.renderer) != std::string::npos) {
            quirks.computeIsSlow |= known.quirks.computeIsSlow;
            quirks.noNorm16 |= known.quirks.noNorm16;
            quirks.noFramebufferFetch |= known.quirks.noFramebufferFetch;
        }
    }
    return quirks;
}

Result<Device> Device::open(gl::GetProc getProc, DeviceOptions options) {
    if (getProc == nullptr) {
        return fail(ErrorCode::InvalidArgument,
                    "no GL loader was given: pass eglGetProcAddress or its like");
    }
    if (Result<void> loaded = gl::loadApi(getProc); !loaded) {
        return tl::unexpected(loaded.error());
    }
    Result<gl::Caps> caps = gl::queryCaps(options.maskedExtensions);
    if (!caps) {
        return tl::unexpected(caps.error());
    }
    std::vector<TexelFormatTest> formats = selfTestTexelFormats(*caps);
    TableFilterTest tableFilter = selfTestTableFilter();
    return Device(std::move(*caps), std::move(formats), std::move(options), std::move(tableFilter));
}

Device::Device(gl::Caps caps, std::vector<TexelFormatTest> formats, DeviceOptions options,
               TableFilterTest tableFilter) {
    const Quirks quirks = options.quirks.value_or(knownQuirks(caps));
    applyQuirks(quirks, caps, formats);
    if (options.contract != nullptr) {
        setContractHook(options.contract);
    }
    if (options.executor != nullptr) {
        setExecutor(options.executor);
    }
    state_ = std::make_shared<const State>(State{std::move(caps), std::move(formats),
                                                 std::move(tableFilter), quirks,
                                                 std::move(options.log)});
}

TextureChoice Device::texturesFor(VoxelType type, const VolumeStatistics& statistics, bool exact,
                                  double longestStep) const {
    TextureChoice choice;
    choice.texels =
        chooseTexelFormat(type, statistics, exact, longestStep, formats(), &choice.reason);
    choice.filterErrorOfFullScale = filterErrorOfFullScale(choice.texels);
    choice.filtersTable = tableFilter().usable && !exact;
    choice.maxTableSize = static_cast<int>(std::min(kMaxTableSize, caps().maxTextureSize));
    return choice;
}

double Device::filterErrorOfFullScale(TexelFormat format) const {
    const auto test = std::find_if(formats().begin(), formats().end(),
                                   [=](const TexelFormatTest& t) { return t.format == format; });
    return test == formats().end() ? 0.0 : test->maxFilterError;
}

void Device::log(const std::string& line) const {
    if (state_->log) {
        state_->log(line);
    } else {
        std::fprintf(stderr, "slabcast: %s\n", line.c_str());
    }
}

} // namespace slabcast
