#!/usr/bin/env python3
"""Folders of reports: what a run finds there it goes on with, or leaves as it is; and what docs/reports.md says of all.

usage: cli_reports_test.py SLABCAST [arguments of unittest]
"""

import json
import shutil
import statistics
import sys
import tempfile
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "support"))
from cli_case import PHANTOM, CliTest, main  # noqa: E402
from report_keys import odd_keys, undocumented_columns, undocumented_keys  # noqa: E402

REMEDY = "give --out another folder, or --fresh to start anew in this one"
SWEEP = ("sweep", PHANTOM, "--size", "32x32", "--layers", "1,8", "--tighten", "off", "--frames", "6", "--out", "d")
# Each as small as can be, into the folder d.
RUNS = {
    "sweep": SWEEP,
    "error": ("error", PHANTOM, "--size", "16x16", "--layer-spacing", "2,1", "--layers-per-plane", "0", "--classify",
              "post", "--target", "rgba8", "--termination", "off", "--jitter", "off", "--frames", "3", "--out", "d"),
    "stability": ("stability", "--reduced", "--family", "cut-rays", "--out", "d"),
    "edit": ("edit", PHANTOM, "--size", "32x32", "--layers-per-plane", "8", "--frames", "20", "--octree-frames", "1",
             "--verify", "--out", "d"),
}


class ReportCase(CliTest):
    """Runs of a place without matplotlib, which pages take most of their time for; each made once."""

    @classmethod
    def setUpClass(cls):
        if not hasattr(ReportCase, "place"):
            ReportCase.place = Path(tempfile.mkdtemp(prefix="slabcast_reports_"))
            unittest.addModuleCleanup(shutil.rmtree, cls.place)
            (cls.place / "matplotlib.py").write_text('raise ImportError("left out")\n')
            # Sweeps look for the driver's earlier results, too: nothing here depends on what compiling takes.
            ReportCase.env = {"XDG_CACHE_HOME": str(cls.place / "cache"), "PYTHONPATH": str(cls.place),
                              "MESA_SHADER_CACHE_DISABLE": "false"}

    def measures(self, *arguments, notes=""):
        """All but the page, of which it says so."""
        run = self.run_cli(*arguments, env=self.env)
        self.assertEqual(run.returncode, 1, run.stderr)
        self.assertRegex(run.stderr, rf"\A{notes}[^\n]*: left out; install python3-matplotlib [^\n]*\n"
                                     r"slabcast: d: [^\n]* are written, report.html is not: install [^\n]*\n\Z")

    def measured(self, name="sweep"):
        """The report of a run of RUNS, in the folder d."""
        if not (self.place / name).exists():
            self.measures(*RUNS[name])
            shutil.move(self.folder / "d", self.place / name)
        shutil.copytree(self.place / name, self.folder / "d")
        return self.report(name)

    def report(self, name="sweep"):
        return json.loads((self.folder / "d" / f"{name}.json").read_text())

    def rows_file(self):
        return self.folder / "d" / "rows.jsonl"

    def refused(self, arguments, *causes):
        before = self.kept()
        run = self.run_cli(*arguments, env=self.env)
        self.assertEqual(run.returncode, 1, run.stderr)
        self.assertRegex(run.stderr, rf"\Aslabcast: d: holds [^\n]*: {REMEDY}\n\Z")
        for cause in causes:
            self.assertIn(cause, run.stderr)
        self.assertEqual(self.kept(), before)


class Documented(ReportCase):
    def test_every_column_and_every_key(self):
        """Those of `error` and `skipbench`, and of all families of `stability`, are in their own tests."""
        for name in ("sweep", "edit", "stability"):
            with self.subTest(name):
                report = self.measured(name)
                for table in sorted((self.folder / "d").glob("*.csv")):
                    self.assertEqual(undocumented_columns(table, name), [], table.name)
                self.assertEqual(undocumented_keys(report, name), [])
                self.assertEqual(odd_keys(report), [])
            shutil.rmtree(self.folder / "d", ignore_errors=True)

    def test_a_column_or_a_key_that_is_not_there_would_be_found(self):
        (self.folder / "t.csv").write_text("planes,frame_ms_median,frobs\n")
        self.assertEqual(undocumented_columns(self.folder / "t.csv", "sweep"), ["frobs"])
        self.assertEqual(undocumented_keys({"rows": [{"planes": 1, "speedup_over_plain_low": 1, "frobs": {}}]}, "sweep"),
                         ["frobs"])


class Race(ReportCase):
    def test_rows_race_and_their_ratios_are_paired(self):
        rows = self.measured()["rows"]
        self.assertEqual(len(rows), 4)
        slicing = {row["skip"]: row for row in rows if row["layers_per_plane"] == 1}
        plain = {row["layers_per_plane"]: row for row in rows if row["skip"] == "none"}
        for row in rows:
            self.assertEqual(len(row["samples"]), 6)
            self.assertAlmostEqual(row["frame_ms"]["median"], statistics.median(row["samples"]), places=9)
            self.assertIsNone(row["frame_ms"]["p90"])  # of six frames the greatest
            for over, other in (("slicing", slicing[row["skip"]]), ("plain", plain[row["layers_per_plane"]]),
                                ("plain_slicing", plain[1])):
                ratios = sorted(a / b for a, b in zip(other["samples"], row["samples"], strict=True))
                found = [row[f"speedup_over_{over}{end}"] for end in ("_low", "", "_high")]
                for value, wanted in zip(found, (ratios[0], statistics.median(ratios), ratios[-1])):
                    self.assertAlmostEqual(value, wanted, places=9)
            self.assertAlmostEqual(row["speedup_coverage"], 1 - 2 / 2**6, places=9)
            self.assertGreater(row["first_frame_ms"], 0)


class GoesOn(ReportCase):
    def setUp(self):
        super().setUp()
        self.before = self.measured()
        if self.before["commit"].endswith("-dirty"):
            self.skipTest("only a build of committed sources goes on")

    def test_after_the_last_whole_round(self):
        lines = self.rows_file().read_text().splitlines(keepends=True)
        kept = [line for line in lines if '"race/round 4"' not in line and '"race/round 5"' not in line]
        self.assertEqual(len(kept), len(lines) - 2)
        self.rows_file().write_text("".join(kept))
        (self.folder / "d" / "sweep.json").unlink()
        self.measures(*SWEEP, notes=rf"slabcast: d: {len(kept) - 1} rows [^\n]* are kept\n")
        for was, row in zip(self.before["rows"], self.report()["rows"], strict=True):
            self.assertEqual(row["samples"][:4], was["samples"][:4])
            self.assertEqual(len(row["samples"]), 6)
            self.assertNotEqual(row["samples"][4:], was["samples"][4:])
            for key in ("counters", "compile_ms", "first_frame_ms", "variant"):
                self.assertEqual(row[key], was[key])

    def test_a_finished_run_is_only_written_again(self):
        self.measures(*SWEEP, notes=r"slabcast: d: \d+ rows [^\n]* are kept\n")
        self.assertEqual(self.report()["rows"], self.before["rows"])

    def test_damaged_rows_start_anew(self):
        self.rows_file().write_text(self.rows_file().read_text() + '{"id": 7}\n')
        self.measures(*SWEEP, notes=r"slabcast: d: rows\.jsonl is damaged: starts anew\n")
        self.assertNotEqual(self.report()["rows"][0]["samples"], self.before["rows"][0]["samples"])


class HoldsAnother(ReportCase):
    def test_run_of_the_same_command(self):
        self.measured()
        self.refused((*SWEEP, "--camera", "40,10,3", "--lattice", "shells"), "a 'sweep' run of shells (slabcast sweep ",
                     "which differs in camera, lattice")
        self.refused(("sweep", "phantom:vessels:24", *SWEEP[2:]), "differs in ", "voxels")
        (self.folder / "d" / "sweep.json").unlink()
        self.refused((*SWEEP, "--camera", "40,10,3"), "holds the beginning of a 'sweep' run of shells")
        self.measures(*SWEEP, "--camera", "40,10,3", "--fresh")
        self.assertEqual(self.report()["conditions"]["camera"], [40, 10, 3])

    def test_run_of_another_command(self):
        """Of each command's folder each other keeps away; with --fresh it leaves nothing of the other's."""
        self.measured("edit")
        for name, arguments in RUNS.items():
            self.refused(arguments, "holds an 'edit' run of shells (slabcast edit ",
                         "which cannot go on" if name in ("edit", "stability") else "which is another report")
        self.measures(*SWEEP, "--fresh")
        self.assertFalse((self.folder / "d" / "edit.json").exists())
        self.assertFalse((self.folder / "d" / "edit.csv").exists())
        self.refused(RUNS["edit"], "holds a 'sweep' run of shells")
        self.measures(*RUNS["edit"], "--fresh")
        self.assertFalse(self.rows_file().exists())


if __name__ == "__main__":
    main(__doc__)
