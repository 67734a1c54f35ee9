#include "platform/egl/egl_context.h"

#include <utility>
#include <vector>

#include "platform/egl/egl_library.h"

namespace slabcast {

namespace {

/// One way to a display. A null display: the library answered that it has none.
struct Candidate {
    std::string name;
    EGLDisplay display = EGL_NO_DISPLAY;
};

std::vector<Candidate> deviceCandidates(const EglLibrary& egl) {
    std::vector<Candidate> candidates;
    EGLint count = 0;
    if (egl.QueryDevicesEXT == nullptr || egl.GetPlatformDisplayEXT == nullptr ||
        egl.QueryDevicesEXT(0, nullptr, &count) != EGL_TRUE || count <= 0) {
        return candidates;
    }
    std::vector<EGLDeviceEXT> devices(static_cast<std::size_t>(count));
    egl.QueryDevicesEXT(count, devices.data(), &count);
    for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
        candidates.push_back(
            {"device " + std::to_string(i),
             egl.GetPlatformDisplayEXT(EGL_PLATFORM_DEVICE_EXT, devices[i], nullptr)});
    }
    return candidates;
}

Result<std::vector<Candidate>> candidatesFor(const EglLibrary& egl, const EglOptions& options) {
    std::vector<Candidate> devices = deviceCandidates(egl);
    if (options.deviceIndex >= 0) {
        if (static_cast<std::size_t>(options.deviceIndex) >= devices.size()) {
            return fail(ErrorCode::InvalidArgument,
                        "there is no EGL device " + std::to_string(options.deviceIndex) +
                            "; the system has " + std::to_string(devices.size()) +
                            ", numbered from 0");
        }
        return std::vector<Candidate>{devices[static_cast<std::size_t>(options.deviceIndex)]};
    }
    std::vector<Candidate> candidates = std::move(devices);
    if (egl.GetPlatformDisplayEXT != nullptr &&
        egl.hasExtension(EGL_NO_DISPLAY, "EGL_MESA_platform_surfaceless")) {
        const Candidate surfaceless{
            "surfaceless",
            egl.GetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, nullptr, nullptr)};
        candidates.insert(options.preferSurfaceless ? candidates.begin() : candidates.end(),
                          surfaceless);
    }
    candidates.push_back({"default display", egl.GetDisplay(EGL_DEFAULT_DISPLAY)});
    return candidates;
}

} // namespace

struct EglContext::State {
    const EglLibrary* egl = nullptr;
    EGLDisplay display = EGL_NO_DISPLAY;
    EGLContext context = EGL_NO_CONTEXT;
    EGLSurface surface = EGL_NO_SURFACE;
    std::string description;

    /// The display stays initialised: it belongs to the process, and eglTerminate would end other
    /// contexts on it.
    ~State() {
        if (context == EGL_NO_CONTEXT) {
            return;
        }
        if (egl->GetCurrentContext() == context) {
            egl->MakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
        }
        if (surface != EGL_NO_SURFACE) {
            egl->DestroySurface(display, surface);
        }
        egl->DestroyContext(display, context);
    }

    /// Empty where the context came about and is current, else the step that failed.
    std::string open(const Candidate& candidate, bool debug) {
        display = candidate.display;
        EGLint major = 0;
        EGLint minor = 0;
        if (display == EGL_NO_DISPLAY) {
            return "no display";
        }
        if (egl->Initialize(display, &major, &minor) != EGL_TRUE) {
            return failed("eglInitialize");
        }
        if (egl->BindAPI(EGL_OPENGL_ES_API) != EGL_TRUE) {
            return failed("eglBindAPI");
        }
        const EGLint wanted[] = {EGL_RENDERABLE_TYPE, EGL_OPENGL_ES3_BIT, EGL_SURFACE_TYPE,
                                 EGL_PBUFFER_BIT, EGL_NONE};
        EGLConfig config = nullptr;
        EGLint configs = 0;
        if (egl->ChooseConfig(display, wanted, &config, 1, &configs) != EGL_TRUE || configs == 0) {
            return failed("eglChooseConfig");
        }
        const bool debugAttribute = debug && (major > 1 || minor >= 5);
        const EGLint attributes[] = {EGL_CONTEXT_MAJOR_VERSION,
                                     3,
                                     EGL_CONTEXT_MINOR_VERSION,
                                     2,
                                     debugAttribute ? EGL_CONTEXT_OPENGL_DEBUG : EGL_NONE,
                                     EGL_TRUE,
                                     EGL_NONE};
        context = egl->CreateContext(display, config, EGL_NO_CONTEXT, attributes);
        if (context == EGL_NO_CONTEXT) {
            return failed("no GLES 3.2 context");
        }
        if (!egl->hasExtension(display, "EGL_KHR_surfaceless_context")) {
            const EGLint size[] = {EGL_WIDTH, 1, EGL_HEIGHT, 1, EGL_NONE};
            surface = egl->CreatePbufferSurface(display, config, size);
        }
        if (egl->MakeCurrent(display, surface, surface, context) != EGL_TRUE) {
            return failed("eglMakeCurrent");
        }
        const char* vendor = egl->QueryString(display, EGL_VENDOR);
        description = "EGL " + std::to_string(major) + "." + std::to_string(minor) + ", " +
                      candidate.name + " (" + (vendor == nullptr ? "unknown" : vendor) + ")";
        return {};
    }

    std::string failed(const char* step) const {
        return std::string(step) + ": " + eglErrorName(egl->GetError());
    }
};

Result<EglContext> EglContext::create(EglOptions options) {
    const auto egl = eglLibrary();
    if (!egl) {
        return tl::unexpected(egl.error());
    }
    const auto candidates = candidatesFor(**egl, options);
    if (!candidates) {
        return tl::unexpected(candidates.error());
    }
    std::string answers;
    for (const Candidate& candidate : *candidates) {
        auto state = std::make_unique<State>();
        state->egl = *egl;
        const std::string failure = state->open(candidate, options.debug);
        if (failure.empty()) {
            return EglContext(std::move(state));
        }
        answers += (answers.empty() ? "" : "; ") + candidate.name + ": " + failure;
    }
    return fail(ErrorCode::DeviceUnsupported,
                "no GLES 3.2 context (" + answers +
                    "); install libgl1-mesa-dri or a graphics driver with GLES 3.2");
}

EglContext::EglContext(std::unique_ptr<State> state) : state_(std::move(state)) {}
EglContext::EglContext(EglContext&&) noexcept = default;
EglContext& EglContext::operator=(EglContext&&) noexcept = default;
EglContext::~EglContext() = default;

gl::GetProc EglContext::getProc() const {
    return [](const char* name) {
        return reinterpret_cast<void*>((*eglLibrary())->GetProcAddress(name));
    };
}

std::string EglContext::description() const {
    return state_->description;
}

void EglContext::makeCurrent() const {
    state_->egl->MakeCurrent(state_->display, state_->surface, state_->surface, state_->context);
}

} // namespace slabcast
