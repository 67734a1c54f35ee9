#pragma once

#include <memory>
#include <type_traits>
#include <utility>

namespace slabcast {

/// A function of the caller's, borrowed for the length of a call: nothing is copied or allocated.
/// Tested by: executor_test.cpp
template <class Signature>
class FunctionRef;

template <class Result, class... Arguments>
class FunctionRef<Result(Arguments...)> {
public:
    template <class F>
    requires(!std::is_same_v<std::remove_cvref_t<F>, FunctionRef> &&
             std::is_invocable_r_v<Result, F&, Arguments...>)
        FunctionRef(F&& function) // implicit: lambdas are passed as they are
        : function_(const_cast<void*>(static_cast<const void*>(std::addressof(function)))),
          call_([](void* it, Arguments... arguments) -> Result {
              return (*static_cast<std::remove_reference_t<F>*>(it))(
                  std::forward<Arguments>(arguments)...);
          }) {}

    Result operator()(Arguments... arguments) const {
        return call_(function_, std::forward<Arguments>(arguments)...);
    }

private:
    void* function_;
    Result (*call_)(void*, Arguments...);
};

} // namespace slabcast
