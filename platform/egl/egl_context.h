#pragma once

#include <memory>
#include <string>

#include "core/base/error.h"
#include "core/gl/get_proc.h"

namespace slabcast {

struct EglOptions {
    int deviceIndex = -1; // of the EGL devices; -1: the first display that works
    bool debug = false;   // a debug context: the driver reports its errors (gl::DebugOutput)
    bool preferSurfaceless = true; // Mesa's surfaceless platform before the devices
};

/// A GLES 3.2 context without a window, from libEGL, which is loaded when it is asked for: nothing
/// links to it. Tested by: gl_objects_gl_test.cpp
class EglContext {
public:
    /// Makes the context and makes it current in this thread.
    /// Fails: DeviceUnsupported, naming the package or what each way to a display answered.
    static Result<EglContext> create(EglOptions options = {});

    EglContext(EglContext&&) noexcept;
    EglContext& operator=(EglContext&&) noexcept;
    ~EglContext();

    gl::GetProc getProc() const;
    std::string description() const; // "EGL 1.5, surfaceless (Mesa Project)"
    void makeCurrent() const;

private:
    struct State;
    explicit EglContext(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

} // namespace slabcast
