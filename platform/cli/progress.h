#pragma once

#include <string>

namespace slabcast {

/// One line on stderr that is written over as a long step goes on and gone when it is done; silent
/// where stderr is no terminal.
class Progress {
public:
    Progress() = default;
    explicit Progress(const std::string& line) { show(line); }
    ~Progress();
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    void show(const std::string& line);

private:
    bool shown_ = false;
};

} // namespace slabcast
