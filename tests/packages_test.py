#!/usr/bin/env python3
"""platform/packages.sh beside another package manager: it waits for its locks. usage: packages_test.py

apt-get is the machine's own, in a folder of its own: its configuration names other lists, another state of dpkg.
"""

import fcntl
import os
import re
import subprocess
import tempfile
import threading
import time
import unittest
from pathlib import Path

SCRIPT = Path(__file__).resolve().parent.parent / "platform" / "packages.sh"
HELD = 3.0  # seconds


@unittest.skipIf(os.geteuid() != 0, "another state of dpkg needs root")
@unittest.skipUnless(Path("/usr/bin/apt-get").exists(), "neither Debian nor Ubuntu")
class LockTest(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = Path(temporary.name)
        for name in ("lists/partial", "dpkg", "archives/partial", "bin"):
            (self.folder / name).mkdir(parents=True)
        # To packages.sh nothing is installed, to apt-get everything is: it takes its locks and has nothing to do.
        query = self.folder / "bin" / "dpkg-query"
        query.write_text("#!/bin/sh\nexit 1\n")
        query.chmod(0o755)
        architecture = subprocess.run(["dpkg", "--print-architecture"], capture_output=True, text=True, check=True)
        names = re.findall(r"^docs +(\S+)", SCRIPT.read_text(), re.MULTILINE)
        self.assertTrue(names)
        (self.folder / "dpkg" / "status").write_text("".join(
            f"Package: {name}\nStatus: install ok installed\nArchitecture: {architecture.stdout.strip()}\n"
            f"Version: 1\nMaintainer: none\nDescription: none\n\n" for name in names))
        (self.folder / "apt.conf").write_text(
            f'Dir::State::Lists "{self.folder}/lists";\nDir::State::status "{self.folder}/dpkg/status";\n'
            f'Dir::Cache::archives "{self.folder}/archives";\nDir::State::extended_states "{self.folder}/states";\n'
            'Dir::Cache::pkgcache "";\nDir::Cache::srcpkgcache "";\n'
            'Dir::Etc::SourceList "/dev/null";\nDir::Etc::SourceParts "/dev/null";\n')

    def seconds(self):
        """How long packages.sh takes; it has to succeed."""
        begin = time.monotonic()
        run = subprocess.run([SCRIPT, "docs"], capture_output=True, text=True, timeout=60, env={
            **os.environ, "APT_CONFIG": str(self.folder / "apt.conf"),
            "PATH": f"{self.folder}/bin:{os.environ['PATH']}"})
        self.assertEqual(run.returncode, 0, run.stdout + run.stderr)
        self.assertNotIn("going on with", run.stderr)
        return time.monotonic() - begin

    def held(self, lock):
        with open(self.folder / lock, "w") as file:
            fcntl.lockf(file, fcntl.LOCK_EX)
            release = threading.Timer(HELD, fcntl.lockf, (file, fcntl.LOCK_UN))
            release.start()
            self.assertGreaterEqual(self.seconds(), HELD)
            release.join()

    def test_without_a_lock_it_just_installs(self):
        self.seconds()

    def test_waits_for_dpkg(self):
        self.held("dpkg/lock-frontend")

    def test_waits_for_the_lists(self):
        self.held("lists/lock")


if __name__ == "__main__":
    unittest.main()
