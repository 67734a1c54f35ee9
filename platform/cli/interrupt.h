#pragma once

#include <csignal>

#include <sys/types.h>

namespace slabcast {

/// From now on Ctrl-C (SIGINT), SIGTERM and SIGHUP end the program at once, whatever it is doing,
/// within a driver too: what is Unfinished goes, so does a program that is waited for, stderr gets
/// one line, and the exit status is 128 + the signal: 130 of Ctrl-C. A signal that was ignored, as
/// under nohup, stays so. Contract: called by the main thread, which alone writes files.
/// Tested by: interrupt_test.py
void endWhenInterrupted();

/// Holds signals back while it lives, so that nothing comes between a program's start and Awaited.
class SignalsHeld {
public:
    SignalsHeld();
    ~SignalsHeld();
    SignalsHeld(const SignalsHeld&) = delete;
    SignalsHeld& operator=(const SignalsHeld&) = delete;

    /// Those that were held back already: a started program's.
    const sigset_t& before() const { return before_; }

private:
    sigset_t before_{};
};

/// A program that ends, with its group, when this one is interrupted.
class Awaited {
public:
    explicit Awaited(pid_t leader);
    ~Awaited();
    Awaited(const Awaited&) = delete;
    Awaited& operator=(const Awaited&) = delete;
};

} // namespace slabcast
