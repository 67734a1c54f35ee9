#include "tests/support/host_cost.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdlib>
#include <new>
#include <vector>

#include <dlfcn.h>
#include <pthread.h>

#include "core/gl/api.h"

#if defined(__SANITIZE_THREAD__) || defined(__SANITIZE_ADDRESS__)
#define SLABCAST_OWN_HOOKS 0
#else
#define SLABCAST_OWN_HOOKS 1
#endif

namespace slabcast::test {

namespace {

#define SLABCAST_GL_INDEX(name, spelling) k##name,
enum Function : int { SLABCAST_GL_FUNCTIONS(SLABCAST_GL_INDEX) kFunctions };
#undef SLABCAST_GL_INDEX

#define SLABCAST_GL_NAME(name, spelling) #name,
constexpr std::array<std::string_view, kFunctions> kNames = {
    SLABCAST_GL_FUNCTIONS(SLABCAST_GL_NAME)};
#undef SLABCAST_GL_NAME

std::array<int, kFunctions> calls;
std::array<int, kFunctions> takenCalls;
std::atomic<bool> counting{false};
std::atomic<int> allocations{0};
std::atomic<int> threads{0};
std::atomic<std::int64_t> bytes{0};
thread_local int inDriver = 0; // what a driver allocates is its own

/// Stands for one function while a counter lives.
template <int Index, class Pointer>
struct Counted;
template <int Index, class R, class... Arguments>
struct Counted<Index, R(GL_APIENTRY*)(Arguments...)> {
    static inline R(GL_APIENTRY* real)(Arguments...) = nullptr;
    struct Within {
        Within() { ++inDriver; }
        ~Within() { --inDriver; }
    };
    static R GL_APIENTRY call(Arguments... arguments) {
        ++calls[Index];
        const Within within;
        return real(arguments...);
    }
};

bool startsWithAny(std::string_view name, std::initializer_list<std::string_view> beginnings) {
    return std::any_of(beginnings.begin(), beginnings.end(),
                       [&](std::string_view one) { return name.substr(0, one.size()) == one; });
}

[[maybe_unused]] void countAllocation(std::size_t size) {
    if (counting.load(std::memory_order_relaxed) && inDriver == 0) {
        ++allocations;
        bytes += static_cast<std::int64_t>(size);
    }
}

} // namespace

HostCostCounter::HostCostCounter() {
#define SLABCAST_GL_COUNT(name, spelling)                                                          \
    Counted<k##name, PFNGL##spelling##PROC>::real = gl::name;                                      \
    gl::name = &Counted<k##name, PFNGL##spelling##PROC>::call;
    SLABCAST_GL_FUNCTIONS(SLABCAST_GL_COUNT)
#undef SLABCAST_GL_COUNT
    take();
    counting = true;
}

HostCostCounter::~HostCostCounter() {
    counting = false;
#define SLABCAST_GL_RESTORE(name, spelling)                                                        \
    gl::name = Counted<k##name, PFNGL##spelling##PROC>::real;
    SLABCAST_GL_FUNCTIONS(SLABCAST_GL_RESTORE)
#undef SLABCAST_GL_RESTORE
}

HostCost HostCostCounter::take() {
    HostCost cost;
    for (int i = 0; i < kFunctions; ++i) {
        const int n = calls[i];
        const std::string_view name = kNames[i];
        cost.calls += n;
        cost.queries += startsWithAny(name, {"Get", "Is", "Check"}) ? n : 0;
        cost.draws += startsWithAny(name, {"DrawArrays", "Dispatch", "ClearBuffer", "Blit"}) ||
                              name == "Clear"
                          ? n
                          : 0;
        cost.uploads += startsWithAny(name, {"BufferData", "BufferSub", "TexSub", "Map"}) ? n : 0;
        cost.makes += startsWithAny(name, {"Gen", "Create", "TexStorage", "Link"}) ? n : 0;
    }
    takenCalls = calls;
    calls.fill(0);
    cost.allocations = allocations.exchange(0);
    cost.bytes = bytes.exchange(0);
    cost.threads = threads.exchange(0);
    return cost;
}

std::string HostCostCounter::listed() const {
    std::vector<int> order;
    for (int i = 0; i < kFunctions; ++i) {
        if (takenCalls[i] > 0) {
            order.push_back(i);
        }
    }
    std::stable_sort(order.begin(), order.end(),
                     [](int a, int b) { return takenCalls[a] > takenCalls[b]; });
    std::string text;
    for (const int i : order) {
        text += (text.empty() ? "" : ", ") + std::string(kNames[i]) + " " +
                std::to_string(takenCalls[i]);
    }
    return text;
}

std::string describe(const HostCost& c) {
    return std::to_string(c.calls) + " calls, of them " + std::to_string(c.queries) + " queries, " +
           std::to_string(c.draws) + " draws, " + std::to_string(c.uploads) + " uploads, " +
           std::to_string(c.makes) + " makes; " + std::to_string(c.allocations) +
           " allocations of " + std::to_string(c.bytes) + " bytes; " + std::to_string(c.threads) +
           " threads";
}

bool countsThreads() {
    return SLABCAST_OWN_HOOKS != 0;
}

} // namespace slabcast::test

#if SLABCAST_OWN_HOOKS

// In place of the library's, for the whole program; the other forms of `new` call these.

void* operator new(std::size_t size) {
    slabcast::test::countAllocation(size);
    if (void* memory = std::malloc(size == 0 ? 1 : size)) {
        return memory;
    }
    std::abort();
}
void operator delete(void* memory) noexcept {
    std::free(memory);
}
void operator delete(void* memory, std::size_t /*size*/) noexcept {
    std::free(memory);
}

extern "C" int pthread_create(pthread_t* thread, const pthread_attr_t* attributes,
                              void* (*run)(void*), void* argument) {
    using Create = int (*)(pthread_t*, const pthread_attr_t*, void* (*)(void*), void*);
    static const auto real = reinterpret_cast<Create>(dlsym(RTLD_NEXT, "pthread_create"));
    if (slabcast::test::counting.load(std::memory_order_relaxed) && slabcast::test::inDriver == 0) {
        ++slabcast::test::threads;
    }
    return real(thread, attributes, run, argument);
}

#endif
