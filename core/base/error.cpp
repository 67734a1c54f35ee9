#include "core/base/error.h"

#include <atomic>
#include <cstdio>
#include <cstdlib>

#include "core/base/contract_hook.h"

namespace slabcast {

namespace {

void printBreach(const char* function, const char* condition, double value) {
    std::fprintf(stderr, "slabcast: %s: expects %s, got %g\n", function, condition, value);
}

std::atomic<ContractHook> contractHook{printBreach};

} // namespace

void setContractHook(ContractHook hook) {
    contractHook = hook == nullptr ? printBreach : hook;
}

void contractBreach(const char* function, const char* condition, double value) {
    contractHook.load()(function, condition, value);
    std::abort();
}

} // namespace slabcast
