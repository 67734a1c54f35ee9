#!/usr/bin/env python3
"""Pictures against kept ones: every axis, colour and unit from a volume's formula to the PNG file, at once.

usage: golden_test.py SLABCAST [--update]      golden/README.md says what each picture shows and why its bounds are so
"""

import json
import os
import shutil
import subprocess
import sys
import tempfile
import unittest
import zlib
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from struct import pack

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "support"))
from cli_files import Png  # noqa: E402

SLABCAST = None  # the program, from the command line
MOBILE_STRICT = {"SLABCAST_MASK_EXTENSIONS": "mobile-strict",
                 "MESA_EXTENSION_OVERRIDE": "-GL_EXT_texture_norm16 -GL_OES_texture_float_linear"}


@dataclass(frozen=True)
class Golden:
    """One kept picture: what is drawn, how far another driver may be from it in 1/255, what must be further off."""
    volume: str
    points: tuple  # of the transfer function: value, red, green, blue, opacity
    unit_mm: float
    camera: tuple  # azimuth, elevation, distance
    options: dict
    max_difference: int
    mean_difference: float
    spoilt: dict  # options that change the picture; None leaves one out
    handed: bool = True  # the volume is not its own mirror image

    def function(self, unit_factor=1.0):
        return {"opacityUnitMm": self.unit_mm * unit_factor,
                "points": [{"value": p[0], "color": p[1:4], "opacity": p[4]} for p in self.points]}

    def exceeds(self, difference):
        return difference[0] > self.max_difference or difference[1] > self.mean_difference


# Planes, layers and form are given, so that neither a measurement nor the device decides.
GOLDENS = {
    "vessels": Golden(
        "phantom:vessels:64", ((300, .8, .1, .1, 0), (1500, .95, .35, .2, .15), (3000, 1, .9, .7, .3)), 2.0,
        (25, 15, 1.8), {"size": "112x112", "shade": "phong", "planes": 4, "layers": 112, "form": "loop"},
        max_difference=8, mean_difference=0.1, spoilt={"shade": None}),
    "shells": Golden(
        "phantom:shells:32x24x20",
        ((0, .35, .55, .9, .15), (50, .35, .55, .9, .05), (85, .3, .9, .4, .35), (170, 1, .85, .2, .45),
         (255, 1, .25, .15, .9)), 4.0,
        (30, 25, 2.6), {"size": "96x96", "shade": "phong", "classify": "preclassified", "planes": 4, "layers": 48,
                        "form": "unrolled"},
        max_difference=8, mean_difference=0.5, spoilt={"classify": "post", "shade": None}, handed=False),
    "marschner-lobb": Golden(
        "phantom:marschner-lobb:40",
        ((.3, .1, .3, .9, 0), (.5, .2, .8, .4, .1), (.8, 1, .5, .1, .4), (1, 1, .9, .8, .6)), 2.0,
        (-35, 30, 3), {"size": "96x96", "space": "linear", "background": "305080", "planes": 6, "layers": 72,
                       "form": "unrolled"},
        max_difference=4, mean_difference=0.1, spoilt={"space": None}, handed=False),
    "stereo": Golden(
        "phantom:vessels:64", ((300, .2, .4, .9, 0), (1500, .3, .8, .8, .15), (3000, 1, 1, .9, .3)), 2.0,
        (-50, 20, 1.8), {"size": "192x96", "stereo": 10, "lattice": "shells", "target": "rgba16f",
                         "background": "202830", "planes": 4, "layers": 96, "form": "unrolled"},
        max_difference=4, mean_difference=0.1, spoilt={"lattice": None}),
}


class Folder:
    """Where pictures of one golden are drawn."""

    def __init__(self, name):
        self.golden = GOLDENS[name]
        self.path = Path(tempfile.mkdtemp(prefix=f"slabcast_golden_{name}_"))

    def draw(self, name="got", camera=None, unit_factor=1.0, environment=None, **changed):
        """The picture's file. `changed` replaces options of the golden, or with None leaves them out."""
        function, picture = self.path / f"{name}.json", self.path / f"{name}.png"
        function.write_text(json.dumps(self.golden.function(unit_factor)))
        options = {"tf": function, **self.golden.options, **changed,
                   "camera": ",".join(map(str, camera or self.golden.camera))}
        arguments = [f"--{option}={value}" for option, value in options.items() if value is not None]
        run = subprocess.run([SLABCAST, "render", self.golden.volume, "-o", picture, *arguments], text=True,
                             timeout=120, capture_output=True, env={**os.environ, **(environment or {})})
        if run.returncode:
            raise RuntimeError(f"{name}: {run.stderr}")
        return picture

    def draw_all(self, variants):
        """Files by name, of the changes that draw() takes by name."""
        with ThreadPoolExecutor(os.cpu_count()) as pool:
            return dict(zip(variants, pool.map(lambda item: self.draw(item[0], **item[1]), variants.items())))


def rows_of(path):
    """Rows of RGB triples."""
    png = Png(path.read_bytes())
    assert png.channels == 3, path
    return [[row[x:x + 3] for x in range(0, len(row), 3)] for row in png.rows]


def mirrored(rows):
    return [row[::-1] for row in rows]


def eyes_swapped(rows):
    half = len(rows[0]) // 2
    return [row[half:] + row[:half] for row in rows]


def channels(rows):
    return b"".join(pixel for row in rows for pixel in row)


def difference(rows, others):
    """The largest and the mean difference of a channel."""
    if len(rows) != len(others) or len(rows[0]) != len(others[0]):
        return 255, 255.0
    steps = [abs(a - b) for a, b in zip(channels(rows), channels(others))]
    return max(steps), sum(steps) / len(steps)


def save_difference(path, rows, others):
    """A PNG file of what differs, 16 times as bright."""
    def chunk(kind, body):
        return pack(">I", len(body)) + kind + body + pack(">I", zlib.crc32(kind + body))

    lines = [b"\0" + bytes(min(255, 16 * abs(a - b)) for a, b in zip(b"".join(row), b"".join(other)))
             for row, other in zip(rows, others)]
    header = pack(">IIBBBBB", len(lines[0]) // 3, len(lines), 8, 2, 0, 0, 0)
    path.write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(b"".join(lines)))
                     + chunk(b"IEND", b""))


def kept(name):
    return HERE / f"{name}.png"


class GoldenTest(unittest.TestCase):
    def folder(self, name):
        folder = Folder(name)
        self.addCleanup(shutil.rmtree, folder.path, ignore_errors=True)
        return folder

    def expect_close(self, name, picture, label):
        """Else keeps the picture and what is different in a folder that the message names."""
        golden, rows, wanted = GOLDENS[name], rows_of(picture), rows_of(kept(name))
        off = difference(rows, wanted)
        if golden.exceeds(off):
            folder = Path(tempfile.mkdtemp(prefix=f"slabcast_golden_failed_{name}_"))
            shutil.copy(picture, folder / "got.png")
            save_difference(folder / "diff.png", rows, wanted)
            self.fail(f"{name}, {label}: off by at most {off[0]}, on average {off[1]:.3f}; allowed are "
                      f"{golden.max_difference} and {golden.mean_difference}. See got.png and diff.png in {folder}")

    def test_pictures_are_the_kept_ones(self):
        for name in GOLDENS:
            with self.subTest(name):
                self.expect_close(name, self.folder(name).draw(), "as it is kept")

    def test_other_ways_to_the_same_picture_stay_within_the_bounds(self):
        for name, golden in GOLDENS.items():
            other_form = "loop" if golden.options["form"] == "unrolled" else "unrolled"
            pictures = self.folder(name).draw_all({
                "the other form": {"form": other_form},
                "twice the planes": {"form": "loop", "planes": 2 * golden.options["planes"]},
                "mobile-strict": {"environment": MOBILE_STRICT},
            })
            for label, picture in pictures.items():
                with self.subTest(name, way=label):
                    self.expect_close(name, picture, label)

    def test_skipping_and_tight_planes_change_no_byte(self):
        for name in GOLDENS:
            pictures = self.folder(name).draw_all({
                "got": {"skip": "proximity"},
                "skip none": {"skip": "none"},
                "tighten off": {"tighten": "off"},
                "neither": {"skip": "none", "tighten": "off"},
            })
            for label, picture in pictures.items():
                with self.subTest(name, way=label):
                    self.assertEqual(picture.read_bytes(), pictures["got"].read_bytes())

    def test_spoilt_pictures_are_told_apart(self):
        for name, golden in GOLDENS.items():
            azimuth, elevation, distance = golden.camera
            drawn = self.folder(name).draw_all({
                "azimuth 2 degrees more": {"camera": (azimuth + 2, elevation, distance)},
                "elevation 2 degrees less": {"camera": (azimuth, elevation - 2, distance)},
                "2 % further away": {"camera": (azimuth, elevation, 1.02 * distance)},
                "opacity unit 5 % longer": {"unit_factor": 1.05},
                "opacity unit 5 % shorter": {"unit_factor": 1 / 1.05},
                "from the other side": {"camera": (-azimuth, elevation, distance)},
                **{f"{option} {value}": {option: value} for option, value in golden.spoilt.items()},
            })
            pictures = {label: rows_of(picture) for label, picture in drawn.items()}
            wanted = rows_of(kept(name))
            pictures["picture mirrored"] = mirrored(wanted)
            pictures["picture upside down"] = wanted[::-1]
            pictures["red for blue"] = [[pixel[::-1] for pixel in row] for row in wanted]
            if golden.handed:  # a volume mirrored in x is this, the lamp being at the eye
                pictures["volume mirrored"] = mirrored(pictures["from the other side"])
            if "stereo" in golden.options:
                pictures["eyes swapped"] = eyes_swapped(wanted)
            for label, rows in pictures.items():
                with self.subTest(name, spoilt=label):
                    off = difference(rows, wanted)
                    self.assertTrue(golden.exceeds(off), f"{name}, {label}: passes, off by {off[0]} and {off[1]:.3f}")


def update():
    for name in GOLDENS:
        folder = Folder(name)
        shutil.copy(folder.draw(), kept(name))
        shutil.rmtree(folder.path)
        print(f"{kept(name)}: {kept(name).stat().st_size} bytes; look at it before it is kept")


if __name__ == "__main__":
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    SLABCAST = str(Path(sys.argv.pop(1)).resolve())
    if "--update" in sys.argv[1:]:
        update()
    else:
        unittest.main()
