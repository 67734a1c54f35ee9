#!/usr/bin/python3
"""perf/pages/error_report.py from made-up errors: what the page says, what it refuses, what it survives.

With a folder as its argument, writes the made-up errors and their page there, to look at.
"""

import itertools
import json
import math
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

from report_test import external, png

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "support"))
from report_pages import ReportTest  # noqa: E402

REPORT = Path(__file__).resolve().parent.parent.parent / "perf" / "pages" / "error_report.py"
SPACINGS = (4, 2, 1, 0.5, 0.25)
LAYERS = (1, 8, 16, 64, 0)
TOTAL = 400  # layers at one voxel each
# Error of the sampling at one voxel per layer, its order, and what the table adds.
CLASSIFICATIONS = {"post": (6e-3, 2, 4e-5), "preclassified": (2e-2, 1, 1e-4), "preintegrated": (1.5e-3, 2, 6e-4)}


def errors(rmse):
    return {"rmse": rmse, "psnr": -20 * math.log10(rmse) if rmse else None, "max": 12 * rmse,
            "mean_delta_e": 40 * rmse, "p999_delta_e": 400 * rmse}


def row(classification, target, termination, jitter, spacing, layers):
    total = round(TOTAL / spacing)
    planes = 1 if layers == 0 else -(-total // layers)
    base, order, table = CLASSIFICATIONS[classification]
    gpu = 1.1e-3 * math.sqrt(planes / 10) if target == "rgba8" else 4e-5 * (1 + math.sqrt(planes) / 20)
    gpu += 2e-3 if termination != "off" else 0
    sampling = base * spacing ** order * (0.7 if jitter else 1)
    ms = 12 + 0.12 * total * (1.6 if classification == "preintegrated" else 1) + 0.25 * planes
    ms *= (1.12 if target == "rgba16f" else 1) * (0.8 if termination != "off" else 1)
    name = f"{classification}_{target}_s{spacing}_l{layers}_t{termination}{'_j' if jitter else ''}"
    fetches = 16_000 * total * (0.7 if termination != "off" else 1)
    return {
        "id": name, "spacing": spacing, "layers": layers, "classification": classification, "target": target,
        "ratio": {0: "ray casting", 1: "slicing"}.get(layers, "hybrid"), "termination": termination,
        "jitter": jitter,
        "plan": {"planes": planes, "layers_per_plane": layers or total, "layers": total, "layer_spacing_mm": spacing,
                 "variant": f"{classification}-proximity-loop"},
        "error": {"total": errors(math.hypot(sampling, table, gpu)), "sampling": errors(sampling),
                  "table": errors(table), "gpu": errors(gpu)},
        "order": {"total": 0.9 * order, "sampling": order, "table": None, "gpu": None},
        "date": "2026-01-02T10:00:05Z", "coarser": None,
        "frame_ms": {"median": ms, "min": 0.95 * ms, "max": 1.2 * ms, "p10": ms, "p90": ms, "n": 4},
        "counters": {"fragments": 9000 * planes, "layers_evaluated": fetches, "layers_skipped": 2 * fetches,
                     "volume_fetches": fetches, "skip_fetches": 900 * (planes + 20)},
        "command": f"slabcast render skull.nrrd -o {name}.png --layer-spacing {spacing}",
        "pictures": {"thumbnail": f"pictures/{name}.png", "difference": f"pictures/{name}_difference.png",
                     "difference_factor": 64}}


def front_of(rows, cost):
    """Indices of the rows that no other row matches in cost and error while beating it in one; cheapest first."""
    def beaten(a):
        return any(cost(b) <= cost(a) and rmse(b) <= rmse(a) and (cost(b), rmse(b)) != (cost(a), rmse(a))
                   for b in rows)
    return sorted((i for i, a in enumerate(rows) if not beaten(a)), key=lambda i: cost(rows[i]))


def rmse(entry):
    return entry["error"]["total"]["rmse"]


def milliseconds(entry):
    return entry["frame_ms"]["median"]


def fetches(entry):
    return entry["counters"]["volume_fetches"] + entry["counters"]["skip_fetches"]


def measured(spacings=(2, 0.5), layers=(1, 16, 0), jitters=(False, True), terminations=("off",)):
    rows = [row(*settings) for settings in itertools.product(
        CLASSIFICATIONS, ("rgba8", "rgba16f"), terminations, jitters, spacings, layers)]
    return {
        "command": "slabcast error skull.nrrd --out err --quick", "commit": "abc1234", "date": "2026-01-02T10:00:09Z",
        "started": "2026-01-02T10:00:00Z",
        "device": {"vendor": "Maker", "renderer": "Test <GPU> & Co", "version": "OpenGL ES 3.2", "software": True},
        "volume": {"name": "skull", "dims": [256, 256, 108], "type": "int16", "unit": "HU", "spacing_mm": [1, 1, 2],
                   "bytes": 14155776},
        "conditions": {"size": [160, 160], "camera": [0, 10, 2.5], "fov_degrees": 40, "transfer_function": "CT bone",
                       "space": "display", "lattice": "planar", "tighten": True, "skip": "auto", "form": "auto",
                       "texel_format": "r16", "smallest_voxel_edge_mm": 1.0, "frames_per_row_at_most": 5, "quick": True},
        "left_out": [{"classification": "emission", "why": "this device lacks what it needs"}],
        "reference": {"seconds": 6.1, "tolerance": 1e-10, "size": [160, 160], "picture": "pictures/reference.png"},
        "rows": rows, "front": front_of(rows, milliseconds), "front_by_fetches": front_of(rows, fetches)}


def write(folder, data):
    (folder / "error.json").write_text(json.dumps(data))
    (folder / "pictures").mkdir(exist_ok=True)
    (folder / "pictures/reference.png").write_bytes(png(200))
    for i in data["front"]:
        pictures = data["rows"][i]["pictures"]
        (folder / pictures["thumbnail"]).write_bytes(png(150 + i % 50))
        (folder / pictures["difference"]).write_bytes(png(i % 50))


def run(folder):
    return subprocess.run([REPORT, folder], capture_output=True, text=True, check=False)


def table_rows(text):
    """(class, name) of each line of the table of all rows, in order."""
    body = text[text.index("<h2>Every row</h2>"):]
    return re.findall(r'<tr(?: class="(\w+)")?><th scope=row><code>([^<]+)</code>', body)


class WholePageTest(unittest.TestCase):
    """The page of the whole made-up grid, made once."""

    @classmethod
    def setUpClass(cls):
        cls.data = measured()
        with tempfile.TemporaryDirectory() as folder:
            write(Path(folder), cls.data)
            cls.result = run(folder)
            cls.text = (Path(folder) / "report.html").read_text()

    def test_is_made_without_a_complaint(self):
        self.assertEqual((self.result.returncode, self.result.stderr), (0, ""))
        self.assertTrue(self.result.stdout.endswith("report.html\n"))

    def test_all_rows_are_there_the_front_first_then_by_error(self):
        rows, front = self.data["rows"], self.data["front"]
        self.assertTrue(0 < len(front) < len(rows))
        order = sorted(range(len(rows)), key=lambda i: (i not in front, rmse(rows[i])))
        self.assertEqual(table_rows(self.text), [("front" if i in front else "", rows[i]["id"]) for i in order])

    def test_every_row_has_its_command(self):
        for entry in self.data["rows"]:
            self.assertIn(f"<code>{entry['command']}</code></details>", self.text)

    def test_headline_says_what_the_rows_say(self):
        text = self.text
        self.assertIn(f"Of {len(self.data['rows'])} settings measured, {len(self.data['front'])} are on the front",
                      text)
        # Of 800 layers half a voxel apart, slicing blends 800 planes: RGBA8 rounds 1.1e-3 sqrt(80) = 9.8e-3 away.
        self.assertIn("RGBA8 more than doubles RGBA16F’s error: post-classified from 800 planes on", text)
        self.assertIn("pre-classified at none of 1 to 800 planes", text)
        most_accurate = min(self.data["rows"], key=rmse)
        self.assertIn(f"RMSE {rmse(most_accurate):.2e}".replace("e-0", "e−"), text)

    def test_budgets_find_the_most_accurate_row_of_each_classification(self):
        lines = re.findall(r"<tr><th scope=row>([\d.,]+) ms</th>(.*?)</tr>", self.text)
        self.assertGreater(len(lines), 2)
        for budget, cells in lines:
            shown = re.findall(r"<td>(?:<b>)?([^<]+)", cells)
            for name, value in zip(CLASSIFICATIONS, shown, strict=True):
                within = [rmse(entry) for entry in self.data["rows"] if entry["classification"] == name
                          and milliseconds(entry) <= float(budget.replace(",", ""))]
                self.assertEqual(value, f"{min(within):.2e}".replace("e-0", "e−") if within else "–")

    def test_names_the_run(self):
        for expected in ("software driver", "abc1234", "2026-01-02", "Test &lt;GPU&gt; &amp; Co", "CT bone",
                         "1e−10 relative", "this device lacks what it needs", self.data["command"]):
            self.assertIn(expected, self.text)

    def test_says_how_many_frames_and_how_high_the_view_is(self):
        self.assertIn("at most 5 (quick run)", self.text)
        self.assertIn("<th scope=col>frames</th>", self.text)
        self.assertEqual(len(re.findall(r" – [\d.,]+</td><td>4</td>", self.text)), len(self.data["rows"]))
        self.assertIn("40° high", self.text)

    def test_parts_are_what_they_hold(self):
        for words in ("finite layers and classifying first", "sampling: finite layers, classifying first",
                      "termination and blending into the target", "float32, termination, blending"):
            self.assertIn(words, self.text)

    def test_shows_the_reference_and_two_pictures_of_each_of_the_front(self):
        self.assertEqual(self.text.count("<img "), 1 + 2 * len(self.data["front"]))
        self.assertEqual(self.text.count("difference × 64"), len(self.data["front"]))

    def test_has_all_its_plots_for_desks_and_phones(self):
        for name in ("time", "fetches", "convergence", "planes", "jitter"):
            for suffix in ("", "-n"):
                self.assertIn(f'id="{name}{suffix}-', self.text)

    def test_needs_nothing_but_itself(self):
        self.assertEqual(external(self.text), [])
        ids = re.findall(r'\bid="([^"]+)"', self.text)
        self.assertEqual(len(ids), len(set(ids)))


class ErrorReportTest(ReportTest):
    report = REPORT
    data = "error.json"

    def test_lives_without_the_optional_keys(self):
        entry = row("post", "rgba8", "off", False, 1, 0)
        kept = {name: entry[name] for name in ("id", "spacing", "layers", "classification", "target", "plan")}
        kept.update(error={"total": {"rmse": 0, "psnr": None}, "sampling": None, "table": None, "gpu": None},
                    frame_ms={"median": 5.0}, counters=None)
        (self.folder / "error.json").write_text(json.dumps({"rows": [kept], "front": [0], "front_by_fetches": []}))
        result = run(self.folder)
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        text = (self.folder / "report.html").read_text()
        self.assertEqual(table_rows(text), [("front", kept["id"])])
        for missing in ("Convergence", "Error over fetches", "jitter costs", "RGBA8 blending", "Pictures of"):
            self.assertNotIn(missing, text)

    def test_tells_rows_of_an_earlier_run(self):
        def told(count):
            data = measured(layers=(0,), jitters=(False,))
            for entry in data["rows"][:count]:
                entry["date"] = "2026-01-01T23:00:00Z"
            write(self.folder, data)
            self.assertEqual(run(self.folder).returncode, 0)
            return re.findall(r"(\d+ rows? \w+) measured earlier", (self.folder / "report.html").read_text())
        self.assertEqual([told(0), told(1), told(3)], [[], ["1 row was"], ["3 rows were"]])

    def test_refuses_what_is_no_measurement_in_one_line(self):
        self.refusal("no such file")
        self.refusal("not JSON", "{")
        self.refusal("holds no rows", {"rows": []})
        self.refusal("holds no rows", [])
        self.refusal("rows[0] is no object", {"rows": [1]})

    def test_refuses_rows_of_wrong_types_in_one_line(self):
        def spoilt(key, value, *path):
            data = measured(layers=(0,), jitters=(False,))
            place = data["rows"][2]
            for name in path:
                place = place[name]
            place[key] = value
            return data
        self.refusal("rows[2].frame_ms.median", spoilt("median", "5", "frame_ms"))
        self.refusal("rows[2].error.total.rmse", spoilt("rmse", None, "error", "total"))
        self.refusal("rows[2].spacing", spoilt("spacing", 0))
        self.refusal("rows[2].id", spoilt("id", 7))
        data = measured(layers=(0,), jitters=(False,))
        for front in ([len(data["rows"])], ["a"], {}):
            self.refusal("front does not name rows", {**data, "front": front})

    def test_bad_usage_is_told_apart(self):
        self.assertEqual(subprocess.run([REPORT], capture_output=True, check=False).returncode, 2)


if __name__ == "__main__":
    if len(sys.argv) == 2 and Path(sys.argv[1]).is_dir():
        write(Path(sys.argv[1]), measured(SPACINGS, LAYERS, terminations=("off", 0.99609375)))
        sys.exit(run(sys.argv[1]).returncode)
    unittest.main()
