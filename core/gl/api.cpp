#include "core/gl/api.h"

namespace slabcast::gl {

Result<void> loadApi(GetProc getProc) {
    SLABCAST_EXPECTS(getProc != nullptr, 0);
    const char* missing = nullptr;
#define SLABCAST_GL_LOAD(name, spelling)                                                           \
    name = reinterpret_cast<PFNGL##spelling##PROC>(getProc("gl" #name));                           \
    if (name == nullptr && missing == nullptr) {                                                   \
        missing = "gl" #name;                                                                      \
    }
    SLABCAST_GL_FUNCTIONS(SLABCAST_GL_LOAD)
#undef SLABCAST_GL_LOAD
    if (missing != nullptr) {
        return fail(ErrorCode::DeviceUnsupported,
                    std::string("GLES 3.2 is needed, but the driver has no ") + missing +
                        "; update the graphics driver");
    }
    return {};
}

} // namespace slabcast::gl
