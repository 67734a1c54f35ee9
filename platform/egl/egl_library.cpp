#include "platform/egl/egl_library.h"

#include <array>
#include <cstdio>
#include <string_view>
#include <utility>

#include <dlfcn.h>

namespace slabcast {

namespace {

Result<EglLibrary> load() {
    void* handle = dlopen("libEGL.so.1", RTLD_NOW | RTLD_LOCAL);
    if (handle == nullptr) {
        return fail(ErrorCode::DeviceUnsupported,
                    "libEGL.so.1 cannot be loaded; install the packages libegl1 and "
                    "libgl1-mesa-dri, or the EGL of your graphics driver");
    }
    EglLibrary egl;
    const char* missing = nullptr;
#define SLABCAST_EGL_LOAD(name, spelling)                                                          \
    egl.name = reinterpret_cast<PFNEGL##spelling##PROC>(dlsym(handle, "egl" #name));               \
    if (egl.name == nullptr) {                                                                     \
        missing = "egl" #name;                                                                     \
    }
    SLABCAST_EGL_FUNCTIONS(SLABCAST_EGL_LOAD)
#undef SLABCAST_EGL_LOAD
    if (missing != nullptr) {
        return fail(ErrorCode::DeviceUnsupported,
                    std::string("libEGL.so.1 has no ") + missing +
                        "; install the package libegl1 (EGL 1.4 or later)");
    }
#define SLABCAST_EGL_LOAD(name, spelling)                                                          \
    egl.name = reinterpret_cast<PFNEGL##spelling##PROC>(egl.GetProcAddress("egl" #name));
    SLABCAST_EGL_EXTENSION_FUNCTIONS(SLABCAST_EGL_LOAD)
#undef SLABCAST_EGL_LOAD
    return egl;
}

} // namespace

bool EglLibrary::hasExtension(EGLDisplay display, const char* name) const {
    const char* extensions = QueryString(display, EGL_EXTENSIONS);
    if (extensions == nullptr) {
        return false;
    }
    const std::string padded = std::string(" ") + extensions + " ";
    return padded.find(std::string(" ") + name + " ") != std::string::npos;
}

Result<const EglLibrary*> eglLibrary() {
    static const Result<EglLibrary> library = load();
    if (!library) {
        return tl::unexpected(library.error());
    }
    return &*library;
}

std::string eglErrorName(EGLint error) {
    static constexpr std::array<std::pair<EGLint, const char*>, 9> kNames = {{
        {EGL_SUCCESS, "EGL_SUCCESS"},
        {EGL_NOT_INITIALIZED, "EGL_NOT_INITIALIZED"},
        {EGL_BAD_ACCESS, "EGL_BAD_ACCESS"},
        {EGL_BAD_ALLOC, "EGL_BAD_ALLOC"},
        {EGL_BAD_ATTRIBUTE, "EGL_BAD_ATTRIBUTE"},
        {EGL_BAD_CONFIG, "EGL_BAD_CONFIG"},
        {EGL_BAD_DISPLAY, "EGL_BAD_DISPLAY"},
        {EGL_BAD_MATCH, "EGL_BAD_MATCH"},
        {EGL_BAD_PARAMETER, "EGL_BAD_PARAMETER"},
    }};
    for (const auto& [value, text] : kNames) {
        if (value == error) {
            return text;
        }
    }
    std::array<char, 16> hex{};
    std::snprintf(hex.data(), hex.size(), "0x%04X", static_cast<unsigned>(error));
    return hex.data();
}

} // namespace slabcast
