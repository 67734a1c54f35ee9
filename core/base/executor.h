#pragma once

#include "core/base/function_ref.h"

namespace slabcast {

/// Who lends threads to heavy CPU steps (building skip structures, encoding volumes). A host with a
/// job system of its own derives from this; else the library keeps a thread per core, made at the
/// first use.
class Executor {
public:
    virtual ~Executor() = default;

    /// Threads that run() may use at once, the calling one counted: 1 or more.
    virtual int concurrency() const = 0;

    /// Calls task(0) to task(count - 1), each once, and returns when all have returned. The calling
    /// thread may take part; tasks may run in any order, or one after the other, and may call run()
    /// themselves. Threads: any, several at once. Tasks throw nothing.
    virtual void run(int count, FunctionRef<void(int)> task) = 0;
};

/// What heavy steps run on in this process. Tested by: executor_test.cpp
Executor& executor();

/// Takes the host's executor from here on, or the library's own again (null). The host's must
/// outlive all work. Contract: no work is going on. DeviceOptions::executor does so for a host.
void setExecutor(Executor* host);

} // namespace slabcast
