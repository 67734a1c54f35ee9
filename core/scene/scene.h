#pragma once

// A scene with the parts that the renderer and measurements read; applications need scene_api.h
// alone.
#include "core/scene/scene_api.h"
#include "core/skip/built_skip.h"
#include "core/skip/live_skip.h"
#include "core/transfer/preclassified.h"
#include "core/transfer/preintegrated.h"
#include "core/volume/normals.h"
