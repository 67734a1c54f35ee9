#pragma once

#include <functional>
#include <string>

namespace slabcast {

/// What long work tells those who wait for it. Either may be empty.
struct Watcher {
    std::function<void(const std::string& line)> show; // the step under way; "" once it is done
    std::function<void(const std::string& line)> say;  // something that is not as it was asked for
};

/// Shows lines while a step goes on, and that it is done at its end. Tested by: frame_times_test.cpp
class ProgressLine {
public:
    /// Borrows the watcher.
    explicit ProgressLine(const Watcher& watcher) : watcher_(watcher) {}
    ProgressLine(const Watcher& watcher, const std::string& line) : watcher_(watcher) {
        show(line);
    }
    ~ProgressLine() {
        if (shown_) {
            watcher_.show("");
        }
    }
    ProgressLine(const ProgressLine&) = delete;
    ProgressLine& operator=(const ProgressLine&) = delete;

    void show(const std::string& line) {
        if (watcher_.show) {
            shown_ = true;
            watcher_.show(line);
        }
    }

private:
    const Watcher& watcher_;
    bool shown_ = false;
};

} // namespace slabcast
