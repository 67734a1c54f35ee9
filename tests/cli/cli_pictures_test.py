#!/usr/bin/env python3
"""Pictures, statistics and sweeps of the command line as a process.

usage: cli_pictures_test.py SLABCAST [arguments of unittest]
"""

import csv
import json
import os
import re
import shlex
import struct
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "support"))
import cli_files as files  # noqa: E402
from cli_case import PHANTOM, QUICK, RATIO, CliTest, main  # noqa: E402
from report_keys import key_of, odd_keys  # noqa: E402

ROOT = Path(__file__).resolve().parent.parent.parent
SETTINGS = ROOT / "docs" / "settings.md"
REPORT, DOCUMENTED = ROOT / "perf" / "pages" / "report.py", ROOT / "docs" / "reports.md"


class Pictures(CliTest):
    def test_png_is_of_the_size_and_shows_something(self):
        png = files.Png(self.picture(PHANTOM, "--size", "48x32", *RATIO))
        self.assertEqual((png.width, png.height, png.channels), (48, 32, 3))
        self.assertEqual(png.pixel(0, 0), (0, 0, 0))
        self.assertGreater(max(png.pixel(24, 16)), 10)

    def test_exr_is_of_the_size(self):
        self.succeeds("render", PHANTOM, "-o", "p.exr", "--size", "48x32", *RATIO)
        header = files.exr_header((self.folder / "p.exr").read_bytes())
        self.assertEqual(struct.unpack("<4i", header["dataWindow"]), (0, 0, 47, 31))

    def test_background_comes_back_as_it_was_given(self):
        for space in ("display", "linear"):
            with self.subTest(space):
                png = files.Png(self.picture(PHANTOM, *QUICK, "--background", "336699", "--space", space,
                                             "--target", "rgba16f"))
                for got, given in zip(png.pixel(0, 0), (0x33, 0x66, 0x99)):
                    self.assertAlmostEqual(got, given, delta=1)  # half floats hold 11 bits

    def test_without_background_there_is_alpha(self):
        png = files.Png(self.picture(PHANTOM, *QUICK, "--background", "none"))
        self.assertEqual(png.channels, 4)
        self.assertEqual(png.pixel(0, 0), (0, 0, 0, 0))
        self.assertGreater(png.pixel(16, 16)[3], 10)

    def test_stereo_draws_two_eyes_side_by_side(self):
        def halves(ipd):
            png = files.Png(self.picture(PHANTOM, "--size", "64x32", *RATIO, "--stereo", ipd))
            self.assertEqual((png.width, png.height), (64, 32))
            return [[row[eye * 96:eye * 96 + 96] for row in png.rows] for eye in range(2)]
        left, right = halves("8")
        self.assertNotEqual(left, right)
        self.assertTrue(any(map(any, left)) and any(map(any, right)))
        left, right = halves("0")
        self.assertEqual(left, right)

    def test_the_same_command_draws_the_same_picture(self):
        self.assertEqual(self.picture(PHANTOM, *QUICK), self.picture(PHANTOM, *QUICK))

    def test_skipping_changes_nothing(self):
        sparse = self.sparse()
        self.assertEqual(self.picture(*sparse, "--skip", "none"), self.picture(*sparse, "--skip", "proximity"))

    def test_the_first_of_many_frames_is_written(self):
        one = self.picture(PHANTOM, *QUICK)
        self.assertEqual(self.stats(PHANTOM, *QUICK, "--frames", "3")["frame_ms"]["n"], 3)
        self.assertEqual((self.folder / "p.png").read_bytes(), one)

    def test_settings_of_an_earlier_picture_draw_it_again(self):
        size = ("--size", "32x32")
        changed = ("--layers", "48", "--planes", "3", "--jitter", "on", "--space", "linear", "--target", "rgba16f")
        stats = self.stats(PHANTOM, *size, *changed)
        first = (self.folder / "p.png").read_bytes()
        (self.folder / "first.json").write_text(json.dumps(stats))
        self.assertEqual(self.picture(PHANTOM, *size, "--settings", "first.json"), first)
        self.assertNotEqual(self.picture(PHANTOM, *size, *RATIO), first)
        # What is given beside a file goes over it, whichever is named first, and over what it makes useless.
        for order in (("--settings", "first.json", "--layer-spacing", "2"), ("--layer-spacing", "2", "--settings", "first.json")):
            again = self.stats(PHANTOM, *size, *order)["settings"]
            self.assertEqual((again["layers"], again["layer_spacing"], again["planes"]), (None, 2.0, 3))
        (self.folder / "few.json").write_text('{"layers": 48, "planes": 3}')
        self.assertEqual(self.picture(PHANTOM, *size, "--settings", "few.json"), self.picture(PHANTOM, *size, "--layers", "48", "--planes", "3"))

    def test_turning_the_camera_changes_the_picture(self):
        self.assertNotEqual(self.picture(PHANTOM, *QUICK), self.picture(PHANTOM, *QUICK, "--camera", "-30,80,2"))

    # What an option takes effect with; where a word needs another than its option does, the word is named.
    BESIDE = {"--skip-block": "--skip blocks", "--skip-block 64": "--skip minmax-octree",
              "--skip-bits": "--skip bitfield-octree", "--partitions": "--skip partitioned",
              "--separate-minimum": "--skip partitioned", "--traversal": "--skip minmax-octree",
              "--skip-builder": "--skip proximity", "--heatmap-scale": "--heatmap layers"}

    DEALS_LAYERS = ("--layers", "--planes", "--layers-per-plane")  # of which QUICK gives two

    def test_every_word_of_every_option_draws(self):
        text = self.succeeds("render", "--help")
        given = re.findall(r"^  (--[\w-]+) ([\w-]+(?:\|[\w-]+)+)", text, re.MULTILINE)
        words = [(option, word) for option, words in given for word in words.split("|") if not word.isupper()]
        # Written as a list, for its length.
        structures = re.search(r"--skip NAME .*?one of ([^(]+)\(default", text, re.DOTALL)
        words += [("--skip", name) for name in structures[1].replace(",", " ").split()]
        self.assertGreater(len({option for option, _ in words}), 12)
        self.assertLessEqual({("--lattice", "shells"), ("--skip", "bitfield-octree"), ("--order", "front-to-back"),
                              ("--classify", "preintegrated"), ("--skip-block", "64")}, set(words))

        def drawn(option, word):
            file = f"{option}{word}.png"
            beside = self.BESIDE.get(f"{option} {word}", self.BESIDE.get(option, ""))
            quick = QUICK[:2] if option in self.DEALS_LAYERS else QUICK
            run = self.run_cli("render", PHANTOM, "-o", file, *quick, *beside.split(), option, word)
            return run, self.folder / file
        with ThreadPoolExecutor(os.cpu_count()) as pool:
            for (option, word), (run, file) in zip(words, pool.map(lambda pair: drawn(*pair), words)):
                with self.subTest(option=option, word=word):
                    self.assertEqual(run.returncode, 0, run.stderr)
                    self.assertTrue(any(map(any, files.Png(file.read_bytes()).rows)))

    def test_options_draw_together(self):
        for words in ("--lattice shells --form unrolled --shade phong --classify preclassified --skip-block 8",
                      "--exact --space linear --target rgba16f --form loop --termination off --skip proximity",
                      "--tighten off --skip none --shade phong --termination 0.5 --fov 90 --tf linear --camera 0,90,0"):
            with self.subTest(words):
                png = files.Png(self.picture(PHANTOM, *QUICK, *words.split()))
                self.assertTrue(any(map(any, png.rows)))


class Inputs(CliTest):
    def test_the_same_voxels_draw_the_same_from_every_format(self):
        self.write("v.nrrd", files.nrrd())
        self.write("packed.nrrd", files.nrrd(encoding="gzip", data=files.packed(files.ramp())))
        self.write("v.raw", files.ramp())
        plain = self.picture("v.nrrd", *QUICK)
        self.assertEqual(self.picture("packed.nrrd", *QUICK), plain)
        self.assertNotEqual(self.picture("v.raw", "--raw", "8x8x8,uint8,1x1x2", *QUICK), plain)
        self.assertEqual(self.picture("v.raw", "--raw", "8x8x8,uint8,1x1x1", *QUICK), plain)

    def test_info_tells_what_was_written(self):
        self.write("v.nii.gz", files.packed(files.nifti(spacings=(0.5, 1.0, 2.0))))
        text = self.succeeds("info", "v.nii.gz")
        for expected in ("8 x 8 x 8, uint8", "0.5 x 1 x 2 mm, box 4 x 8 x 16 mm", "0 to 224", "mean 112"):
            self.assertIn(expected, text)
        self.assertIn("4 x 4 x 4", self.succeeds("info", "v.nii.gz", "--downsample", "2"))

    def test_voxels_that_are_no_numbers_are_noted(self):
        values = [1.0] * 60 + [float("nan"), float("inf"), float("-inf"), 2.0]
        self.write("v.nrrd", files.nrrd("4 4 4", kind="float", data=struct.pack("<64f", *values)))
        self.picture("v.nrrd", *QUICK, notes=r"slabcast: v.nrrd: 3 voxels are NaN or infinite[^\n]*\n")

    def test_device_names_itself_and_its_formats(self):
        text = self.succeeds("device")
        for expected in ("driver", "3D limit", "r8 ", "r16f", "GL_OVR_multiview2"):
            self.assertIn(expected, text)


class Advice(CliTest):
    """What is said of a picture that is not what a person would expect, one line a cause; nothing of ordinary ones."""

    EDGE = 16

    def ball(self, inside=1.0, outside=0.0, kind="float", code="f", **more):
        """A ball with an edge of two voxels, from `outside`'s place up to `inside`."""
        centre = (self.EDGE - 1) / 2
        def value(i):
            x, y, z = i % self.EDGE, i // self.EDGE % self.EDGE, i // self.EDGE ** 2
            r = ((x - centre) ** 2 + (y - centre) ** 2 + (z - centre) ** 2) ** 0.5
            share = min(1.0, max(0.0, 1.0 - (r - 5.0) / 2.0))
            return inside * share if share > 0 else outside
        values = [value(i) for i in range(self.EDGE ** 3)]
        for at, hot in more.pop("hot", {}).items():
            values[at] = hot
        if code != "f":
            values = [int(v) for v in values]
        return files.nrrd(f"{self.EDGE} " * 2 + str(self.EDGE), kind=kind, data=struct.pack(f"<{len(values)}{code}", *values), **more)

    def drawn(self, content, *arguments, notes="", tf=None):
        """The share of the picture's pixels that are lit."""
        self.write("v.nrrd", content)
        look = ()
        if tf is not None:
            self.write("tf.json", json.dumps({"points": [{"value": v, "color": [1, 1, 1], "opacity": o} for v, o in tf]}))
            look = ("--tf", "tf.json")
        png = files.Png(self.picture("v.nrrd", "--size", "48x48", "--layers", "32", "--planes", "1", *look, *arguments, notes=notes))
        lit = sum(max(png.pixel(x, y)) > 10 for y in range(48) for x in range(48))
        return lit / 48 ** 2

    BALL = (0.04, 0.6)

    def assert_ball(self, share):
        self.assertGreater(share, self.BALL[0])
        self.assertLess(share, self.BALL[1])

    def test_ordinary_pictures_are_silent(self):
        self.assert_ball(self.drawn(self.ball()))
        self.assert_ball(self.drawn(self.ball(1000, kind="short", code="h")))

    def test_hot_voxels_leave_the_default_function_on_the_rest(self):
        laid = r"slabcast: v.nrrd: values reach from 0 to {}, but all except {} lie from 0 to 1000: [^\n]*laid over[^\n]*\n"
        short = dict(inside=1000, kind="short", code="h")
        self.assert_ball(self.drawn(self.ball(**short, hot={0: 32767}), notes=laid.format(32767, "one voxel")))
        self.assert_ball(self.drawn(self.ball(**short, hot={0: 32767, 9: 31000, 99: 20000}), notes=laid.format(32767, "3 voxels")))

    def test_fill_values_are_hidden_or_named(self):
        exact = ("--exact",)
        laid = r"slabcast: v.nrrd: values reach [^\n]*laid over[^\n]*\n"
        fill = r"slabcast: v.nrrd: \d+ voxels hold {}, most likely a fill value[^\n]* 0 {} these\n"
        kept = r"slabcast: v.nrrd: values reach from [^\n]*steps of [^\n]*every value is kept, as by --exact[^\n]*\n"
        tf = ((0.2, 0.0), (0.9, 0.5))
        for value, text in ((9.96921e36, r"9.96921e\+36"), (3.4028234e38, r"3.40282e\+38")):
            content = self.ball(outside=value)
            with self.subTest(value):
                self.drawn(content, tf=tf, notes=fill.format(text, "above") + kept)
                self.assert_ball(self.drawn(content, *exact, notes=laid))
                self.assert_ball(self.drawn(content, *exact, tf=(*tf, (1.0, 0.5), (1.01, 0.0))))
        self.assert_ball(self.drawn(self.ball(outside=-9999), *exact, notes=laid))

    def test_texels_too_coarse_for_what_is_shown(self):
        content, tf = self.ball(hot={0: 1e6}), ((0.2, 0.0), (0.9, 0.5))
        self.assert_ball(self.drawn(content, tf=tf, notes=r"slabcast: v.nrrd: values reach from 0 to 1000000, and [^\n]*steps of 15\.\d[^\n]*every value is kept, as by --exact[^\n]*\n"))
        self.assert_ball(self.drawn(content, "--exact", tf=tf))

    def test_lengths_that_are_no_millimetres(self):
        content = self.ball(spacings="0.001 0.001 0.001")
        self.assertEqual(self.drawn(content, notes=r"slabcast: v.nrrd: opacity is per 1 mm and the box is 0.016 x 0.016 x 0.016 mm: [^\n]*--spacing[^\n]*\n"), 0.0)
        self.assert_ball(self.drawn(content, "--spacing", "1,1,1"))

    def test_nothing_visible(self):
        far = r"slabcast: v.nrrd: nothing from 0 to 1 is visible under this transfer function: {}; [^\n]*--tf linear[^\n]*\n"
        for tf, shows in ((((5000, 0.0), (6000, 0.9)), "it shows values above 5000"),
                          (((-9, 0.5), (-5, 0.0)), "it shows values below -5"),
                          (((5, 0.0), (6, 0.9), (7, 0.0)), "it shows 5 to 7"),
                          (((0, 0.0), (1, 0.0)), "all its opacities are 0")):
            with self.subTest(shows):
                self.assertEqual(self.drawn(self.ball(), tf=tf, notes=far.format(shows)), 0.0)

    def test_one_value_everywhere(self):
        content = files.nrrd(data=bytes([7]) * 512)
        self.drawn(content, tf=((0, 0.5),), notes=r"slabcast: v.nrrd: all voxels hold 7: [^\n]*check[^\n]*\n")
        self.drawn(content, tf=((9, 0.0), (10, 0.5)), notes=r"slabcast: v.nrrd: all voxels hold 7, which is not visible [^\n]*above 9;[^\n]*\n")

    def test_what_the_plan_warns_of(self):
        self.write("v.nrrd", files.nrrd(data=bytes([90, 100] * 256)))
        self.write("tf.json", json.dumps({"points": [{"value": 50, "color": [1, 1, 1], "opacity": 0.01}]}))
        layers = ("--size", "32x32", "--tf", "tf.json", "--layers", "128", "--planes", "128")
        self.picture("v.nrrd", *layers, notes=r"slabcast: even the densest [^\n]*--target rgba16f[^\n]*\n")
        self.picture("v.nrrd", *layers, "--target", "rgba16f")


class Output(CliTest):
    def test_output_that_cannot_be_written_is_a_failure(self):
        for arguments in (("device",), ("--help",), ("info", PHANTOM), ("render", PHANTOM, "-o", "p.png", *QUICK, "--explain")):
            with self.subTest(arguments):
                run = self.run_cli(*arguments, limit="exec >/dev/full")
                self.assertEqual(run.returncode, 1, run.stderr)
                self.assertRegex(run.stderr, r"\Aslabcast: standard output cannot be written \(No space left on device\): [^\n]+\n\Z")

    def test_info_has_all_digits(self):
        def values(kind, code, *all_values):
            self.write("v.nrrd", files.nrrd("2 1 1", kind=kind, data=struct.pack(f"<2{code}", *all_values)))
            return re.search(r"values +(\S+) to (\S+) , mean (\S+),", self.succeeds("info", "v.nrrd")).groups()
        self.assertEqual(values("int", "i", 16777216, 16777223), ("16777216", "16777223", "16777219.5"))
        self.assertEqual(values("float", "f", 1e6, 1000001.0)[:2], ("1000000", "1000001"))
        self.assertEqual(values("float", "f", 0.1, 1e30)[:2], ("0.1", "1e+30"), "the shortest of float32")
        self.assertEqual(values("double", "d", 0.1, 0.1 + 1e-15)[:2], ("0.1", "0.100000000000001"))
        self.assertEqual(values("unsigned char", "B", 0, 255), ("0", "255", "127.5"))

    def test_modality_that_is_guessed_is_said_to_be(self):
        self.write("v.nrrd", files.nrrd("2 1 1", kind="short", data=struct.pack("<2h", -1000, 1000)))
        self.assertIn("CT (guessed from the values), default", self.succeeds("info", "v.nrrd"))
        self.assertIn("unknown, default", self.succeeds("info", PHANTOM))

    def test_masked_extensions_that_are_none(self):
        self.succeeds("device", env={"SLABCAST_MASK_EXTENSIONS": "GL_EXT_nosuch"},
                      notes=r"slabcast: SLABCAST_MASK_EXTENSIONS: this driver has no GL_EXT_nosuch[^\n]*\n")
        self.succeeds("device", env={"SLABCAST_MASK_EXTENSIONS": "mobile-strict"})

    ASSUMED = r"slabcast: what the Mali-G71 can do is assumed, and nothing of it tested; [^\n]+\n"

    def test_a_known_device_is_assumed_and_said_to_be(self):
        report = self.succeeds("device", "--device", "g71", notes=self.ASSUMED)
        for said in ("Mali-G71\n", "  assumed    g71: taken from a table, not asked and tested\n", "texel formats, assumed:\n"):
            self.assertIn(said, report)
        self.assertEqual(self.succeeds("device", env={"SLABCAST_DEVICE": "g71"}, notes=self.ASSUMED), report)
        self.assertIn("Adreno (TM) 740\n", self.succeeds(
            "device", "--device", "adreno740", env={"SLABCAST_DEVICE": "g71"}, notes="slabcast: what the Adreno[^\n]+\n"))
        self.assertNotIn("assumed", self.succeeds("device"))

    def test_statistics_of_an_assumed_device_say_so(self):
        self.succeeds("render", PHANTOM, "-o", "p.png", *QUICK, "--stats", "s.json", "--device", "g71", notes=self.ASSUMED)
        device = json.loads((self.folder / "s.json").read_text())["device"]
        self.assertEqual((device["assumed"], device["renderer"], device["software"]), ("g71", "Mali-G71", False))
        self.assertIn("assumed; what runs is", device["version"])
        self.assertNotIn("assumed", self.stats(PHANTOM, *QUICK)["device"])


class Statistics(CliTest):
    KEYS = {
        "device": {"renderer", "vendor", "version", "software"},
        "plan": {"planes", "layers", "layers_per_plane", "termination", "order", "planes_per_mark", "variant", "reasons"},
        "frame_ms": {"median", "min", "max", "n"},
        "counters": {"fragments", "layers_evaluated", "layers_skipped", "volume_fetches", "skip_fetches", "stretches",
                     "blocks_visited"},
        "volume": {"name", "dims", "type", "spacing_mm", "bytes"},
    }

    def test_keys_are_stable(self):
        stats = self.stats(PHANTOM, *QUICK)
        for part, keys in self.KEYS.items():
            self.assertLessEqual(keys, set(stats[part]), part)
        plan = stats["plan"]
        self.assertEqual((plan["planes"], plan["layers_per_plane"], plan["layers"]), (4, 4, 16))
        self.assertEqual(stats["volume"]["dims"], [24, 24, 24])
        self.assertEqual(stats["volume"]["bytes"], 24 ** 3)
        times = stats["frame_ms"]
        self.assertTrue(0 < times["min"] <= times["median"] <= times["max"])

    def test_every_key_is_documented(self):
        known = set(re.findall(r"`([^`]+)`", DOCUMENTED.read_text(encoding="utf-8")))
        stats = self.stats(PHANTOM, *QUICK, "--heatmap", "layers", "--verify")
        settings = set(re.findall(r"(?m)^\| `([a-z-]+)`", SETTINGS.read_text(encoding="utf-8")))
        self.assertEqual(set(stats.pop("settings")), set(map(key_of, settings)))
        for part in (stats, *stats.values()):
            self.assertLessEqual(set(part) if isinstance(part, dict) else set(), known)

    def test_termination_is_an_opacity_or_off(self):
        for given, named in (("0.25", 0.25), ("off", "off")):
            self.assertEqual(self.stats(*self.sparse(), "--termination", given)["plan"]["termination"], named)

    def test_order_is_as_asked_and_saves_work_front_to_back(self):
        dense = (*self.sparse()[:-1], "16", "--termination", "0.9")  # planes
        orders = {order: self.stats(*dense, "--order", order) for order in ("back-to-front", "front-to-back", "auto")}
        for order in ("back-to-front", "front-to-back"):
            self.assertEqual(orders[order]["plan"]["order"], order)
        counts = {order: stats["counters"]["layers_evaluated"] for order, stats in orders.items()}
        self.assertLess(counts["front-to-back"], 0.9 * counts["back-to-front"])
        self.assertEqual(counts["auto"], counts[orders["auto"]["plan"]["order"]])
        self.assertEqual(self.stats(*self.sparse(), "--termination", "off")["plan"]["order"], "back-to-front")

    def test_skipping_saves_work(self):
        sparse = (*self.sparse(), "--termination", "off")
        without = self.stats(*sparse, "--skip", "none")["counters"]
        skipping = self.stats(*sparse, "--skip", "proximity")["counters"]
        self.assertEqual((without["layers_skipped"], without["skip_fetches"]), (0, 0))
        self.assertGreater(skipping["layers_skipped"], 0)
        self.assertLess(skipping["layers_evaluated"], without["layers_evaluated"])

    def test_explain_gives_reasons(self):
        text = self.succeeds("render", PHANTOM, "-o", "p.png", "--size", "64x64", "--layers", "16", "--explain")
        for what in ("texels", "layers 16", "ratio", "skip", "classification"):
            self.assertRegex(text, rf"(?m)^{what}.*: .+")


class Sweep(CliTest):
    LAYERS = (1, 4, 16)  # and 0: all

    def test_sweep_writes_rows_and_a_page_of_its_own(self):
        self.succeeds("sweep", "phantom:shells:32", "--size", "64x64", "--layers", "1,4,16,0", "--frames", "2",
                      "--out", "out/sweep", notes=r"[^\n]*report\.html\n")
        folder = self.folder / "out" / "sweep"
        sweep = json.loads((folder / "sweep.json").read_text())
        rows = sweep["rows"]
        for key in ("command", "commit", "date", "device", "volume", "conditions", "memory"):
            self.assertTrue(sweep[key], key)
        self.assertEqual(odd_keys(sweep), [])
        total = sweep["conditions"]["total_layers"]
        for skip in ("none", "proximity"):
            self.assertEqual({row["layers_per_plane"] for row in rows if row["skip"] == skip}, {*self.LAYERS, total})
        for row in rows:
            self.assertGreaterEqual(row["planes"] * row["layers_per_plane"], total)
            self.assertEqual(row["frame_ms"]["n"], 2)
            self.assertAlmostEqual(row["frame_ms"]["median"], (row["frame_ms"]["min"] + row["frame_ms"]["max"]) / 2)
            self.assertIs(row["jitter"], False)
            self.assertTrue((folder / row["thumbnail"]).is_file())

        with open(folder / "sweep.csv", newline="", encoding="utf-8") as file:
            table = list(csv.DictReader(file))
        self.assertEqual(len(table), len(rows))
        for line, row in zip(table, rows):
            self.assertEqual((int(line["planes"]), int(line["layers_per_plane"]), line["skip"]),
                             (row["planes"], row["layers_per_plane"], row["skip"]))
            self.assertEqual(int(line["layers_evaluated"]), row["counters"]["layers_evaluated"])
            self.assertEqual((float(line["frame_ms_median"]), line["jitter"]), (row["frame_ms"]["median"], "false"))

        page = folder / "report.html"
        self.assertEqual(re.findall(r"""(?:src|href)\s*=\s*["'](?!data:|#)[^"']*""", page.read_text()), [])
        page.unlink()
        subprocess.run(["/usr/bin/python3", REPORT, folder], check=True, capture_output=True)
        self.assertTrue(page.is_file())

    def test_folders_of_any_name_get_their_page(self):
        for name in ("john's scans", "$(touch x);`y`"):
            self.succeeds("sweep", PHANTOM, "--size", "32x32", "--layers", "4", "--frames", "1", "--out", name,
                          notes=r"[^\n]*report\.html\n")
            self.assertTrue((self.folder / name / "report.html").is_file())
            command = json.loads((self.folder / name / "sweep.json").read_text())["command"]
            self.assertEqual(shlex.split(command)[-1], name)
        self.assertFalse((self.folder / "x").exists())

    def test_sweeps_that_cannot_be(self):
        self.write("file", "kept")
        self.fails("sweep", PHANTOM, "--out", "file/sweep", cause="file/sweep", remedy="give another")
        self.fails("sweep", "missing.nrrd", "--out", "sweep", cause="missing.nrrd", remedy="check the path")


if __name__ == "__main__":
    main(__doc__)
