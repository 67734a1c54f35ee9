// What a file of voxels takes on the way to what a renderer draws: run it under
// perf/peak_memory.py.
//
// usage: io_scene_cost FILE LAYOUT [this-process]
#include <cstring>

#include <fmt/core.h>

#include "core/base/stopwatch.h"
#include "core/scene/scene.h"
#include "platform/io/load_volume.h"

namespace {

using namespace slabcast;

double seconds(const Stopwatch& watch) {
    return watch.ms() / 1000.0;
}

Result<void> run(const char* path, const char* layout, bool here) {
    LoadOptions options;
    const Result<RawLayout> raw = parseRawLayout(layout);
    if (!raw) {
        return tl::unexpected(raw.error());
    }
    options.raw = *raw;
    options.process = here ? ReadIn::ThisProcess : ReadIn::OwnProcess;
    Stopwatch watch;
    Result<Volume> volume = loadVolume(path, options);
    if (!volume) {
        return tl::unexpected(volume.error());
    }
    const double read = seconds(watch);
    watch = {};
    const bool bytes = bytesPerVoxel(volume->type) == 1;
    const bool floats = isFloatingPoint(volume->type);
    TextureChoice choice;
    choice.texels = bytes ? TexelFormat::R8 : floats ? TexelFormat::R32fExact : TexelFormat::R16;
    choice.maxTableSize = 4096;
    Result<Scene> scene = Scene::create(std::move(*volume), choice);
    if (!scene) {
        return tl::unexpected(scene.error());
    }
    const double encoded = seconds(watch);
    watch = {};
    const VolumeStatistics& s = scene->statistics();
    const double middle = 0.5 * (s.min + s.max);
    Look look;
    look.tf.points = {{middle, glm::dvec3(1.0), 0.0}, {s.max, glm::dvec3(1.0), 0.5}};
    Needs needs;
    needs.skip.structure = SkipStructure::Proximity;
    const Result<void> done =
        scene->setLook(std::move(look)).and_then([&] { return scene->provide(needs); });
    fmt::print("read {:.2f} s, statistics and texels {:.2f} s, structure {:.2f} s\n", read, encoded,
               seconds(watch));
    return done;
}

} // namespace

int main(int argc, char** argv) {
    if (argc < 3) {
        fmt::print(stderr, "usage: io_scene_cost FILE LAYOUT [this-process]\n");
        return 2;
    }
    const Result<void> done = run(argv[1], argv[2], argc > 3);
    if (!done) {
        fmt::print(stderr, "{}\n", done.error().detail);
    }
    return done ? 0 : 1;
}
