#include "core/gl/debug.h"

#include <array>
#include <cstdio>
#include <utility>

namespace slabcast::gl {

struct DebugOutput::State {
    Sink sink;
    int errors = 0;
    std::string firstError;
    // What was there before, put back at the end.
    void* callbackBefore = nullptr;
    void* userBefore = nullptr;
    bool outputBefore = false;
    bool synchronousBefore = false;

    static void GL_APIENTRY receive(GLenum source, GLenum type, GLuint, GLenum severity,
                                    GLsizei length, const GLchar* text, const void* user) {
        auto& state =
            *static_cast<State*>(const_cast<void*>(user)); // GL's signature adds the const
        const DebugMessage message{source, type, severity,
                                   std::string(text, static_cast<std::size_t>(length))};
        if (message.isError() && state.errors++ == 0) {
            state.firstError = message.text;
        }
        if (state.sink) {
            state.sink(message);
        }
    }
};

DebugOutput::DebugOutput(Sink sink) : state_(std::make_unique<State>()) {
    state_->sink = std::move(sink);
    GetPointerv(GL_DEBUG_CALLBACK_FUNCTION, &state_->callbackBefore);
    GetPointerv(GL_DEBUG_CALLBACK_USER_PARAM, &state_->userBefore);
    state_->outputBefore = IsEnabled(GL_DEBUG_OUTPUT) == GL_TRUE;
    state_->synchronousBefore = IsEnabled(GL_DEBUG_OUTPUT_SYNCHRONOUS) == GL_TRUE;
    Enable(GL_DEBUG_OUTPUT);
    Enable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
    DebugMessageCallback(&State::receive, state_.get());
}

DebugOutput::~DebugOutput() {
    if (state_ == nullptr) { // moved from
        return;
    }
    DebugMessageCallback(reinterpret_cast<GLDEBUGPROC>(state_->callbackBefore), state_->userBefore);
    (state_->outputBefore ? Enable : Disable)(GL_DEBUG_OUTPUT);
    (state_->synchronousBefore ? Enable : Disable)(GL_DEBUG_OUTPUT_SYNCHRONOUS);
}

int DebugOutput::errorCount() const {
    return state_->errors;
}

std::string DebugOutput::firstError() const {
    return state_->firstError;
}

void DebugOutput::clear() {
    state_->errors = 0;
    state_->firstError.clear();
}

GLenum takeError() {
    const GLenum first = GetError();
    // A lost context repeats its error for ever, so the drain is bounded; GL has fewer flags than
    // this.
    for (int i = 0; i < 16 && GetError() != GL_NO_ERROR; ++i) {
    }
    return first;
}

std::string errorName(GLenum error) {
    static constexpr std::array<std::pair<GLenum, const char*>, 8> kNames = {{
        {GL_NO_ERROR, "GL_NO_ERROR"},
        {GL_INVALID_ENUM, "GL_INVALID_ENUM"},
        {GL_INVALID_VALUE, "GL_INVALID_VALUE"},
        {GL_INVALID_OPERATION, "GL_INVALID_OPERATION"},
        {GL_INVALID_FRAMEBUFFER_OPERATION, "GL_INVALID_FRAMEBUFFER_OPERATION"},
        {GL_OUT_OF_MEMORY, "GL_OUT_OF_MEMORY"},
        {GL_STACK_OVERFLOW, "GL_STACK_OVERFLOW"},
        {GL_CONTEXT_LOST, "GL_CONTEXT_LOST"},
    }};
    for (const auto& [value, text] : kNames) {
        if (value == error) {
            return text;
        }
    }
    std::array<char, 16> hex{};
    std::snprintf(hex.data(), hex.size(), "0x%04X", static_cast<unsigned>(error));
    return hex.data();
}

} // namespace slabcast::gl
