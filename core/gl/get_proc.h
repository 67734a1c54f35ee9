#pragma once

namespace slabcast::gl {

/// Finds GL's functions by name: eglGetProcAddress or its like. Tested by: scene_gl_test.cpp
using GetProc = void* (*)(const char*);

} // namespace slabcast::gl
