#pragma once

#include <string>

namespace slabcast {

/// One line on stderr that is written over as a long step goes on; silent where stderr is no terminal.
class Progress {
public:
    explicit Progress(std::string step);
    ~Progress();
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    void at(int done, int total, const std::string& what = {});

private:
    std::string step_;
    bool shown_ = false;
};

} // namespace slabcast
