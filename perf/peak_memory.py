#!/usr/bin/env python3
"""Runs a command and prints how much memory it and the programs that it starts held at most, together.

usage: peak_memory.py COMMAND [ARGUMENT...]

What each process holds alone (RssAnon) is added up; shared memory counts once, as what the whole system has more of
than before (Shmem), so that nothing else should come and go there meanwhile. Files that are read do not count.
Samples every 2 ms.
"""

import subprocess
import sys
import time
from pathlib import Path


def field(path, name):
    """In bytes; 0 of a process that has gone."""
    try:
        for line in Path(path).read_text().splitlines():
            if line.startswith(name + ":"):
                return int(line.split()[1]) * 1024
    except OSError:
        pass
    return 0


def family(pid):
    found = [pid]
    for process in found:
        try:
            for task in Path(f"/proc/{process}/task").iterdir():
                found += [int(child) for child in (task / "children").read_text().split()]
        except OSError:
            pass
    return found


def main(command):
    if not command:
        print(__doc__.strip(), file=sys.stderr)
        return 2
    shared = field("/proc/meminfo", "Shmem")
    start = time.monotonic()
    process = subprocess.Popen(command)
    most = (0, 0, 0)
    while process.poll() is None:
        alone = sum(field(f"/proc/{pid}/status", "RssAnon") for pid in family(process.pid))
        together = max(0, field("/proc/meminfo", "Shmem") - shared)
        most = max(most, (alone + together, alone, together))
        time.sleep(0.002)
    mib = [bytes / 1048576 for bytes in most]
    print(f"peak {mib[0]:.0f} MiB: {mib[1]:.0f} of single processes, {mib[2]:.0f} shared; "
          f"{time.monotonic() - start:.1f} s", file=sys.stderr)
    return process.returncode


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
