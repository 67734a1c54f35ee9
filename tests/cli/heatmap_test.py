#!/usr/bin/env python3
"""Heatmaps of `slabcast render`, read back pixel by pixel through the lightness that they promise.

usage: heatmap_test.py SLABCAST [arguments of unittest]
"""

import json
import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "support"))
import cli_files as files  # noqa: E402

SLABCAST = None  # the program, from the command line
WIDTH, HEIGHT = 512, 256
SIZE = ("--size", f"{WIDTH}x{HEIGHT}")
SCENE = ("phantom:shells:32", "--camera", "20,10,4", "--layers-per-plane", "4", "--form", "loop")
# One dot per pixel: a margin, 7 rows of text, a margin.
STRIP = HEIGHT - 7 - 2 * 4
SUMS = {"iterations": ("stretches", "layers_evaluated"), "fetches": ("volume_fetches", "skip_fetches"),
        "layers": ("layers_evaluated",)}
LIGHTNESS_ERROR = 0.4  # of a colour in 8 bits: most at black, where a step of 1/255 is 0.27 (CIE 15)


def lightness(pixel):
    """CIELAB's L* of an sRGB colour."""
    linear = [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in (v / 255 for v in pixel[:3])]
    y = 0.2126729 * linear[0] + 0.7151522 * linear[1] + 0.0721750 * linear[2]
    return 116 * y ** (1 / 3) - 16 if y > (6 / 29) ** 3 else y * (29 / 3) ** 3


class HeatmapTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="slabcast_heatmap_")
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def run_cli(self, *arguments, mask=""):
        return subprocess.run([SLABCAST, "render", *map(str, arguments)], cwd=self.folder, text=True, timeout=120,
                              env={**os.environ, "SLABCAST_MASK_EXTENSIONS": mask}, capture_output=True)

    def draws(self, *arguments):
        """The picture's rows of pixels and the statistics."""
        run = self.run_cli(*SCENE, *SIZE, "-o", "h.png", "--stats", "h.json", *arguments)
        self.assertEqual(run.returncode, 0, run.stderr)
        png = files.Png((self.folder / "h.png").read_bytes())
        self.assertEqual((png.width, png.height), (WIDTH, HEIGHT))
        rows = [[row[3 * x:3 * x + 3] for x in range(WIDTH)] for row in png.rows]
        return rows, json.loads((self.folder / "h.json").read_text())

    def bar(self, rows, quantity, stats):
        """The scale's colours: between `QUANTITY per pixel 0` and the number of the maximum."""
        left = 4 + 6 * len(quantity + " per pixel") + 4 + 6 + 4
        right = WIDTH - 4 - 6 * len(f"{stats['heatmap']['maximum']:.0f}") - 4
        return rows[STRIP + 4 + 3][left:right]

    def test_lightness_of_the_scale_grows_evenly_from_black_to_white(self):
        rows, stats = self.draws("--heatmap", "layers")
        bar = self.bar(rows, "layers", stats)
        self.assertGreater(len(bar), 300)
        for k, pixel in enumerate(bar):
            self.assertAlmostEqual(lightness(pixel), 100 * (k + 0.5) / len(bar), delta=LIGHTNESS_ERROR)
        # The text beside it is there and is no part of it.
        strip = rows[STRIP + 4:STRIP + 11]
        for first, last in ((4, 100), (len(bar) + 114, WIDTH)):
            self.assertGreater(sum(bytes(p) == b"\xff\xff\xff" for row in strip for p in row[first:last]), 20)

    def test_pixels_say_what_the_counters_count(self):
        for quantity, counters in SUMS.items():
            all_ways = (("--skip", "none"), ("--stereo", "60"), ("--order", "front-to-back"), ("--skip", "proximity"))
            for way in all_ways if quantity == "iterations" else all_ways[-1:]:
                rows, stats = self.draws("--heatmap", quantity, *way)
                heat = stats["heatmap"]
                self.assertEqual(heat["quantity"], quantity)
                self.assertEqual(heat["sum"], sum(stats["counters"][name] for name in counters), way)
                self.assertGreater(heat["sum"], 0)
                lit = [lightness(pixel) for row in rows[:STRIP] for pixel in row if any(pixel)]
                read = sum(lit) / 100 * heat["maximum"]
                self.assertAlmostEqual(read, heat["sum"],
                                       delta=LIGHTNESS_ERROR / 100 * heat["maximum"] * len(lit))
                self.assertEqual(max(bytes(pixel) for row in rows[:STRIP] for pixel in row), b"\xff\xff\xff")

    def test_scales(self):
        costs = {}
        for scale, maximum in (("absolute", lambda stats: stats["plan"]["layers"]), ("200", lambda stats: 200)):
            rows, stats = self.draws("--heatmap", "layers", "--heatmap-scale", scale)
            self.assertEqual(stats["heatmap"]["maximum"], maximum(stats))
            costs[scale] = sum(lightness(pixel) for row in rows[:STRIP] for pixel in row) * maximum(stats)
        self.assertAlmostEqual(costs["absolute"], costs["200"], delta=0.02 * costs["200"])
        rows, stats = self.draws("--heatmap", "layers", "--heatmap-scale", "0.5")  # all are beyond its end
        self.assertEqual({bytes(pixel) for row in rows[:STRIP] for pixel in row}, {b"\0\0\0", b"\xff\xff\xff"})

    def test_light_in_exr_and_pictures_too_small_for_words(self):
        for arguments in (("-o", "h.exr", *SIZE), ("-o", "h.png", "--size", "16x16"), ("-o", "h.png", "--size", "1x1")):
            run = self.run_cli(*SCENE, *arguments, "--heatmap", "fetches")
            self.assertEqual(run.returncode, 0, run.stderr)
            self.assertGreater((self.folder / arguments[1]).stat().st_size, 0)

    def test_what_cannot_be(self):
        for arguments, cause, mask, status in (
                (("--heatmap-scale", "absolute"), "--heatmap", "", 2),
                (("--heatmap", "layers", "--heatmap-scale", "0"), "normalised, absolute or a number from", "", 2),
                (("--heatmap", "heat"), "one of off, iterations, fetches, layers", "", 2),
                (("--heatmap", "layers"), "GL_EXT_float_blend", "GL_EXT_float_blend", 1)):
            run = self.run_cli(*SCENE, "-o", "none.png", *arguments, mask=mask)
            self.assertEqual(run.returncode, status, run.stderr)
            self.assertRegex(run.stderr, rf"\Aslabcast[^\n]*{cause}[^\n]*\n\Z")
            self.assertFalse((self.folder / "none.png").exists())


if __name__ == "__main__":
    SLABCAST = sys.argv.pop(1)
    unittest.main()
