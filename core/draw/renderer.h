#pragma once

// The renderer with the parts that measurements read; applications need renderer_api.h alone.
#include "core/draw/renderer_api.h"
#include "core/gl/program.h"
#include "core/scene/scene.h"
