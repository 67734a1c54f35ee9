#!/usr/bin/python3
"""perf/pages/report.py from a made-up sweep: what the page says, what it refuses, what it survives.

With a folder as its argument, writes the made-up sweep and its page there, to look at.
"""

import json
import os
import re
import struct
import subprocess
import sys
import tempfile
import unittest
import zlib
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "support"))
from report_pages import check_figures, words_of  # noqa: E402

REPORT = Path(__file__).resolve().parent.parent.parent / "perf" / "pages" / "report.py"
RATIOS = [(1, 444), (2, 222), (4, 111), (7, 64), (14, 32), (28, 16), (37, 12), (56, 8), (111, 4), (222, 2), (444, 1)]


def png(grey, size=96):
    """A flat grey picture as a PNG file's bytes."""
    def chunk(kind, data):
        body = kind + data
        return struct.pack(">I", len(data)) + body + struct.pack(">I", zlib.crc32(body))
    lines = zlib.compress(b"".join(b"\0" + bytes([grey]) * size for _ in range(size)))
    header = struct.pack(">IIBBBBB", size, size, 8, 0, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", lines) + chunk(b"IEND", b"")


def external(text):
    """What a page would load, or lead to, outside itself."""
    return re.findall(r'(?:src|href)="(?!data:|#)[^"]*"|url\((?!#)[^)]*\)|@import', text)


def row(planes, layers, skip, ms):
    evaluated = 1_000_000 * (444 if skip == "none" else 60 + 384 / layers)
    form = "unrolled" if layers <= 64 else "loop"
    return {
        "label": f"{planes}x{layers}", "classify": "post", "termination": "off", "lattice": "planar",
        "planes": planes, "layers_per_plane": layers, "form": form, "skip": skip, "tighten": True,
        "frame_ms": {"median": ms, "min": 0.9 * ms, "max": 1.3 * ms, "p10": 0.95 * ms, "p90": 1.1 * ms, "n": 36},
        "counters": {
            "fragments": 1_000_000 * planes, "layers_evaluated": evaluated,
            "layers_skipped": 444_000_000 - evaluated, "volume_fetches": evaluated,
            "skip_fetches": 0 if skip == "none" else 1_000_000 * (planes + 20)},
        "compile_ms": 3.0 + 0.8 * min(layers, 64), "first_frame_ms": 1.5 * ms, "variant": f"post-{skip}-{form}{layers}",
        "model": {"g71": {"device": "Mali-G71 MP20, Galaxy S8", "frame_ms": ms / 10, "low_ms": ms / 12, "high_ms": ms / 5,
                          "limit": "texture", "divergence_ms": 1.25}},
        "thumbnail": f"thumbnails/{planes}x{layers}_{skip}.png"}


def sweep():
    """Slicing takes 700 ms either way; the best is 37x12 with skipping, at 175 ms: 4 times as fast."""
    slow = dict(zip(RATIOS, (1300, 900, 800, 640, 600, 560, 555, 560, 590, 630, 700)))
    fast = dict(zip(RATIOS, (420, 380, 330, 260, 220, 185, 175, 190, 300, 480, 700)))
    return {
        "command": "slabcast sweep skull.nrrd --layers 1,2,4 --out out", "commit": "abc1234", "date": "2026-01-02",
        "device": {"vendor": "Maker", "renderer": "Test <GPU> & Co", "version": "OpenGL ES 3.2", "software": True},
        "volume": {"name": "skull.nrrd", "dims": [256, 256, 256], "type": "int16", "spacing_mm": [0.9, 0.9, 0.9],
                   "bytes": 33554432},
        "conditions": {"size": [1024, 1024], "layer_spacing_mm": 0.9, "total_layers": 444, "rounds": 36, "views": 1,
                       "settings": {"classify": "post", "space": "display", "target": "rgba8", "shade": False,
                                    "termination": None, "lattice": "planar", "tighten": True}},
        "memory": {"host_peak_bytes": 201326592, "gpu_volume_bytes": 33554432, "gpu_skip_bytes": 262144},
        "skip": {"structure": "proximity", "parameters": {"skip_block": 4}, "build_ms": 41.5, "gpu_bytes": 262144,
                 "occupied_fraction": 0.183},
        "rows": [{**row(*ratio, skip, ms[ratio]), **speed_ups(slow, ms, ratio)}
                 for skip, ms in (("none", slow), ("proximity", fast)) for ratio in RATIOS]}


def speed_ups(plain, ms, ratio):
    """As the program works them out, with intervals from nine tenths to eleven tenths."""
    found = {"slicing": ms[444, 1] / ms[ratio], "plain": plain[ratio] / ms[ratio],
             "plain_slicing": plain[444, 1] / ms[ratio]}
    return {"speedup_coverage": 0.961, **{f"speedup_over_{over}{end}": share * value for over, value in found.items()
                                          for end, share in (("", 1), ("_low", 0.9), ("_high", 1.1))}}


def write_sweep(folder, data):
    (folder / "sweep.json").write_text(json.dumps(data))
    (folder / "thumbnails").mkdir(exist_ok=True)
    for entry in data["rows"]:
        if "thumbnail" in entry:
            (folder / entry["thumbnail"]).write_bytes(png(20 + entry["planes"] % 200))


def run(folder, seed="0"):
    """`seed`: of Python's hashes, which order sets."""
    return subprocess.run([REPORT, folder], capture_output=True, text=True, check=False,
                          env={**os.environ, "PYTHONHASHSEED": seed})


class WholePageTest(unittest.TestCase):
    """The page of the whole made-up sweep, made once."""

    @classmethod
    def setUpClass(cls):
        temporary = tempfile.TemporaryDirectory()
        cls.addClassCleanup(temporary.cleanup)
        cls.folder = Path(temporary.name)
        write_sweep(cls.folder, sweep())
        cls.result = run(cls.folder, "1")
        cls.text = (cls.folder / "report.html").read_text()

    def test_is_made_without_a_complaint(self):
        self.assertEqual((self.result.returncode, self.result.stderr), (0, ""))
        self.assertEqual(sorted(path.name for path in self.folder.iterdir()),
                         ["figures", "report.html", "sweep.json", "thumbnails"])

    def test_says_what_was_measured(self):
        text = self.text
        for expected in ("37×12", "4.00×", "software driver", "abc1234", "2026-01-02", "OpenGL ES 3.2", "41.5 ms",
                         "18.3 %", "192 MiB", "slabcast sweep skull.nrrd --layers 1,2,4 --out out"):
            self.assertIn(expected, text)
        self.assertIn("Test &lt;GPU&gt; &amp; Co", text)
        self.assertIn("<dd>off, off</dd>", text)
        self.assertEqual(len(re.findall(r'<tr><th scope=row>\d+×\d+</th>', text)), 22)

    def test_ratios_have_their_intervals(self):
        self.assertIn("4.00× (3.60 – 4.40) the speed of slicing", self.text)
        self.assertIn("<td>4.00×<br><i>3.60 – 4.40</i></td>", self.text)
        self.assertIn("here 96.1 %.", self.text)

    def test_figures_are_files_too_and_the_same_data_make_the_same_bytes(self):
        check_figures(self, self.folder, self.text)
        figures = {path.name: path.read_bytes() for path in (self.folder / "figures").iterdir()}
        self.assertEqual(run(self.folder, "2").returncode, 0)
        self.assertEqual({path.name: path.read_bytes() for path in (self.folder / "figures").iterdir()}, figures)
        self.assertEqual((self.folder / "report.html").read_text(), self.text)

    def test_a_model_is_called_a_model(self):
        for expected in ("Other GPUs, by a model", "<strong>A model, not a measurement</strong>", "a model, not measured",
                         "<td>17.5 ms</td><td>14.6 ms – 35 ms</td>"):
            self.assertIn(expected.replace("14.6 ms – 35 ms", "14.6 – 35 ms"), self.text)
        self.assertEqual(self.text.count("model: Mali-G71 MP20, Galaxy S8"), 2)  # the wide figure and the narrow one

    def test_paper_stands_as_multiples_of_its_own_slicing(self):
        text = self.text
        for expected in ("0.34×", "0.61×", "2.59×", "Galaxy S8", "another device"):
            self.assertIn(expected, text)
        self.assertIn("1.67× <i>(1×444)</i>", text)  # 700 / 420: ours, with skipping

    def test_needs_nothing_but_itself(self):
        text = self.text
        self.assertEqual(external(text), [])
        ids = re.findall(r'\bid="([^"]+)"', text)
        self.assertEqual(len(ids), len(set(ids)))
        self.assertEqual(set(re.findall(r'href="#([^"]+)"', text)) - set(ids), set())


class ReportTest(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = Path(temporary.name)

    def page(self, data):
        write_sweep(self.folder, data)
        return words_of(self.folder, "report_data", "report_page")

    def refusal(self, expected):
        result = run(self.folder)
        self.assertEqual(result.returncode, 1)
        self.assertEqual(result.stderr.count("\n"), 1, result.stderr)
        self.assertIn(expected, result.stderr)
        self.assertFalse((self.folder / "report.html").exists())

    def test_equal_pictures_are_shown_once_and_unequal_ones_twice(self):
        text = self.page(sweep())
        self.assertEqual(text.count("<img "), len(RATIOS))
        self.assertIn("byte for byte", text)
        (self.folder / "thumbnails/37x12_proximity.png").write_bytes(png(255))
        text = words_of(self.folder, "report_data", "report_page")
        self.assertEqual(text.count("<img "), len(RATIOS) + 1)
        self.assertNotIn("byte for byte", text)

    def test_one_file_for_both_series_proves_no_sameness(self):
        data = sweep()
        for entry in data["rows"]:
            entry["thumbnail"] = entry["thumbnail"].replace("proximity", "none")
        self.assertNotIn("byte for byte", self.page(data))

    def test_no_headset_notice_on_a_gpu(self):
        data = sweep()
        data["device"]["software"] = False
        self.assertNotIn("software driver", self.page(data))

    def test_lives_without_the_optional_keys(self):
        data = {"rows": [{"planes": p, "layers_per_plane": n, "frame_ms": {"median": 10.0 + p}} for p, n in RATIOS[:3]]}
        text = self.page(data)
        self.assertIn("slicing was not measured", text)
        self.assertNotIn("Work per frame", text)

    def test_forms_of_one_ratio_are_told_apart(self):
        data = sweep()
        data["rows"] = [{**row(37, 12, "none", 100.0 if form == "loop" else 50.0), "form": form}
                        for form in ("loop", "unrolled")]
        text = self.page(data)
        self.assertIn("no skipping, loop", text)
        self.assertIn("no skipping, unrolled", text)

    def test_a_thumbnail_outside_the_folder_is_not_read(self):
        data = sweep()
        outside = self.folder.parent / f"{self.folder.name}.png"
        outside.write_bytes(png(7))
        self.addCleanup(os.unlink, outside)
        data["rows"] = [{**data["rows"][0], "thumbnail": f"../{outside.name}"}]
        self.assertEqual(self.page(data).count("<img "), 0)

    def test_refuses_bad_input_in_one_line(self):
        self.refusal("no such file")
        bad = {"no json": "{", "no rows": '{"rows": []}', "not an object": "[]"}
        for expected, text in (("not JSON", bad["no json"]), ("no rows", bad["no rows"]),
                               ("no rows", bad["not an object"])):
            (self.folder / "sweep.json").write_text(text)
            self.refusal(expected)
        data = sweep()
        data["rows"][3]["frame_ms"]["median"] = None
        write_sweep(self.folder, data)
        self.refusal("rows[3].frame_ms.median")


if __name__ == "__main__":
    if len(sys.argv) == 2 and Path(sys.argv[1]).is_dir():
        write_sweep(Path(sys.argv[1]), sweep())
        sys.exit(run(sys.argv[1]).returncode)
    unittest.main()
