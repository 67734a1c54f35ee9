#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/base/error.h"

namespace slabcast::gl {

/// What the device can do, as plain facts. Code asks these, never extension strings.
struct Caps {
    int major = 0;
    int minor = 0;
    std::string vendor;
    std::string renderer;
    std::string driver; // the whole GL_VERSION line, driver version included
    /// The known device (core/scene/known_devices.h) whose abilities these are, though another
    /// draws; empty where they were asked and tested.
    std::string assumed;

    std::int64_t maxTextureSize = 0;
    std::int64_t maxTexture3DSize = 0;
    std::int64_t maxUniformBlockSize = 0;
    std::int64_t maxComputeInvocations = 0; // of a workgroup
    std::int64_t maxComputeSharedBytes = 0;
    std::int64_t maxComputeImages = 0;
    std::int64_t maxComputeStorageBlocks = 0;
    std::int64_t maxStorageBlockBytes = 0;

    bool norm16 = false;           // GL_EXT_texture_norm16: R16 exists (says nothing of filtering)
    bool floatLinear = false;      // GL_OES_texture_float_linear: R32F is filtered
    bool floatBlend = false;       // GL_EXT_float_blend: 32-bit float targets blend
    bool timerQuery = false;       // GL_EXT_disjoint_timer_query
    bool framebufferFetch = false; // GL_EXT_shader_framebuffer_fetch, the coherent one
    bool multiview = false;        // GL_OVR_multiview2
    bool imageFormats = false;     // GL_NV_image_formats: image formats beyond the core list
    bool isSoftware = false;       // llvmpipe, softpipe, SwiftShader: timings mean little

    std::vector<std::string> extensions; // sorted, without the masked ones
};

/// What a driver says of itself, as text: everything of Caps but the limits.
struct DeviceStrings {
    std::string vendor;
    std::string renderer;
    std::string version; // GL_VERSION
    std::vector<std::string> extensions;
};

/// Masked extensions behave as absent. Pure.
/// Fails: DeviceUnsupported below GLES 3.2. Tested by: gl_objects_gl_test.cpp
Result<Caps> capsFrom(DeviceStrings strings, const std::vector<std::string>& maskedExtensions);

/// The same of the current context, limits included. Fails: also InvalidArgument before
/// gl::loadApi().
Result<Caps> queryCaps(const std::vector<std::string>& maskedExtensions = {});

/// Extensions that desktop drivers offer and a headset may lack: what must not be needed.
std::vector<std::string> mobileStrictMask();

/// "mobile-strict", or extension names separated by commas; empty text masks nothing.
std::vector<std::string> parseExtensionMask(const std::string& text);

} // namespace slabcast::gl
