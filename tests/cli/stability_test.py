#!/usr/bin/env python3
"""`slabcast stability`, reduced, as a process: exit status, report, and what it refuses.

usage: stability_test.py SLABCAST [arguments of unittest]
"""

import csv
import json
import math
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "support"))
from report_keys import odd_keys, undocumented_columns, undocumented_keys  # noqa: E402

SLABCAST = None  # the program, from the command line
KEYS = {"family", "name", "quantity", "bound", "reason", "measured", "pass"}
OPTIONAL_KEYS = {"failure", "pictures", "series", "left_out", "condition"}
FAMILIES = ["stiff", "extreme-data", "extreme-views", "extreme-plans", "in-time", "lattices", "half-precision",
            "left-out", "symmetry", "cut-rays", "conditioning", "optical-depth", "manufactured"]
METHODS = [f"{way}, {target}" for target in ("rgba8", "rgba16f") for way in ("slicing", "hybrid", "ray casting")]


def stability(*arguments):
    return subprocess.run([SLABCAST, "stability", *map(str, arguments)], capture_output=True, text=True, timeout=300)


class ReducedRunTest(unittest.TestCase):
    """One reduced run of every family, made once."""

    @classmethod
    def setUpClass(cls):
        cls.folder = Path(tempfile.mkdtemp(prefix="slabcast_stability_"))
        cls.addClassCleanup(shutil.rmtree, cls.folder)
        cls.run_ = stability("--reduced", "--out", cls.folder)
        cls.report = json.loads((cls.folder / "stability.json").read_text())
        cls.cases = cls.report["cases"]

    def test_every_case_keeps_its_bound(self):
        exceeding = [f"{c['name']}: {c['measured']} > {c['bound']} {c.get('failure', '')}"
                     for c in self.cases if not c["pass"]]
        self.assertEqual(exceeding, [])
        self.assertEqual(self.run_.returncode, 0, self.run_.stderr)

    def test_pass_is_what_measured_and_bound_say(self):
        for case in self.cases:
            measured = case["measured"] if case["measured"] is not None else math.nan
            self.assertEqual(case["pass"], measured <= case["bound"] and "failure" not in case, case["name"])

    def test_a_bound_of_full_scale_could_be_exceeded(self):
        found = [case for case in self.cases if case["quantity"].endswith("of full scale")]
        self.assertTrue(found)
        for case in found:
            self.assertLess(case["bound"], 1, case["name"])

    def test_there_are_a_hundred_cases_in_all_families(self):
        self.assertGreaterEqual(len(self.cases), 100)
        self.assertEqual([f["name"] for f in self.report["families"]], FAMILIES)
        self.assertEqual({c["family"] for c in self.cases}, set(FAMILIES))

    def test_every_method_is_put_to_the_test(self):
        names = [c["name"] for c in self.cases if c["family"] == "stiff"]
        for method in METHODS:
            self.assertTrue(any(name.endswith(method) for name in names), method)

    def test_every_way_to_store_is_put_to_the_test(self):
        names = [c["name"] for c in self.cases if c["name"].startswith("stored along ")]
        self.assertIn("stored along +x +y +z, float32", names)
        self.assertGreater(len(names), 8)  # of 48: the reduced set

    def test_a_condition_number_is_its_change_over_its_perturbation(self):
        found = [c["condition"] for c in self.cases if "condition" in c]
        self.assertTrue(found)
        for c in found:
            self.assertAlmostEqual(c["condition_number"] * c["perturbation"], c["largest_change"], 12)
        unbounded = [c for c in found if c["limit"] is None]
        step = "step on the data's value"
        self.assertEqual({c["scene"] for c in unbounded}, {step, f"{step}, drawn in float32"})
        # All of the ball lies on the step: one ulp of the step's value is enough.
        jumping = [c for c in unbounded if c["input"] == "value of a point, 1 ulp"]
        self.assertEqual(len(jumping), 2)
        for c in jumping:
            self.assertGreater(c["jumping_share"], 0.1, c["scene"])
            self.assertGreater(c["condition_number"], 1e5, c["scene"])

    def test_lattices_are_compared_in_swim_error_and_cost(self):
        measured = {c["name"]: c["measured"] for c in self.cases if c["family"] == "lattices"}
        for scene in ("smooth", "steps", "surfaces inside"):
            of = f"lattices, {scene}, 100 degrees, 1 voxels a layer, "
            for region in ("whole view",) if scene == "surfaces inside" else ("whole view", "centre", "border"):
                self.assertGreater(measured[f"{of}swim, planar, turned by 1 degrees, {region}"], 1e-3)
                self.assertLess(measured[f"{of}swim, shells, turned by 1 degrees, {region}"], 1e-10)
                self.assertGreater(measured[f"{of}error, shells, {region}"], 1e-4)
            for phone in ("g71", "g57", "adreno650", "adreno740"):
                for layers in (1, 2, 16):
                    self.assertGreater(measured[f"{of}cost, shells over planar, {phone}, {layers} a plane"], 0.5)

    def test_names_are_unique(self):
        names = [c["name"] for c in self.cases]
        self.assertEqual(len(names), len(set(names)))

    def test_keys(self):
        self.assertLessEqual({"command", "commit", "date", "device", "reduced", "seconds"}, set(self.report))
        self.assertTrue(self.report["reduced"])
        self.assertEqual(odd_keys(self.report), [])
        self.assertEqual(undocumented_keys(self.report, "stability"), [])
        self.assertEqual(undocumented_columns(self.folder / "stability.csv", "stability"), [])
        for case in self.cases:
            self.assertLessEqual(KEYS, set(case), case["name"])
            self.assertLessEqual(set(case), KEYS | OPTIONAL_KEYS, case["name"])
            for key in ("quantity", "reason"):
                self.assertTrue(case[key].strip(), case["name"])

    def test_pictures_are_files(self):
        files = [p["file"] for c in self.cases for p in c.get("pictures", [])]
        self.assertTrue(files)
        self.assertEqual(len(files), len(set(files)))
        for file in files:
            self.assertEqual((self.folder / file).read_bytes()[:8], b"\x89PNG\r\n\x1a\n", file)

    def test_table_has_a_line_per_case(self):
        with open(self.folder / "stability.csv", newline="", encoding="utf-8") as table:
            rows = list(csv.DictReader(table))
        self.assertEqual([r["name"] for r in rows], [c["name"] for c in self.cases])
        self.assertEqual({r["pass"] for r in rows}, {"true"})

    def test_page_is_there(self):
        page = (self.folder / "report.html").read_text(encoding="utf-8")
        self.assertIn("</html>", page)


class RefusalTest(unittest.TestCase):
    def refuses(self, run, cause, status=1):
        self.assertEqual(run.returncode, status, run.stderr)
        self.assertRegex(run.stderr, rf"\Aslabcast[^\n]*{cause}[^\n]*\n\Z")

    def test_family_that_is_none(self):
        with tempfile.TemporaryDirectory() as folder:
            out = Path(folder) / "out"
            self.refuses(stability("--family", "stif", "--out", out), "stif.*one of all, stiff", status=2)
            self.assertFalse(out.exists())

    def test_folder_that_cannot_be_made(self):
        with tempfile.NamedTemporaryFile() as file:
            self.refuses(stability("--out", Path(file.name) / "out"), "cannot make this folder")


if __name__ == "__main__":
    SLABCAST = sys.argv.pop(1)
    unittest.main()
