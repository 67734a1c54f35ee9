"""What tests of the command line share: the program as a process, in a folder of its own."""

import json
import os
import shutil
import subprocess
import sys
import tempfile
import unittest
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from report_keys import odd_keys

PHANTOM = "phantom:shells:24"
RATIO = ("--layers", "16", "--planes", "4")  # what is given is not measured
QUICK = ("--size", "32x32", *RATIO)
POINT = {"value": 0, "color": [1, 1, 1], "opacity": 0.5}


class CliTest(unittest.TestCase):
    program = None  # from the command line

    def setUp(self):
        self.folder = Path(tempfile.mkdtemp(prefix="slabcast_cli_"))
        self.addCleanup(shutil.rmtree, self.folder)

    def write(self, name, content):
        path = self.folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content.encode() if isinstance(content, str) else content)
        return name

    def run_cli(self, *arguments, env=None, limit=""):
        """`limit`: shell commands that narrow what the process may do."""
        shell = ("sh", "-c", limit + '; exec "$0" "$@"') if limit else ()
        return subprocess.run([*shell, self.program, *map(str, arguments)], cwd=self.folder, text=True, timeout=120,
                              env={**os.environ, **(env or {})}, capture_output=True)

    def kept(self):
        """Every file of the folder and what is in it."""
        return {path.relative_to(self.folder): path.read_bytes() for path in self.folder.rglob("*") if path.is_file()}

    def succeeds(self, *arguments, notes="", **options):
        run = self.run_cli(*arguments, **options)
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertRegex(run.stderr, rf"\A{notes}\Z")
        return run.stdout

    def all_fail(self, cases, status=1, **options):
        """Of each (arguments, cause, remedy): the exit status, and one line with both. Every file stays as it was."""
        before = self.kept()
        with ThreadPoolExecutor(os.cpu_count()) as pool:
            runs = list(pool.map(lambda case: self.run_cli(*case[0], **options), cases))
        for (arguments, cause, remedy), run in zip(cases, runs):
            with self.subTest(arguments):
                self.assertEqual(run.returncode, status, run.stderr)
                self.assertEqual(run.stdout, "")
                self.assertRegex(run.stderr, r"\Aslabcast[^\n]*: [^\n]+\n\Z")
                self.assertRegex(run.stderr, cause)
                self.assertRegex(run.stderr, remedy)
        self.assertEqual(self.kept(), before)
        return runs[0].stderr

    def fails(self, *arguments, cause, remedy, **options):
        return self.all_fail([(arguments, cause, remedy)], **options)

    def renders_fail(self, cases, **options):
        """all_fail(), of renders that would replace a picture and statistics."""
        self.write("out.png", "a picture")
        self.write("out.json", "statistics")
        render = ("render", "-o", "out.png", "--stats", "out.json", *QUICK)
        return self.all_fail([((*render, *arguments), cause, remedy) for arguments, cause, remedy in cases], **options)

    def render_fails(self, *arguments, cause, remedy, **options):
        return self.renders_fail([(arguments, cause, remedy)], **options)

    def all_misused(self, cases):
        """Of each (arguments, cause): exit status 2, and one line with the cause and where to read on."""
        self.all_fail([(arguments, cause, r"'slabcast.* --help'") for arguments, cause in cases], status=2)

    def picture(self, *arguments, **options):
        """The PNG file's bytes."""
        self.succeeds("render", "-o", "p.png", *arguments, **options)
        return (self.folder / "p.png").read_bytes()

    def sparse(self):
        """A scene that is mostly empty: a ball in a larger box, under a function that has air."""
        solid = {"points": [{**POINT, "value": 100, "opacity": 0}, {**POINT, "value": 255}]}
        self.write("solid.json", json.dumps(solid))
        return "phantom:sphere:48", "--tf", "solid.json", "--size", "64x64", "--layers", "64", "--planes", "4"

    def stats(self, *arguments):
        self.picture("--stats", "s.json", *arguments)
        stats = json.loads((self.folder / "s.json").read_text())
        self.assertEqual(odd_keys(stats), [])
        return stats


def main(usage):
    """Runs the tests of the program that the first argument names."""
    if len(sys.argv) < 2 or not os.access(sys.argv[1], os.X_OK):
        sys.exit(usage)
    CliTest.program = str(Path(sys.argv.pop(1)).resolve())
    unittest.main()
