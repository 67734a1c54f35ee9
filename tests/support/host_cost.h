#pragma once

#include <cstdint>
#include <string>

namespace slabcast::test {

/// What frames cost the host.
struct HostCost {
    int calls = 0;          // of GL
    int queries = 0;        // of them: Get..., Is..., CheckFramebufferStatus
    int draws = 0;          // of them: Draw..., Dispatch..., Clear..., BlitFramebuffer
    int uploads = 0;        // of them: BufferData, BufferSubData, TexSubImage..., MapBufferRange
    int makes = 0;          // of them: Gen..., Create..., TexStorage..., LinkProgram
    int allocations = 0;    // by `new`, on any thread, but not within a call of GL
    std::int64_t bytes = 0; // that these asked for
    int threads = 0;        // started, but not within a call of GL
};

std::string describe(const HostCost& cost);

/// Counts from its making on. Every GL function that is loaded is called through a counter, and
/// `new` and the starting of threads are counted, while it lives; one at a time.
class HostCostCounter {
public:
    HostCostCounter();
    ~HostCostCounter();
    HostCostCounter(const HostCostCounter&) = delete;
    HostCostCounter& operator=(const HostCostCounter&) = delete;

    /// Since the last call of this, or since the beginning.
    HostCost take();
    /// The calls that were taken last: "BindTexture 6, ...", the most often called first.
    std::string listed() const;
};

/// Whether the counter sees threads start: not under a sanitizer that does so itself.
bool countsThreads();

} // namespace slabcast::test
