#pragma once

#include <functional>
#include <memory>
#include <string>

#include "core/gl/api.h"

namespace slabcast::gl {

struct DebugMessage {
    GLenum source = 0;
    GLenum type = 0;
    GLenum severity = 0;
    std::string text;
    bool isError() const { return type == GL_DEBUG_TYPE_ERROR; }
};

/// Hears the driver's debug output while it lives, in the call that causes it; counts errors and
/// keeps the first. A context without the debug flag may stay silent: takeError() sees errors there
/// too. Tested by: gl_objects_gl_test.cpp
class DebugOutput {
public:
    using Sink = std::function<void(const DebugMessage&)>;

    explicit DebugOutput(Sink sink = {});
    ~DebugOutput();
    DebugOutput(DebugOutput&&) noexcept = default;
    DebugOutput& operator=(DebugOutput&&) noexcept = delete;

    int errorCount() const;
    std::string firstError() const; // empty where there was none
    void clear();

private:
    struct State;
    std::unique_ptr<State> state_; // the driver keeps its address
};

/// Drains glGetError: the first flag that was up, GL_NO_ERROR where none was.
GLenum takeError();

/// "GL_INVALID_ENUM", or the number in hex.
std::string errorName(GLenum error);

} // namespace slabcast::gl
