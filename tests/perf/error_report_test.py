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
from report_pages import ReportTest, check_figures, words_of  # noqa: E402

REPORT = Path(__file__).resolve().parent.parent.parent / "perf" / "pages" / "error_report.py"
SPACINGS = (4, 2, 1, 0.5, 0.25)
LAYERS = (1, 8, 16, 64, 0)
TOTAL = 400  # layers at one voxel each
# Error of the sampling at one voxel per layer, its order, and what the table adds.
CLASSIFICATIONS = {"post": (6e-3, 2, 4e-5), "preclassified": (2e-2, 1, 1e-4), "preintegrated": (1.5e-3, 2, 6e-4)}


def errors(rmse):
    return {"rmse": rmse, "psnr": -20 * math.log10(rmse) if rmse else None, "max": 12 * rmse,
            "mean_delta_e": 40 * rmse, "p999_delta_e": 400 * rmse, "bias": -0.6 * rmse, "deviation": 0.8 * rmse,
            "visible_share": 0.125, "alpha_visible_share": 0.0625, "alpha_rmse": 2 * rmse, "alpha_max": 9 * rmse,
            **{f"{channel}_{moment}": sign * rmse for channel in ("red", "green", "blue", "alpha")
               for moment, sign in (("bias", -0.5), ("deviation", 0.7))}}


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
        "id": name, "layer_spacing": spacing, "layers_per_plane": layers, "classify": classification, "target": target,
        "ratio": {0: "ray casting", 1: "slicing"}.get(layers, "hybrid"), "termination": termination,
        "jitter": jitter,
        "plan": {"planes": planes, "layers_per_plane": layers or total, "layers": total, "layer_spacing_mm": spacing,
                 "variant": f"{classification}-proximity-loop"},
        "error": {"total": errors(math.hypot(sampling, table, gpu)), "sampling": errors(sampling),
                  "table": errors(table), "gpu": errors(gpu)},
        "flip": {"mean": 0.0123, "max": 0.456, "pixels_per_degree": 67},
        "worst_pixel": {"pixel": [80, 40], "picture": [0.5] * 4, "reference": [0.4] * 4, "error": 0.1},
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


def study(kind, method, order, expected, right=2.0, control=False):
    levels = [{"size": 2.0 ** -k, "rmse": 0.1 * 2 ** (-order * k), "change": None, "order": order if k else None,
               "self_order": None} for k in range(4)]
    return {"kind": kind, "method": method, "unit": "mm", "control": control, "expected_order": expected,
            "why_expected": f"why {method} is so", "right_order": right, "floor": 1e-8, "levels": levels, "order": order,
            "self_order": order, "asymptotic": True, "why": "the last 3 orders differ by 0.01, within 0.2",
            "as_expected": order == expected, "looks_right": order == right}


def refinement():
    return {"field": "a formula", "cube_mm": 64, "order_tolerance": 0.2, "stable_orders": 3, "csv": "refinement.csv",
            "device_refused": None, "studies": [
                study("step", "midpoint", 2, 2), study("step", "front ends", 1, 1, control=True),
                study("grid", "trilinear", 2, 2), study("pixel", "silhouette", 0.5, 1, right=1)]}


PREDICTED = {"energy_share": 0.99, "transfer_cycles_per_unit": 0.004, "gradient_per_mm": 250, "gradient_p99_per_mm": 120,
             "gradient_anywhere_per_mm": 300, "predicted_mm": 0.5, "predicted_voxels": 0.5, "predicted_p99_voxels": 1.04,
             "threshold_rmse": 1 / 255, "measured_voxels": 1.0, "measured_rmse": 3e-3, "ratio": 2.0, "ratio_p99": 0.96,
             "why": "within a factor of 2 of each other"}


def worst_ray(layers=40):
    def layer(k):
        gathered = [0.01 * k, 0.008 * k, 0.005 * k, 0.015 * k]
        return {"layer": k, "distance_mm": 500.0 + k, "place_mm": [k, 2, 3], "length_mm": 1, "value": 100 * math.sin(k),
                "color": [1, 0.8, 0.5], "opacity": 0.01, "layer_alpha": 0.01, "gathered": gathered,
                "exact": [0.99 * value for value in gathered]}
    return {"row": "post_rgba16f", "pixel": [80, 40], "pixel_from_the_top": [80, 119], "picture": [0.5] * 4,
            "reference": [0.4] * 4, "error": 0.1, "eye_mm": [0, -600, 100], "direction": [0, 1, 0], "entry_mm": 500,
            "exit_mm": 540, "entry_place_mm": [0, -100, 100], "exit_place_mm": [0, -60, 100], "layers_met": layers,
            "gathered": [0.4] * 4, "exact": [0.39] * 4, "json": "worst_ray.json", "csv": "worst_ray.csv",
            "layers": [layer(k) for k in range(layers)]}


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
        "left_out": [{"classify": "emission", "why": "this device lacks what it needs"}],
        "reference": {"seconds": 6.1, "tolerance": 1e-10, "size": [160, 160], "picture": "pictures/reference.png"},
        "convergence": [{**study("", "", 2, 2), "classify": name, "jitter": False} for name in CLASSIFICATIONS],
        "refinement": refinement(), "predicted_step": PREDICTED,
        "worst_ray": {key: value for key, value in worst_ray().items() if key != "layers"},
        "rows": rows, "front": front_of(rows, milliseconds), "front_by_fetches": front_of(rows, fetches)}


def write(folder, data):
    (folder / "error.json").write_text(json.dumps(data))
    (folder / "worst_ray.json").write_text(json.dumps(worst_ray()))
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
            check_figures(cls("test_is_made_without_a_complaint"), Path(folder), cls.text)

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
                within = [rmse(entry) for entry in self.data["rows"] if entry["classify"] == name
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
        for name in ("time", "fetches", "convergence", "planes", "jitter", "refinement", "ray"):
            for suffix in ("", "-n"):
                self.assertIn(f'id="{name}{suffix}-', self.text)

    def test_tells_orders_that_are_right_from_those_that_are_not(self):
        def verdict(method):
            return re.search(rf"<th scope=row>[^<]*{method}</th>.*?<td>(?:<span class=\"fail\">)?([^<]+)(?:</span>)?</td></tr>",
                             self.text).group(1)
        self.assertEqual([verdict(name) for name in ("midpoint", "front ends", "silhouette")],
                         ["as expected", "found out", "not as expected"])
        self.assertIn("why front ends is so", self.text)
        self.assertEqual(self.text.count("class=\"failed\""), 1)

    def test_a_control_that_passes_is_called_out(self):
        data = measured(layers=(0,), jitters=(False,))
        data["refinement"]["studies"] = [study("step", "front ends", 2, 1, control=True)]
        with tempfile.TemporaryDirectory() as folder:
            write(Path(folder), data)
            self.assertIn('<span class="fail">passes as right', words_of(Path(folder), "error_data", "error_page"))

    def test_bias_alpha_flip_and_prediction_are_told(self):
        for expected in ("12.5 %", "6.25 %", "0.0123", "67 pixels a degree", "measured over predicted", "0.5 voxels",
                         "within a factor of 2 of each other", "80, 119 from the upper left", "worst_ray.csv"):
            self.assertIn(expected.lower(), self.text.lower())

    def test_needs_nothing_but_itself(self):
        self.assertEqual(external(self.text), [])
        ids = re.findall(r'\bid="([^"]+)"', self.text)
        self.assertEqual(len(ids), len(set(ids)))


class ErrorReportTest(ReportTest):
    report = REPORT
    data = "error.json"

    def test_lives_without_the_optional_keys(self):
        entry = row("post", "rgba8", "off", False, 1, 0)
        kept = {name: entry[name] for name in ("id", "layer_spacing", "layers_per_plane", "classify", "target", "plan")}
        kept.update(error={"total": {"rmse": 0, "psnr": None}, "sampling": None, "table": None, "gpu": None},
                    frame_ms={"median": 5.0}, counters=None)
        (self.folder / "error.json").write_text(json.dumps({"rows": [kept], "front": [0], "front_by_fetches": []}))
        result = run(self.folder)
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        text = (self.folder / "report.html").read_text()
        self.assertEqual(table_rows(text), [("front", kept["id"])])
        for missing in ("Convergence", "Error over fetches", "jitter costs", "RGBA8 blending", "Pictures of",
                        "fall as they must", "step that was predicted", "errors are made of", "The worst ray"):
            self.assertNotIn(missing, text)

    def test_tells_rows_of_an_earlier_run(self):
        def told(count):
            data = measured(layers=(0,), jitters=(False,))
            for entry in data["rows"][:count]:
                entry["date"] = "2026-01-01T23:00:00Z"
            write(self.folder, data)
            return re.findall(r"(\d+ rows? \w+) measured earlier",
                              words_of(self.folder, "error_data", "error_page"))
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
        self.refusal("rows[2].layer_spacing", spoilt("layer_spacing", 0))
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
