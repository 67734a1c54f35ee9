#pragma once

#include "platform/io/base/load_options.h"

namespace slabcast::apart {

/// loadVolume() by a program of ours, `slabcast-read`, that does nothing else: what a damaged or
/// hostile file does to its reader ends that program, and here it is an error that names the file.
/// The program may not write, connect or start anything (confine.h). Voxels come as a mapping of
/// memory that it filled, without a copy: a process that forks shares them. Looks for the program in
/// SLABCAST_READER, and where the dynamic linker looks for modules (open_module.h).
/// Threads: any, several at once. Cost over reading here: see perf/README.md.
/// Fails: as loadVolume(). Tested by: io_apart_test.cpp
Result<Volume> readApart(const std::filesystem::path& path, const LoadOptions& options);

} // namespace slabcast::apart
