#!/usr/bin/env python3
"""Ctrl-C at any moment: exit 130 with one line, no child and nothing half-written left, and what is shown meanwhile.

usage: interrupt_test.py SLABCAST [arguments of unittest]
"""

import fcntl
import os
import pty
import select
import signal
import subprocess
import sys
import termios
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "support"))
from cli_case import CliTest, main  # noqa: E402

LINE = "slabcast: interrupted\n"
LONG = 60  # s: what takes longer than this has not been interrupted


def heeding():
    """As from a shell in the foreground, whatever the test was started from."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)


def children(pid):
    """Of a process: number and name of each."""
    found = {}
    for task in Path(f"/proc/{pid}/task").glob("*/children"):
        for child in task.read_text().split():
            try:
                found[int(child)] = Path(f"/proc/{child}/comm").read_text().strip()
            except FileNotFoundError:
                pass  # it has ended
    return found


def until(condition, what):
    """What it gives, once it gives something."""
    end = time.monotonic() + LONG
    while time.monotonic() < end:
        result = condition()
        if result:
            return result
        time.sleep(0.002)
    raise AssertionError(f"never: {what}")


def runs(pid):
    try:
        return Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()[0] not in "ZX"
    except FileNotFoundError:
        return False


class InterruptTest(CliTest):
    def start(self, *arguments, preexec=heeding, **options):
        process = subprocess.Popen([self.program, *arguments], cwd=self.folder, text=True, preexec_fn=preexec,
                                   stdout=subprocess.PIPE, stderr=subprocess.PIPE, **options)
        self.addCleanup(process.kill)
        return process

    def huge(self):
        """A file that takes long to read, and no room."""
        with open(self.folder / "huge.raw", "wb") as file:
            file.truncate(1 << 32)
        return "huge.raw", "--raw", "2048x2048x1024,uint8,1x1x1"

    def is_interrupted(self, process, by=signal.SIGINT):
        process.send_signal(by)
        _, errors = process.communicate(timeout=LONG)
        self.assertEqual(process.returncode, 128 + by, errors)
        self.assertEqual(errors, LINE)

    def test_while_a_file_is_read(self):
        for by in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
            with self.subTest(by):
                process = self.start("info", *self.huge())
                reader = until(lambda: children(process.pid), "a reader")
                self.is_interrupted(process, by)
                until(lambda: not any(runs(pid) for pid in reader), "the reader's end")

    def test_while_a_report_is_made(self):
        """Its folder is there, and gone with the program as long as nothing is in it."""
        phantom = "phantom:shells:32"
        for command in (("stability",), ("error", phantom), ("skipbench", phantom, "--frames", "50"),
                        ("sweep", phantom, "--layers", "1,2,4,8", "--frames", "5000"),
                        ("edit", phantom, "--frames", "10000")):
            with self.subTest(command):
                process = self.start(*command, "--out", "report")
                until((self.folder / "report").exists, "a folder")
                time.sleep(0.2)
                self.is_interrupted(process)
                left = list(self.folder.rglob("*"))
                self.assertEqual([path.name for path in left if path.name.startswith(".")], [])
                for path in left:
                    self.assertGreater(path.stat().st_size, 0, path)
                subprocess.run(["rm", "-rf", self.folder / "report"], check=True)

    def test_at_any_moment(self):
        """Also within the driver: the picture is whole or not there."""
        self.write("out.png", "a picture")
        for wait in (0.0, 0.02, 0.05, 0.1, 0.2, 0.4):
            process = self.start("render", "phantom:vessels:128", "-o", "out.png", "--size", "2000x2000",
                                 "--layers", "2000", "--planes", "1", "--skip", "none")
            until(lambda: "2" in caught(process.pid), "its own way to end")
            time.sleep(wait)
            self.is_interrupted(process)
            self.assertEqual(self.kept(), {Path("out.png"): b"a picture"})

    def test_while_the_page_is_made(self):
        process = self.start("sweep", "phantom:shells:16", "--layers", "1", "--frames", "3", "--size", "16x16",
                             "--out", "report")
        page = until(lambda: [pid for pid, name in children(process.pid).items() if name.startswith("python")]
                     or process.poll() is not None and [0], "a page maker")
        self.assertNotEqual(page, [0], "the page was made before it was seen")
        self.is_interrupted(process)
        until(lambda: not any(runs(pid) for pid in page), "the page maker's end")
        self.assertEqual([path for path in self.kept() if path.name.startswith((".", "report.html"))], [])

    def test_what_was_ignored_stays_so(self):
        """nohup's way: SIGINT does nothing, SIGTERM what it does."""
        process = self.start("stability", "--out", "report",
                             preexec=lambda: signal.signal(signal.SIGINT, signal.SIG_IGN))
        until((self.folder / "report").exists, "a folder")
        process.send_signal(signal.SIGINT)
        time.sleep(0.1)
        self.is_interrupted(process, signal.SIGTERM)

    def test_at_a_terminal(self):
        """Shows how far it is, and takes the key itself."""
        terminal, ours = pty.openpty()

        def session():
            heeding()
            os.setsid()
            fcntl.ioctl(ours, termios.TIOCSCTTY, 0)

        process = subprocess.Popen([self.program, "info", *self.huge()], cwd=self.folder, preexec_fn=session,
                                   stdin=ours, stdout=subprocess.PIPE, stderr=ours)
        self.addCleanup(process.kill)
        shown = b""
        while b"huge.raw: 1 %" not in shown and select.select([terminal], [], [], LONG)[0]:
            shown += os.read(terminal, 4096)
        self.assertRegex(shown, rb"\r\x1b\[Kreading huge.raw: 1 %")
        os.write(terminal, b"\x03")
        self.assertEqual(process.wait(timeout=LONG), 130)
        shown = b""
        while select.select([terminal], [], [], 0.1)[0]:
            shown += os.read(terminal, 4096)
        self.assertRegex(shown, rb"\r\x1b\[Kslabcast: interrupted\r\n\Z")
        os.close(ours)
        os.close(terminal)
        process.stdout.close()


def caught(pid):
    """The signals that a process handles, each as its number."""
    for line in Path(f"/proc/{pid}/status").read_text().splitlines():
        if line.startswith("SigCgt:"):
            mask = int(line.split()[1], 16)
            return {str(number) for number in range(1, 65) if mask >> (number - 1) & 1}
    return set()


if __name__ == "__main__":
    main(__doc__)
