#include "platform/io/apart/confine.h"

#include <cerrno>
#include <csignal>

#include <fcntl.h>
#include <sched.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

#ifdef SLABCAST_HAS_SECCOMP
#include <seccomp.h>
#endif

namespace slabcast::apart {

namespace {

void limit(int resource, std::int64_t most) {
    const rlimit both{static_cast<rlim_t>(most), static_cast<rlim_t>(most)};
    setrlimit(static_cast<__rlimit_resource>(resource), &both);
}

#ifdef SLABCAST_HAS_SECCOMP
/// By what they do. A name that this machine does not have is passed over.
constexpr const char* kRefused[] = {
    // network
    "socket", "socketpair", "connect", "bind", "listen", "accept", "accept4",
    // other programs, other processes
    "execve", "execveat", "fork", "vfork", "ptrace", "process_vm_readv", "process_vm_writev",
    "kill", "tkill", "pidfd_open", "pidfd_send_signal", "pidfd_getfd",
    // changing files and folders
    "creat", "truncate", "unlink", "unlinkat", "rename", "renameat", "renameat2", "mkdir",
    "mkdirat", "rmdir", "link", "linkat", "symlink", "symlinkat", "mknod", "mknodat", "chmod",
    "fchmodat", "chown", "lchown", "fchownat", "utimensat", "setxattr", "lsetxattr", "mount",
    "umount2", "chroot", "pivot_root",
    // ways around these
    "io_uring_setup", "bpf", "userfaultfd", "perf_event_open", "add_key", "keyctl", "request_key",
    "setns", "unshare"};

void refuseCalls() {
    const scmp_filter_ctx filter = seccomp_init(SCMP_ACT_ALLOW);
    if (filter == nullptr) {
        return;
    }
    const auto refuse = [&](const char* name) {
        seccomp_rule_add(filter, SCMP_ACT_ERRNO(EACCES), seccomp_syscall_resolve_name(name), 0);
    };
    for (const char* name : kRefused) {
        refuse(name);
    }
    // Opening to write, create or cut.
    for (const int flag : {O_WRONLY, O_RDWR, O_CREAT, O_TRUNC}) {
        const auto bit = static_cast<scmp_datum_t>(flag);
        seccomp_rule_add(filter, SCMP_ACT_ERRNO(EACCES), SCMP_SYS(open), 1,
                         SCMP_A1(SCMP_CMP_MASKED_EQ, bit, bit));
        seccomp_rule_add(filter, SCMP_ACT_ERRNO(EACCES), SCMP_SYS(openat), 1,
                         SCMP_A2(SCMP_CMP_MASKED_EQ, bit, bit));
    }
    // Its flags lie in memory, where a filter cannot look; callers fall back to openat.
    seccomp_rule_add(filter, SCMP_ACT_ERRNO(ENOSYS), SCMP_SYS(openat2), 0);
    // Threads may be started, processes not.
    seccomp_rule_add(filter, SCMP_ACT_ERRNO(EACCES), SCMP_SYS(clone), 1,
                     SCMP_A0(SCMP_CMP_MASKED_EQ, CLONE_VM, 0));
    seccomp_rule_add(filter, SCMP_ACT_ERRNO(ENOSYS), SCMP_SYS(clone3), 0);
    seccomp_load(filter);
    seccomp_release(filter);
}
#else
void refuseCalls() {}
#endif

/// What the libraries themselves take of the address space, threads' stacks included.
constexpr std::int64_t kLibraryBytes = std::int64_t{4} << 30;

} // namespace

void confine(const LoadLimits& limits) {
    const std::int64_t machine =
        static_cast<std::int64_t>(sysconf(_SC_PHYS_PAGES)) * sysconf(_SC_PAGESIZE);
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0);
    limit(RLIMIT_CORE, 0);
    const std::int64_t memory = limits.memoryBytes > 0 ? limits.memoryBytes : machine;
    limit(RLIMIT_AS, memory + kLibraryBytes);
    limit(RLIMIT_FSIZE, memory); // of the file in memory, too, that voxels are handed over in
    refuseCalls();
}

} // namespace slabcast::apart
