#pragma once

// The way in: all that an application includes.
//
// From a volume in memory to a picture, with a GLES 3.2 context current (examples/minimal.cpp):
//
//     Device device = *Device::open(getProc);                  // eglGetProcAddress or its like
//     Renderer renderer = *Renderer::create(device);
//     Scene scene = *Scene::create(std::move(volume), device);
//     scene.setLook({.tf = transferFunction});
//     FramePlan plan = *renderer.plan(scene, Settings{});
//     ViewTarget target{view, framebuffer, {0, 0, width, height}};
//     renderer.prepare(scene, plan, {&target, 1});             // when scene, plan or sizes change
//     renderer.draw(scene, plan, {&target, 1});                // every frame
//
// Every call returns a Result: a value, or an Error whose code says what to do about it and whose
// detail is one line for people. Nothing throws. A breached contract aborts; the host may hear of
// it first (DeviceOptions::contract).
//
// GL is called in the thread that calls the library. Heavy steps on the CPU share a thread per
// core, or the threads of the host's own job system (DeviceOptions::executor).

#include "core/base/error.h"
#include "core/base/executor.h"
#include "core/draw/ratio_tuner.h"
#include "core/draw/renderer_api.h"
#include "core/draw/warm_up.h"
#include "core/plan/frame_plan.h"
#include "core/plan/settings.h"
#include "core/scene/device.h"
#include "core/scene/live_scene.h"
#include "core/scene/memory_forecast.h"
#include "core/scene/scene_api.h"
#include "core/transfer/transfer_function.h"
#include "core/view/view.h"
#include "core/volume/volume.h"
