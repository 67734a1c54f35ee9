#!/usr/bin/python3
"""perf/pages/stability_report.py from made-up cases: what the page says, what it refuses, what it survives.

With a folder as its argument, writes the made-up cases and their page there, to look at.
"""

import html
import json
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

from report_test import external, png

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "support"))
from report_pages import ReportTest  # noqa: E402

REPORT = Path(__file__).resolve().parent.parent.parent / "perf" / "pages" / "stability_report.py"
METHODS = ("slicing, rgba8", "hybrid, rgba8", "ray casting, rgba8", "slicing, rgba16f", "ray casting, rgba16f")
PIXEL = "the pixel's own bound: filter, float32 positions, table and blending, each rounded once"


def case(family, name, bound, measured, reason=PIXEL, quantity="worst share of the pixel's bound", **more):
    return {"family": family, "name": name, "quantity": quantity, "bound": bound, "reason": reason,
            "measured": measured, "pass": measured is not None and measured <= bound, **more}


def turning(lattice, ratio, degrees):
    swims = {"planar": 0.02, "shells": 0.004}[lattice] * degrees * {"slicing": 1.5, "hybrid": 1}[ratio]
    return case("in-time", f"turned by {degrees} degrees, {lattice}, {ratio}", 0.1, swims,
                "twice the reference's change", "RMS change",
                series={"group": f"{lattice}, {ratio}", "x": degrees, "y": swims,
                        "x_label": "turn, degrees", "y_label": "RMS change of a pixel"})


def depth(way, x):
    """Errors over bounds of many decades."""
    error = {"float32": 1e-7, "rgba8": 2e-3 / x}[way]
    return case("optical-depth", f"depth {x}, {way}", 2 * error, error, "a rounding", "error of alpha, of itself",
                series={"group": way, "x": x, "y": error, "x_label": "optical depth", "y_label": "error of alpha",
                        "bound": 2 * error})


def condition(name, limit, share):
    return case("conditioning", name, 9.0, 1.5, "by <derivatives>", "condition number",
                condition={"scene": "ramps & steps", "input": name, "perturbation": 2.0 ** -23, "largest_change": 3e-7,
                           "condition_number": 2.5, "limit": limit, "jumping_share": share})


def measured():
    stiff = [case("stiff", f"one-unit step, {method}", 1.0, 0.05 * (i + 1) ** 2 / 3,
                  pictures=[{"name": "drawn", "file": f"pictures/step{i}.png"}] if i < 2 else [])
             for i, method in enumerate(METHODS)]
    stiff.append(case("stiff", "opacity 1 <behind & before>", 1 / 255, 2 / 255, "half a step of <8> bits, twice",
                      "largest difference", pictures=[{"name": "drawn", "file": "pictures/fails.png"}]))
    data = [case("extreme-data", "all zero", 0.0, 0.0, "nothing is drawn", "largest component"),
            case("extreme-data", "only NaN", 1e-3, None, "NaN is not visible", "largest component"),
            case("extreme-data", "1x1x2048", 1e-3, 0.0, "", "", failure="this device has no textures so large",
                 **{"pass": False})]
    half = [case("half-precision", f"{group}, {scene}, {method}", 0.05, value * (1 + len(method) / 100),
                 "u = 2^-11: 16u A", "largest difference from float32, of full scale")
            for group, value in (("opacity", 8e-3), ("light", 9e-4))
            for scene in ("translucent", "faint, 1,300 layers") for method in ("slicing", "ray casting")]
    scenes = [case("left-out", name, 0, 0, "by GL's own account", "resources too many",
                   left_out={"plan": ["no skipping: nothing is empty", "no light: shading is off"][:n],
                            "active_uniforms": 9 + n, "samplers": ["volume", "transfer"],
                            "fragments": 900 * n, "layers": 70_000 * n,
                            "volume_and_skip_bytes": 2 ** 20 * n, "timed_frames": 9, "least_frame_ms": 2.0 * n,
                            "least_frame_ms_with_all": 5.0})
              for n, name in ((1, "nothing empty"), (2, "no light"))]
    bounds = [depth(way, x) for way in ("float32", "rgba8") for x in (1e-8, 1.0, 1e8)]
    bounds += [condition("eye <across>", 9.0, 0.0), condition("value", None, 0.25)]
    scenes.append(case("left-out", "skull", 0, 0, "by GL's own account", "resources too many", left_out={}))
    return {
        "command": "slabcast stability --out stability", "commit": "abc1234", "date": "2026-01-02", "reduced": True,
        "seconds": 41.5, "device": {"vendor": "Maker", "renderer": "Test <GPU> & Co", "version": "OpenGL ES 3.2",
                                    "software": False},
        "cases": stiff + data + [turning(lattice, ratio, degrees) for lattice in ("planar", "shells")
                                 for ratio in ("slicing", "hybrid") for degrees in (0.01, 0.1, 1)] + half + scenes
        + bounds,
        "families": [{"name": "stiff", "title": "Stiff transfer functions"}, {"name": "unused", "title": "Unused"},
                     {"name": "extreme-data", "title": "Extreme data"}, {"name": "in-time", "title": "In time"},
                     {"name": "half-precision", "title": "Half precision"}]}


def write(folder, data):
    (folder / "stability.json").write_text(json.dumps(data))
    (folder / "pictures").mkdir(exist_ok=True)
    for i, name in enumerate(("step0", "step1", "fails")):
        (folder / f"pictures/{name}.png").write_bytes(png(60 * i + 40))


def run(folder):
    return subprocess.run([REPORT, folder], capture_output=True, text=True, check=False)


class WholePageTest(unittest.TestCase):
    """The page of all made-up cases, made once."""

    @classmethod
    def setUpClass(cls):
        cls.data = measured()
        with tempfile.TemporaryDirectory() as folder:
            write(Path(folder), cls.data)
            cls.result = run(folder)
            cls.text = (Path(folder) / "report.html").read_text()

    def part(self, title):
        """One section's text."""
        start = self.text.index(f"<h2>{title}</h2>")
        return self.text[start:self.text.index("</section>", start)]

    def test_is_made_without_a_complaint(self):
        self.assertEqual((self.result.returncode, self.result.stderr), (0, ""))

    def test_every_case_stands_in_its_family(self):
        titles = {family["name"]: family["title"] for family in self.data["families"]}
        for entry in self.data["cases"]:
            section = self.part(titles.get(entry["family"], entry["family"]))
            self.assertIn(html.escape(entry["name"]), section)
        self.assertNotIn("Unused", self.text)

    def test_failures_come_first_with_reason_and_picture(self):
        titles = re.findall(r"<h2>([^<]+)</h2>", self.text)
        self.assertEqual(titles[:2], ["Beyond their bounds", "Families"])
        first = self.part("Beyond their bounds")
        self.assertEqual(first.count('<tr class="failed">'), 3)
        for expected in ("opacity 1 &lt;behind &amp; before&gt;", "half a step of &lt;8&gt; bits, twice", "200 %",
                         "only NaN", "no number", "this device has no textures so large", "<img "):
            self.assertIn(expected, first)

    def test_counts_per_family(self):
        counts = re.findall(r"<tr><th scope=row>(?:<a[^>]*>)?([^<]+)(?:</a>)?</th><td>(\d+)</td><td>(\d+)</td>"
                            r"<td>(?:<b class=fail>)?(\d+)", self.part("Families"))
        self.assertEqual(counts, [("Stiff transfer functions", "6", "5", "1"), ("Extreme data", "3", "1", "2"),
                                  ("In time", "12", "12", "0"), ("Half precision", "8", "8", "0"),
                                  ("left-out", "3", "3", "0"), ("optical-depth", "6", "6", "0"),
                                  ("conditioning", "2", "2", "0"), ("all", "40", "37", "3")])

    def test_a_shared_reason_is_stated_once(self):
        self.assertEqual(self.part("Stiff transfer functions").count(html.escape(PIXEL)), 1)

    def test_a_picture_stands_with_its_case(self):
        self.assertEqual(self.part("Stiff transfer functions").count("<img "), 3)

    def test_special_tables_and_plots(self):
        half = self.part("Half precision")
        # 8e-3 (1 + 11/100) is 2.26 steps of 255, beyond the half that no one sees; 9e-4 1.11 is 0.25.
        self.assertRegex(half, r"opacity</th><td>8.88e−3</td><td>8.88e−3</td><td>2.26</td><td><b class=fail>visible")
        self.assertRegex(half, r"light</th><td>9.99e−4</td><td>9.99e−4</td><td>0.25</td><td>safe")
        self.assertIn("faint, 1,300 layers</th>", half)
        self.assertIn('id="curves-in-time-0-', self.part("In time"))
        scenes = self.part("left-out")
        for expected in ("no light: shading is off", "<code>transfer</code>", "140,000", "2 MiB", "1.25×"):
            self.assertIn(expected, scenes)

    def test_condition_numbers_stand_beside_their_limits(self):
        section = self.part("conditioning")
        for expected in ("ramps &amp; steps", "eye &lt;across&gt;", "1.2e−7", "3.0e−7", "<td>2.5</td><td>9</td><td>none",
                         "<b>unbounded</b>: a step</td><td>25 %"):
            self.assertIn(expected, section)

    def test_bounds_are_drawn_where_they_are_told(self):
        sys.path.insert(0, str(REPORT.parent))
        import stability_data
        import stability_plots
        with tempfile.TemporaryDirectory() as folder:
            write(Path(folder), self.data)
            families = {family.name: family for family in stability_data.load(folder).families}
        (_, panels), = stability_plots.plots_of(families["optical-depth"])
        for point, expected in zip(sorted(panels[""]["rgba8"]), ((1e-8, 2e5, 4e5), (1, 2e-3, 4e-3), (1e8, 2e-11, 4e-11))):
            for value, meant in zip(point, expected):
                self.assertAlmostEqual(value / meant, 1, 12)
        # A millionth of the largest error would hide float32's.
        self.assertAlmostEqual(stability_plots.floor_of(panels) / 2e-12, 1, 12)
        (_, turning_panels), = stability_plots.plots_of(families["in-time"])
        self.assertAlmostEqual(stability_plots.floor_of(turning_panels) / 0.03e-6, 1, 12)

    def test_needs_nothing_but_itself(self):
        self.assertEqual(external(self.text), [])
        ids = re.findall(r'\bid="([^"]+)"', self.text)
        self.assertEqual(len(ids), len(set(ids)))
        self.assertEqual(set(re.findall(r'href="#([^"]+)"', self.text)) - set(ids), set())


class StabilityReportTest(ReportTest):
    report = REPORT
    data = "stability.json"

    def test_all_is_well_and_nothing_optional_is_there(self):
        (self.folder / "stability.json").write_text(json.dumps({"cases": [
            {"family": "stiff", "name": "a step", "bound": 1, "measured": 0.5, "pass": True}]}))
        result = run(self.folder)
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        text = (self.folder / "report.html").read_text()
        self.assertIn("50 %", text)
        self.assertNotIn("Beyond their bounds", text)
        self.assertNotIn("class=fail", text)

    def test_a_picture_outside_the_folder_is_not_read(self):
        outside = self.folder.parent / f"{self.folder.name}.png"
        outside.write_bytes(png(7))
        self.addCleanup(outside.unlink)
        entry = case("stiff", "a step", 1, 2, pictures=[{"name": "drawn", "file": f"../{outside.name}"}, 3])
        (self.folder / "stability.json").write_text(json.dumps({"cases": [entry]}))
        self.assertEqual(run(self.folder).returncode, 0)
        self.assertNotIn("<img ", (self.folder / "report.html").read_text())

    def test_refuses_bad_input_in_one_line(self):
        self.refusal("no such file")
        self.refusal("not JSON", "{")
        self.refusal("holds no cases", {"cases": []})
        self.refusal("cases[1] is no object", {"cases": [case("stiff", "a", 1, 0), 5]})
        for key, value in (("bound", "1"), ("bound", -1), ("bound", None), ("measured", "0"), ("pass", 1),
                           ("name", 3)):
            self.refusal(f"cases[0].{key}", {"cases": [{**case("stiff", "a", 1, 0), key: value}]})


if __name__ == "__main__":
    if len(sys.argv) == 2 and Path(sys.argv[1]).is_dir():
        write(Path(sys.argv[1]), measured())
        sys.exit(run(sys.argv[1]).returncode)
    unittest.main()
