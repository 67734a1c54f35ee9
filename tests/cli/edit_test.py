#!/usr/bin/env python3
"""`slabcast edit` as a process: exit status, report, scripts, and what it refuses.

usage: edit_test.py SLABCAST [arguments of unittest]
"""

import csv
import json
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "support"))
from report_keys import key_of, odd_keys  # noqa: E402

SLABCAST = None  # the program, from the command line
SMALL = ("phantom:vessels:32", "--size", "48x40", "--layers-per-plane", "16", "--octree-frames", "1")
KEYS = {"frame", "step", "edit", "progress", "skip", "frame_ms", "parts", "octree_ms", "over_octree", "naive_ms",
        "counters"}
SUMMARY = {"compared_with", "worst_over_octree_frame", "over_octree_frame", "worst_added_over_octree_frame",
           "worst_octree_frame_over_median", "worst_of_single_replays", "frames", "edits", "budget_ms",
           "frames_over_budget", "frame_ms", "edit_frame_ms", "edit_ms", "octree_frame_ms", "naive",
           "frames_by_structure", "hand_overs"}
BONE = {"points": [{"value": 100, "color": [1, 1, 1], "opacity": 0}, {"value": 200, "color": [1, 0.5, 0], "opacity": 0.5}]}


def edit(*arguments):
    return subprocess.run([SLABCAST, "edit", *map(str, arguments)], capture_output=True, text=True, timeout=120)


class Folder(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = Path(temporary.name)
        self.out = self.folder / "out"

    def script(self, content):
        path = self.folder / "script.json"
        path.write_text(content if isinstance(content, str) else json.dumps(content))
        return path

    def report(self):
        return json.loads((self.out / "edit.json").read_text())


class UsualEditsTest(unittest.TestCase):
    """Edits of every kind, replayed twice, every frame compared: one run for all tests."""

    @classmethod
    def setUpClass(cls):
        cls.folder = Path(tempfile.mkdtemp(prefix="slabcast_edit_"))
        cls.addClassCleanup(shutil.rmtree, cls.folder)
        # Few slices of blocks: one a frame, at worst, and the pauses are long enough to rebuild all.
        cls.run_ = edit(*SMALL, "--frames", 120, "--verify", "--replays", 2, "--quiet", 1, "--turn", 40,
                        "--skip-block", 8, "--out", cls.folder)
        cls.report = json.loads((cls.folder / "edit.json").read_text())
        cls.rows, cls.summary = cls.report["rows"], cls.report["summary"]

    def test_every_frame_is_as_from_scratch(self):
        self.assertEqual(self.run_.returncode, 0, self.run_.stderr)
        self.assertEqual([row["frame"] for row in self.rows if not row["equal"]], [])
        self.assertEqual(self.summary["frames_equal"], len(self.rows))
        self.assertEqual(self.summary["frames_to_correct"], 1)

    def test_keys(self):
        self.assertLessEqual({"command", "commit", "date", "device", "volume", "conditions", "builds"},
                             set(self.report))
        self.assertLessEqual(SUMMARY, set(self.summary))
        for row in self.rows:
            self.assertLessEqual(KEYS, set(row), row["frame"])
        self.assertEqual(odd_keys(self.report), [])

    def test_all_frames_are_there(self):
        self.assertEqual([row["frame"] for row in self.rows], list(range(120)))
        self.assertEqual(self.summary["frames"], 120)
        self.assertEqual(self.summary["edits"], sum(row["edit"] for row in self.rows))
        self.assertEqual({row["step"] for row in self.rows}, {"interpolate", "pause", "jump", "opacity", "random"})

    def test_worst_frame_is_the_worst(self):
        worst = max(row["frame_ms"] / row["octree_ms"] for row in self.rows)
        self.assertAlmostEqual(self.summary["worst_over_octree_frame"], worst, places=9)
        self.assertIsNone(self.summary["budget_ms"])
        over = sum(row["frame_ms"] > 1.5 * row["octree_ms"] for row in self.rows)
        self.assertEqual(self.summary["frames_over_budget"], over)

    def test_hands_over_when_edits_pause(self):
        self.assertGreaterEqual(self.summary["hand_overs"], 1)
        structures = {row["skip"] for row in self.rows}
        self.assertLessEqual({"bitfield-octree", "proximity"}, structures)
        for row in self.rows:
            self.assertFalse(row["edit"] and row["progress"] in ("building", "incoming", "swapped"), row)

    def test_table_has_a_line_per_frame(self):
        with open(self.folder / "edit.csv", newline="", encoding="utf-8") as table:
            lines = list(csv.DictReader(table))
        self.assertEqual([int(line["frame"]) for line in lines], list(range(120)))
        self.assertEqual([line["skip"] for line in lines], [row["skip"] for row in self.rows])
        for counter in ("fragments", "layers_evaluated", "layers_skipped", "volume_fetches", "skip_fetches",
                        "stretches", "blocks_visited"):
            self.assertEqual([int(line[counter]) for line in lines],
                             [row["counters"][key_of(counter)] for row in self.rows])

    def test_page_holds_all_by_itself(self):
        page = (self.folder / "report.html").read_text(encoding="utf-8")
        self.assertIn("</html>", page)
        self.assertNotIn("src=\"http", page)
        self.assertGreaterEqual(page.count("<svg"), 6)  # three plots, each in two widths


class ScriptTest(Folder):
    def test_script_says_what_happens_when(self):
        script = self.script({"start": BONE, "steps": [
            {"kind": "pause", "frames": 2},
            {"kind": "opacity", "point": 1, "to": 0.1, "frames": 2},
            {"kind": "jump", "to": {**BONE, "opacityUnitMm": 2}, "frames": 3},
            {"kind": "interpolate", "to": "linear", "frames": 3, "periods": 0.5},
            {"kind": "random", "frames": 4, "every": 2, "seed": 3}]})
        run = edit(*SMALL, "--script", script, "--out", self.out)
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertEqual([(row["step"], row["edit"]) for row in self.report()["rows"]], [
            ("pause", False), ("pause", False), ("opacity", True), ("opacity", True), ("jump", True),
            ("jump", False), ("jump", False), ("interpolate", True), ("interpolate", True), ("interpolate", True),
            ("random", True), ("random", False), ("random", True), ("random", False)])

    def test_a_single_replay_adds_up(self):
        """Of several replays rows hold medians of each part, which need not."""
        run = edit(*SMALL, "--interpolate", "linear,angio", "--frames", 20, "--replays", 1, "--out", self.out)
        self.assertEqual(run.returncode, 0, run.stderr)
        report = self.report()
        for row in report["rows"]:
            self.assertEqual(set(row["parts"]), {"edit_ms", "work_ms", "prepare_ms", "draw_ms"})
            self.assertAlmostEqual(row["frame_ms"], sum(row["parts"].values()), places=9)
        worst = max(row["frame_ms"] / row["octree_ms"] for row in report["rows"])
        self.assertAlmostEqual(report["summary"]["worst_of_single_replays"], worst, places=9)

    def test_structures_are_as_asked(self):
        run = edit(*SMALL, "--interpolate", "linear,angio", "--frames", 20, "--skip", "minmax-octree", "--classify",
                   "preintegrated", "--verify", "--out", self.out)
        self.assertEqual(run.returncode, 0, run.stderr)
        report = self.report()
        self.assertEqual(report["builds"]["always"]["structure"], "minmax-octree")
        self.assertNotIn("settled", report["builds"])
        self.assertEqual(report["summary"]["compared_with"], "minmax-octree")
        self.assertIn("by the min-max octree at rest", (self.out / "report.html").read_text(encoding="utf-8"))
        self.assertEqual(report["summary"]["frames_equal"], 20)


    def test_what_changes_nothing_is_no_edit(self):
        """Of one function and itself nothing is interpolated, dragged or put in place, whatever points tell it."""
        more_points = {"points": [BONE["points"][0], {"value": 150, "color": [1, 0.75, 0.5], "opacity": 0.25},
                                  BONE["points"][1]]}
        script = self.script({"start": BONE, "steps": [
            {"kind": "interpolate", "to": BONE, "frames": 4},
            {"kind": "opacity", "point": 1, "to": 0.5, "frames": 2},
            {"kind": "jump", "to": more_points, "frames": 2},
            {"kind": "interpolate", "to": "linear", "frames": 4},
            {"kind": "jump", "to": BONE, "frames": 1}]})
        run = edit(*SMALL, "--script", script, "--verify", "--out", self.out)
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertEqual([(row["step"], row["edit"]) for row in self.report()["rows"]], [
            *[("interpolate", False)] * 4, *[("opacity", False)] * 2, *[("jump", False)] * 2,
            *[("interpolate", True)] * 4, ("jump", False)])

    def test_without_edits_nothing_is_said_of_them(self):
        run = edit(*SMALL, "--interpolate", "linear,linear", "--frames", 20, "--verify", "--out", self.out)
        self.assertEqual(run.returncode, 0, run.stderr)
        summary = self.report()["summary"]
        self.assertEqual((summary["edits"], summary["frames_equal"]), (0, 20))
        for empty in (summary["edit_frame_ms"], summary["edit_ms"], summary["naive"]["edit_frame_ms"],
                      summary["frames_to_correct"]):
            self.assertIsNone(empty)
        self.assertGreater(summary["worst_over_octree_frame"], 0)


class RefusalTest(Folder):
    def refuses(self, cause, *arguments, status=1):
        run = edit(*SMALL, "--out", self.out, *arguments)
        self.assertEqual(run.returncode, status, run.stderr)
        self.assertRegex(run.stderr, rf"\Aslabcast[^\n]*{cause}[^\n]*\n\Z")
        self.assertFalse(self.out.exists())

    def test_scripts_at_fault_are_refused_by_the_entry(self):
        pause = {"kind": "pause", "frames": 1}
        for content, cause in (
                ("{", "script.json: .*correct the JSON"),
                ([], "script.json: is array, expected an object"),
                ({"steps": [pause]}, "script.json: start: is missing"),
                ({"start": "ct-bon", "steps": [pause]}, "script.json: start: .*ct-bon"),
                ({"start": BONE, "steps": []}, "steps: expected a list of at least one"),
                ({"start": BONE, "steps": [pause], "frames": 3}, "frames: unknown key"),
                ({"start": BONE, "steps": [pause, 3]}, r"steps\[1\]: is number, expected an object"),
                ({"start": BONE, "steps": [{"kind": "leap", "frames": 1}]}, r"steps\[0\]\.kind: 'leap' is none of pause"),
                ({"start": BONE, "steps": [{"kind": "pause"}]}, r"steps\[0\]\.frames: is missing"),
                ({"start": BONE, "steps": [{"kind": "pause", "frames": 1.5}]}, r"steps\[0\]\.frames: 1.5 is no whole"),
                ({"start": BONE, "steps": [{"kind": "pause", "frames": 1, "to": BONE}]}, r"steps\[0\]\.to: unknown key"),
                ({"start": BONE, "steps": [{"kind": "opacity", "frames": 1, "point": 2, "to": 0}]},
                 r"steps\[0\]\.point: 2 is outside 0\.\.1"),
                ({"start": BONE, "steps": [{"kind": "jump", "frames": 1, "to": {"points": []}}]},
                 r"steps\[0\]\.to: points: expected a list")):
            with self.subTest(content=content):
                self.refuses(cause, "--script", self.script(content))

    def test_script_that_is_not_there(self):
        self.refuses("nowhere.json: no such script", "--script", self.folder / "nowhere.json")

    def test_one_transfer_function_is_too_few(self):
        self.refuses("--interpolate: 'linear' is not two", "--interpolate", "linear", status=2)

    def test_script_and_interpolation_exclude_each_other(self):
        run = edit(*SMALL, "--out", self.out, "--interpolate", "linear,angio", "--script", "x.json")
        self.assertEqual(run.returncode, 2)

    def test_preclassified_texels_hold_the_transfer_function(self):
        self.refuses("pre-classified texels hold the transfer function", "--classify", "preclassified",
                     status=2)

    def test_structures_that_cannot_serve(self):
        for structure in ("boolean-octree", "none"):
            self.refuses(f"--skip: '{structure}' is not one of auto, blocks", "--skip", structure, status=2)


if __name__ == "__main__":
    SLABCAST = sys.argv.pop(1)
    unittest.main()
