#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "core/base/error.h"
#include "core/base/parallel.h"

namespace slabcast {

/// A part of a builder's work: items of about the cost of one slice each.
struct BuildStage {
    std::int64_t items = 0;
    std::function<void(std::int64_t begin, std::int64_t end)> run; // items [begin, end)
    bool inOrder = false; // an item needs those before it; else any order, on any threads
};

/// A builder's work, one stage after the other, begun and done where its caller likes: all at once
/// on all cores, or a few items in every frame. Stages keep what they need for themselves; what
/// they read, and the result, which is undefined until the last one, are the caller's and must
/// outlive them.
using BuildStages = std::vector<BuildStage>;

/// All of it now, on all cores. Fails: Internal where cancelled. Tested by: chebyshev_test.cpp
Result<void> runStages(const BuildStages& stages, const CancelToken* cancel = nullptr);

} // namespace slabcast
