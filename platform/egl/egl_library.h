#pragma once

#ifndef EGL_EGL_PROTOTYPES
#define EGL_EGL_PROTOTYPES 0
#endif
#ifndef EGL_NO_X11
#define EGL_NO_X11 // headless: Xlib's macros stay out
#endif
#include <EGL/egl.h>
#include <EGL/eglext.h>

#include <string>

#include "core/base/error.h"

// clang-format off
#define SLABCAST_EGL_FUNCTIONS(X)                                                                 \
    X(GetProcAddress, GETPROCADDRESS) X(GetError, GETERROR) X(QueryString, QUERYSTRING)           \
    X(GetDisplay, GETDISPLAY) X(Initialize, INITIALIZE) X(BindAPI, BINDAPI)                       \
    X(ChooseConfig, CHOOSECONFIG) X(CreateContext, CREATECONTEXT)                                 \
    X(DestroyContext, DESTROYCONTEXT) X(CreatePbufferSurface, CREATEPBUFFERSURFACE)               \
    X(DestroySurface, DESTROYSURFACE) X(MakeCurrent, MAKECURRENT)                                 \
    X(GetCurrentContext, GETCURRENTCONTEXT)
#define SLABCAST_EGL_EXTENSION_FUNCTIONS(X)                                                       \
    X(GetPlatformDisplayEXT, GETPLATFORMDISPLAYEXT) X(QueryDevicesEXT, QUERYDEVICESEXT)
// clang-format on

namespace slabcast {

/// libEGL's entry points, as members named without `egl`. Those of extensions may be null.
struct EglLibrary {
#define SLABCAST_EGL_DECLARE(name, spelling) PFNEGL##spelling##PROC name = nullptr;
    SLABCAST_EGL_FUNCTIONS(SLABCAST_EGL_DECLARE)
    SLABCAST_EGL_EXTENSION_FUNCTIONS(SLABCAST_EGL_DECLARE)
#undef SLABCAST_EGL_DECLARE

    /// Space-separated extensions of a display, or of the library with EGL_NO_DISPLAY.
    bool hasExtension(EGLDisplay display, const char* name) const;
};

/// Loaded once per process and never unloaded: drivers keep threads and exit handlers.
/// Fails: DeviceUnsupported, naming the packages that have it.
Result<const EglLibrary*> eglLibrary();

/// "EGL_BAD_ALLOC", or the number in hex.
std::string eglErrorName(EGLint error);

} // namespace slabcast
