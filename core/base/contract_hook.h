#pragma once

namespace slabcast {

/// Hears of a breached contract, in the thread that breached it, before the process aborts.
using ContractHook = void (*)(const char* function, const char* condition, double value);

/// One hook for the process, set from any thread. Null: a line on stderr, which is lost on Android.
/// Tested by: device_test.cpp
void setContractHook(ContractHook hook);

} // namespace slabcast
