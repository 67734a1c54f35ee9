#pragma once

namespace slabcast::gl {

/// What the platform resolves names of GL's functions with (eglGetProcAddress and its like).
using GetProc = void* (*)(const char*);

} // namespace slabcast::gl
