#pragma once

#ifndef GL_GLES_PROTOTYPES
#define GL_GLES_PROTOTYPES 0 // entry points are loaded: nothing links against libGLESv2
#endif
#include <GLES3/gl32.h>

#include <GLES2/gl2ext.h>

#include "core/base/error.h"
#include "core/gl/functions.h"
#include "core/gl/get_proc.h"

/// The GL entry points as function pointers, named as in GL without its prefix:
/// gl::DrawArraysInstanced(...). One set per process: contexts of different drivers cannot be
/// mixed.
namespace slabcast::gl {

#define SLABCAST_GL_DECLARE(name, spelling) inline PFNGL##spelling##PROC name = nullptr;
SLABCAST_GL_FUNCTIONS(SLABCAST_GL_DECLARE)
#undef SLABCAST_GL_DECLARE

/// Fills the pointers; call once with a context current, before anything else of slabcast::gl.
/// Fails: DeviceUnsupported, with the name of the first core function that is missing.
/// Tested by: gl_objects_gl_test.cpp
Result<void> loadApi(GetProc getProc);

} // namespace slabcast::gl
