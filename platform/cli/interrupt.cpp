#include "platform/cli/interrupt.h"

#include <atomic>
#include <cerrno>
#include <csignal>
#include <ctime>
#include <string_view>

#include <pthread.h>
#include <sys/wait.h>
#include <unistd.h>

#include "platform/io/unfinished.h"

namespace slabcast {

namespace {

// Read by the handler, which may call next to nothing: signal-safety(7).
pthread_t mainThread;
bool hasTerminal = false;
std::atomic<pid_t> awaited{0};

/// It tidies up when told to, for which it gets a quarter of a second.
void endAwaited() {
    const pid_t leader = awaited.load();
    if (leader <= 0) {
        return;
    }
    kill(-leader, SIGTERM);
    for (int tick = 0; tick < 25 && waitpid(leader, nullptr, WNOHANG) == 0; ++tick) {
        const timespec pause{0, 10'000'000};
        nanosleep(&pause, nullptr);
    }
    kill(-leader, SIGKILL);
}

void writeLine(std::string_view text) {
    while (!text.empty()) {
        const ssize_t written = write(STDERR_FILENO, text.data(), text.size());
        if (written <= 0) {
            return;
        }
        text.remove_prefix(static_cast<std::size_t>(written));
    }
}

extern "C" void onSignal(int signal) {
    const int before = errno;
    if (pthread_equal(pthread_self(), mainThread) == 0) {
        pthread_kill(mainThread, signal); // it must stand still while its files are removed
        errno = before;
        return;
    }
    endAwaited();
    Unfinished::removeAll();
    writeLine(hasTerminal ? "\r\033[Kslabcast: interrupted\n" : "slabcast: interrupted\n");
    _exit(128 + signal);
}

} // namespace

void endWhenInterrupted() {
    mainThread = pthread_self();
    hasTerminal = isatty(STDERR_FILENO) != 0;
    struct sigaction action {};
    action.sa_handler = onSignal;
    sigfillset(&action.sa_mask);
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
        struct sigaction before {};
        if (sigaction(signal, nullptr, &before) == 0 && before.sa_handler != SIG_IGN) {
            sigaction(signal, &action, nullptr);
        }
    }
}

SignalsHeld::SignalsHeld() {
    sigset_t all{};
    sigfillset(&all);
    pthread_sigmask(SIG_BLOCK, &all, &before_);
}

SignalsHeld::~SignalsHeld() {
    pthread_sigmask(SIG_SETMASK, &before_, nullptr);
}

Awaited::Awaited(pid_t leader) {
    awaited = leader;
}

Awaited::~Awaited() {
    awaited = 0;
}

} // namespace slabcast
