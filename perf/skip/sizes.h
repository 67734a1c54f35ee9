#pragma once

#include "perf/skip/subject.h"

namespace slabcast::skipbench {

/// How cost grows: the volume resampled to cubes of the desc's sizes, every structure with its
/// usual parameters: what it takes to build, to hold, and a frame of ray casting, marching only.
/// Rows of the table Sizes. Opens a stage of its own for each, as `opened` says.
Result<std::vector<Row>> measureSizes(const Desc& desc, const StageDesc& opened, const Host& host,
                                      const VolumeRecord& volume, ProgressLine& progress,
                                      RunStore& store);

} // namespace slabcast::skipbench
