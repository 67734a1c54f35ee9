#!/usr/bin/env python3
"""The command line as a process: its exit status, what it says, and which files it leaves.

usage: cli_test.py SLABCAST [arguments of unittest]
"""

import csv
import itertools
import json
import math
import os
import re
import shlex
import shutil
import struct
import subprocess
import sys
import tempfile
import unittest
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent / "support"))
import cli_files as files  # noqa: E402

SLABCAST = None  # the program, from the command line
REPORT = Path(__file__).resolve().parent.parent / "perf" / "report.py"
PHANTOM = "phantom:shells:24"
RATIO = ("--layers", "16", "--planes", "4")  # what is given is not measured
QUICK = ("--size", "32x32", *RATIO)
COMMANDS = ("render", "sweep", "error", "stability", "info", "device")
POINT = {"value": 0, "color": [1, 1, 1], "opacity": 0.5}


class CliTest(unittest.TestCase):
    def setUp(self):
        self.folder = Path(tempfile.mkdtemp(prefix="slabcast_cli_"))
        self.addCleanup(shutil.rmtree, self.folder)

    def write(self, name, content):
        path = self.folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content.encode() if isinstance(content, str) else content)
        return name

    def run_cli(self, *arguments, env=None, limit=""):
        """`limit`: shell commands that narrow what the process may do."""
        shell = ("sh", "-c", limit + '; exec "$0" "$@"') if limit else ()
        return subprocess.run([*shell, SLABCAST, *map(str, arguments)], cwd=self.folder, text=True, timeout=120,
                              env={**os.environ, **(env or {})}, capture_output=True)

    def kept(self):
        """Every file of the folder and what is in it."""
        return {path.relative_to(self.folder): path.read_bytes() for path in self.folder.rglob("*") if path.is_file()}

    def succeeds(self, *arguments, notes="", **options):
        run = self.run_cli(*arguments, **options)
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertRegex(run.stderr, rf"\A{notes}\Z")
        return run.stdout

    def all_fail(self, cases, status=1, **options):
        """Of each (arguments, cause, remedy): the exit status, and one line with both. Every file stays as it was."""
        before = self.kept()
        with ThreadPoolExecutor(os.cpu_count()) as pool:
            runs = list(pool.map(lambda case: self.run_cli(*case[0], **options), cases))
        for (arguments, cause, remedy), run in zip(cases, runs):
            with self.subTest(arguments):
                self.assertEqual(run.returncode, status, run.stderr)
                self.assertEqual(run.stdout, "")
                self.assertRegex(run.stderr, r"\Aslabcast[^\n]*: [^\n]+\n\Z")
                self.assertRegex(run.stderr, cause)
                self.assertRegex(run.stderr, remedy)
        self.assertEqual(self.kept(), before)
        return runs[0].stderr

    def fails(self, *arguments, cause, remedy, **options):
        return self.all_fail([(arguments, cause, remedy)], **options)

    def renders_fail(self, cases, **options):
        """all_fail(), of renders that would replace a picture and statistics."""
        self.write("out.png", "a picture")
        self.write("out.json", "statistics")
        render = ("render", "-o", "out.png", "--stats", "out.json", *QUICK)
        return self.all_fail([((*render, *arguments), cause, remedy) for arguments, cause, remedy in cases], **options)

    def render_fails(self, *arguments, cause, remedy, **options):
        return self.renders_fail([(arguments, cause, remedy)], **options)

    def all_misused(self, cases):
        """Of each (arguments, cause): exit status 2, and one line with the cause and where to read on."""
        self.all_fail([(arguments, cause, r"'slabcast.* --help'") for arguments, cause in cases], status=2)

    def picture(self, *arguments, **options):
        """The PNG file's bytes."""
        self.succeeds("render", "-o", "p.png", *arguments, **options)
        return (self.folder / "p.png").read_bytes()

    def sparse(self):
        """A scene that is mostly empty: a ball in a larger box, under a function that has air."""
        solid = {"points": [{**POINT, "value": 100, "opacity": 0}, {**POINT, "value": 255}]}
        self.write("solid.json", json.dumps(solid))
        return "phantom:sphere:48", "--tf", "solid.json", "--size", "64x64", "--layers", "64", "--planes", "4"

    def stats(self, *arguments):
        self.picture("--stats", "s.json", *arguments)
        return json.loads((self.folder / "s.json").read_text())


class BadVolumes(CliTest):
    def test_volumes_that_lie_or_are_cut_short(self):
        gz, nii, half = files.packed(files.ramp()), files.nifti(), len(files.ramp()) // 2
        again = "fetch the file again|correct the"
        cases = {
            "cut.nrrd": (files.nrrd(data=files.ramp()[:half]), "512 bytes", again),
            "cut_gz.nrrd": (files.nrrd(encoding="gzip", data=gz[:-12]), "end early or are damaged", again),
            "cut.nii.gz": (files.packed(nii)[:-20], "end early or are damaged|cannot be read", again),
            "cut.nii": (files.nifti()[:500], "512 bytes", again),
            "header_only.nii": (files.nifti()[:200], "header", "again|check|export"),
            "lies.nrrd": (files.nrrd("800 800 800"), "512000000 bytes", again),
            "type.nrrd": (files.nrrd(kind="quaternion"), "type 'quaternion'", "convert"),
            "type.nii": (files.nifti(kind=32, bits=64), "type", "convert"),
            "zero.nrrd": (files.nrrd("8 0 8"), "dimension of 0", "export"),
            "four.nrrd": (files.nrrd("8 8 4 2", spacings="1 1 1 1"), "4 dimensions", "extract"),
            "two.nrrd": (files.nrrd("8 64", spacings="1 1"), "2 dimensions", "stack"),
            "four.nii": (files.nifti((8, 8, 4, 2)), "4 dimensions", "extract"),
            "spacing_0.nrrd": (files.nrrd(spacings="1 0 1"), "spacing of axis 1 is 0", "correct the header"),
            "spacing_nan.nrrd": (files.nrrd(spacings="1 1 nan"), "spacing of axis 2 is nan", "correct the header"),
            "spacing_nan.nii": (files.nifti(spacings=(1, float("nan"), 1)), "spacing", "correct the header"),
            "huge.nrrd": (files.nrrd("2000000 2000000 2000000"), "8000000000000000000 bytes", again),
            "huger.nrrd": (files.nrrd("9" * 30 + " 2 2"), "axis 0 has 9223372036854775807", "check the file's header"),
            "noise.nrrd": (b"\x07\x13" * 300, "NRRD", "check|export|again"),
            "empty.nii.gz": (b"", "NIfTI|empty|header", "check|export|again"),
            "noise.tif": (b"\x07\x13" * 300, "TIFF", "check"),
            "letter.txt": ("Dear reader", "no known format", r"--raw"),
        }
        for name, (content, _, _) in cases.items():
            self.write(name, content)
        self.renders_fail([((name,), rf"{name}: .*({cause})", remedy) for name, (_, cause, remedy) in cases.items()])

    def test_layouts_of_plain_voxels(self):
        self.write("v.raw", files.ramp()[:100])
        cases = (("8x8x8,uint8,1x1x1", "has 100 bytes.* take 512", "correct the layout"),
                 ("4x4x4,uint8,1x1x1", "has 100 bytes.* take 64", "correct the layout"),
                 ("8x8x8", "'8x8x8'", "256x256x128"),
                 ("8x8,uint8,1x1x1", "8x8", "three|256x256x128"),
                 ("8x0x8,uint8,1x1x1", "0", "at least"),
                 ("8x8x8,uint12,1x1x1", "uint12", "uint8"),
                 ("8x8x8,uint8,1x0x1", "spacing", "correct|positive"),
                 ("8x8x8,uint8,1xnanx1", "spacing", "correct|positive"),
                 ("2000000x2000000x2000000,uint8,1x1x1", "8000000000000000000", "correct the layout"))
        self.renders_fail([(("v.raw", "--raw", layout), cause, remedy) for layout, cause, remedy in cases])

    def test_places_without_a_volume(self):
        (self.folder / "empty").mkdir()
        self.write("letters/a.txt", "Dear reader")
        self.write("v.nrrd", files.nrrd())
        cases = (("missing.nrrd", "no such file", "check the path"),
                 ("v.nrrd/below.nrrd", "no such file", "check the path"),
                 ("empty", "holds no files", "name a folder"),
                 ("letters", "holds no DICOM images", "name a folder"))
        self.renders_fail([((place,), f"{place}: {cause}", remedy) for place, cause, remedy in cases])

    def test_one_of_two_dicom_series_is_to_be_named(self):
        for series in ("1.2.3.7", "1.2.3.8"):
            for z in range(3):
                self.write(f"head/{series}_{z}.dcm", files.dicom(series, z))
        line = self.render_fails("head", cause="holds 2 DICOM series", remedy="--series")
        self.assertIn("1.2.3.7", line)
        self.assertIn("1.2.3.8", line)
        self.assertRegex(self.succeeds("info", "head", "--series", "1.2.3.8"), "8 x 8 x 3, int16")
        self.render_fails("head", "--series", "1.2.3.9", cause="no series 1.2.3.9", remedy="--series may be .*1.2.3.7")

    def test_dicom_slice_that_is_cut_short(self):
        for z in range(3):
            self.write(f"head/{z}.dcm", files.dicom("1.2.3.7", z)[:-40 if z == 1 else None])
        self.render_fails("head", cause="head/1.dcm", remedy="again")

    def test_phantoms_that_cannot_be(self):
        cases = (("phantom:nosuch", "'nosuch'", "marschner-lobb"),
                 ("phantom:", "''", "marschner-lobb"),
                 ("phantom:shells:0", "0", "at least one"),
                 ("phantom:shells:-3", "'-3'", "give"),
                 ("phantom:shells:2x2", "'2x2'", "give"),
                 ("phantom:shells:many", "'many'", "give"),
                 ("phantom:ramp:100000", "100000", "ask for 1024"))
        self.renders_fail([((name,), cause, remedy) for name, cause, remedy in cases])

    def test_without_memory_for_the_voxels(self):
        self.fails("info", "phantom:ramp:1024", cause="out of memory", remedy="smaller", limit="ulimit -v 1048576")


class BadTransferFunctions(CliTest):
    def test_files_that_are_refused(self):
        def tf(*points, **more):
            return json.dumps({"points": [{**POINT, **point} for point in points], **more})
        cases = {
            "unsorted": (tf({"value": 2}, {"value": 1}), r"points\[1\]\.value", "sort"),
            "opacity": (tf({}, {"value": 1, "opacity": 1.5}), r"points\[1\]\.opacity.*1\.5", r"0\.\.1|0 to 1"),
            "negative": (tf({"opacity": -0.1}), r"points\[0\]\.opacity.*-0\.1", r"0\.\.1|0 to 1"),
            "colour": (tf({"color": [0, 1.4, 0]}), r"points\[0\]\.color\[1\].*1\.4", r"0\.\.1|0 to 1"),
            "grey": (tf({"color": [0.5]}), r"points\[0\]\.color", "three|3"),
            "text": (tf({"value": "air"}), r"points\[0\]\.value", "number"),
            "unknown": (tf({}, gamma=2), "gamma", "known|remove|leave|name"),
            "unknown_below": (tf({"alpha": 0.5}), r"points\[0\].*alpha", "known|remove|leave|opacity"),
            "unit": (tf({}, opacityUnitMm=0), "opacityUnitMm: 0 is outside", r"1e-06\.\.1000000"),
            "empty": (tf(), "points", "at least|one"),
            "list": ("[]", "object|points", "points|object|write"),
            "malformed": ('{"points": [{"value": 2,', "line 1", "correct the JSON"),
            "nan": ('{"points": [{"value": NaN}]}', "line 1", "correct the JSON"),
        }
        for name, (text, _, _) in cases.items():
            self.write(name + ".json", text)
        self.renders_fail([((PHANTOM, "--tf", name + ".json"), rf"{name}\.json: .*({cause})", remedy)
                           for name, (_, cause, remedy) in cases.items()])

    def test_names_that_lead_nowhere(self):
        (self.folder / "folder.json").mkdir()
        self.renders_fail([((PHANTOM, "--tf", "gold"), "'gold'", "ct-bone.*json"),
                           ((PHANTOM, "--tf", "gold.json"), "gold.json", "check the path"),
                           ((PHANTOM, "--tf", "folder.json"), "folder.json", "check|name")])


class BadOutputs(CliTest):
    def test_places_that_take_no_file(self):
        self.write("file", "kept")
        (self.folder / "folder.png").mkdir()
        (self.folder / "full.png").symlink_to("/dev/full")
        cases = (("-o", "--stats", "no/such/p.png", "no folder no/such", "make it"),
                 ("-o", "--stats", "file/p.png", "no folder file", "make it"),
                 ("-o", "--stats", "folder.png", "not a file", "name a file"),
                 ("-o", "--stats", "full.png", "not a file", "name a file"),
                 ("-o", "--stats", "p.jpg", "png or .exr", "name that ends"),
                 ("-o", "--stats", "p", "png or .exr", "name that ends"),
                 ("--stats", "-o", "no/s.json", "no folder no", "make it"),
                 ("--stats", "-o", "folder.png", "not a file", "name a file"),
                 ("--stats", "-o", "./good.png", "both", "another name"))
        self.all_fail([(("render", PHANTOM, *QUICK, flag, name, other, "good.png"), f"{name}: .*{cause}", remedy)
                       for flag, other, name, cause, remedy in cases])

    def test_disk_that_fills_up_while_writing(self):
        """A limit on the size of files stands in for it: writing fails at one block, once its signal is ignored."""
        noisy = ("render", "phantom:vessels:32", "--size", "200x200", *RATIO)
        self.write("old.png", "an older picture")
        self.write("old.exr", "an older picture")
        self.all_fail([((*noisy, "-o", name), f"{name}: .*(too large|write)", "space left")
                       for name in ("new.png", "old.png", "new.exr", "old.exr")],
                      limit="ulimit -f 1; trap '' XFSZ", env={"MESA_SHADER_CACHE_DISABLE": "true"})


class BadDevices(CliTest):
    def test_devices_that_cannot_draw(self):
        driver = self.succeeds("device")
        if "Mesa" not in driver:
            self.skipTest("only Mesa can be told to be less than it is")
        for env in ({"GALLIUM_DRIVER": "softpipe", "LIBGL_ALWAYS_SOFTWARE": "1"},  # has GLES 3.1
                    {"MESA_GLES_VERSION_OVERRIDE": "3.1"},
                    {"LIBGL_DRIVERS_PATH": "/nonexistent", "GBM_BACKENDS_PATH": "/nonexistent"},
                    {"__EGL_VENDOR_LIBRARY_DIRS": "/nonexistent"}):
            with self.subTest(env):
                self.render_fails(PHANTOM, env=env, cause="no GLES 3.2 context", remedy="install .*GLES 3.2")
        self.fails("device", env={"MESA_GLES_VERSION_OVERRIDE": "3.1"}, cause="no GLES 3.2 context", remedy="install")

    def test_budget_names_the_downsampling_that_fits(self):
        """A cube of 48 has 110592 voxels of a byte, a third of the edge 4096, and half of it 13824."""
        budget = ("phantom:shells:48", "--gpu-budget", "0.01")  # 10485 bytes
        line = self.render_fails(*budget, cause="110592 bytes.*10485", remedy=r"--downsample \d+")
        fitting = int(re.search(r"--downsample (\d+)", line).group(1))
        self.assertEqual(fitting, 3)
        self.render_fails(*budget, "--downsample", fitting - 1, cause="13824 bytes", remedy="--downsample")
        self.assertEqual(self.stats(*budget, *QUICK, "--downsample", fitting)["volume"]["dims"], [16, 16, 16])

    def test_budget_counts_what_is_uploaded(self):
        """A cube of 48 has 442368 bytes as colours of four, 110592 as voxels, and 55296 as colours of half the edge."""
        budget = ("phantom:shells:48", "--gpu-budget", "0.2")  # 209715 bytes
        self.picture(*budget, *QUICK)
        pre = (*budget, "--classify", "preclassified")
        self.render_fails(*pre, cause="442368 bytes.*209715", remedy="--downsample 2$")
        self.assertEqual(self.stats(*pre, *QUICK, "--downsample", "2")["memory"]["gpu_volume_bytes"], 55296)


class BadUsage(CliTest):
    def test_values_that_options_do_not_take(self):
        bad = {
            "--size": ("32", "0x5", "32x32x32", "99999x2"),
            "--planes": ("-1", "many", "1.5", "99999999999999999999"), "--layers": ("0",), "--frames": ("0",),
            "--camera": ("1,2", "nan,2,3", "1,2,inf", "1,2,-1"), "--fov": ("180", "nan"), "--stereo": ("-1", "nan"),
            "--background": ("red", "+12345"), "--layer-spacing": ("0", "nan"), "--termination": ("0", "2", "nan"),
            "--skip": ("octopus",), "--skip-block": ("3",), "--downsample": ("0",), "--gpu-budget": ("nan",),
        }
        self.all_misused([(("render", PHANTOM, "-o", "p.png", flag, word), f"{flag}: '{re.escape(word)}' is not .+")
                          for flag, words in bad.items() for word in words])

    def test_commands_that_are_incomplete_or_unknown(self):
        self.all_misused(((("render", PHANTOM), "--output is required"),
                          (("render", "-o", "p.png"), "VOLUME is required"),
                          (("render", PHANTOM, "-o"), "--output"),
                          (("render", PHANTOM, "-o", "p.png", "--colour"), "--colour"),
                          (("sweep", PHANTOM), "--out is required"),
                          (("sweep", PHANTOM, "--out", "d", "--layers", "1,x"), "--layers: '1,x'"),
                          (("error", PHANTOM), "--out is required"),
                          (("error", PHANTOM, "--out", "d", "--layer-spacing", "1,0"), "--layer-spacing: '1,0'"),
                          (("error", PHANTOM, "--out", "d", "--classify", "post,best"), "--classify: 'post,best'"),
                          (("error", PHANTOM, "--out", "d", "--termination", ""), "--termination"),
                          (("render", PHANTOM, "-o", "p.png", "--target-error", "0.1", "--planes", "2"),
                           "--planes excludes --target-error"),
                          (("render", PHANTOM, "-o", "p.png", "--verify", "--shade", "phong"), "--verify.*shading"),
                          (("render", PHANTOM, "-o", "p.png", "--target-error", "0.1", "--shade", "phong"),
                           "--target-error.*shading"),
                          (("error", PHANTOM, "--out", "d", "--shade", "phong"), "--shade"),
                          (("error", PHANTOM, "--out", "d", "--frames", "2"), "--frames: '2'"),
                          (("paint",), "paint"),
                          (("info",), "VOLUME is required"),
                          (("device", "2"), "2")))

    def test_no_command_answers_with_the_help(self):
        run = self.run_cli()
        self.assertEqual((run.returncode, run.stdout), (2, ""))
        for command in COMMANDS:
            self.assertRegex(run.stderr, rf"(?m)^  {command} ")


class Help(CliTest):
    def test_every_command_explains_itself(self):
        for command in COMMANDS:
            with self.subTest(command):
                text = self.succeeds(command, "--help")
                self.assertIn(f"slabcast {command}", text)
                self.assertRegex(text, r"(?m)^Example: .+\n  (\w+=\S+ )?slabcast " + command)
                for line in text.splitlines():
                    self.assertLessEqual(len(line), 100)
        self.assertIn("slabcast render phantom:", self.succeeds("--help"))
        self.assertIn("--termination", self.succeeds("--help-all"))

    def test_defaults_are_shown(self):
        text = " ".join(self.succeeds("render", "--help").split())
        for default in ("1024x1024", "0,10,2.5", "40", "planar", "display", "auto", "rgba8", "000000"):
            self.assertIn(f"(default: {default})", text)
        self.assertRegex(text, r"--termination .+ \(default: 0\.99\d+\)")


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

    def test_turning_the_camera_changes_the_picture(self):
        self.assertNotEqual(self.picture(PHANTOM, *QUICK), self.picture(PHANTOM, *QUICK, "--camera", "-30,80,2"))

    def test_every_word_of_every_option_draws(self):
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


class Statistics(CliTest):
    KEYS = {
        "device": {"renderer", "vendor", "version", "software"},
        "plan": {"planes", "layers", "layersPerPlane", "termination", "order", "planesPerMark", "variant", "reasons"},
        "frame_ms": {"median", "min", "max", "n"},
        "counters": {"fragments", "layers_evaluated", "layers_skipped", "volume_fetches", "skip_fetches", "stretches",
                     "blocks_visited"},
        "volume": {"name", "dims", "type", "spacingMm", "bytes"},
    }

    def test_keys_are_stable(self):
        stats = self.stats(PHANTOM, *QUICK)
        for part, keys in self.KEYS.items():
            self.assertLessEqual(keys, set(stats[part]), part)
        plan = stats["plan"]
        self.assertEqual((plan["planes"], plan["layersPerPlane"], plan["layers"]), (4, 4, 16))
        self.assertEqual(stats["volume"]["dims"], [24, 24, 24])
        self.assertEqual(stats["volume"]["bytes"], 24 ** 3)
        times = stats["frame_ms"]
        self.assertTrue(0 < times["min"] <= times["median"] <= times["max"])

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

    def test_explain_gives_reasons_and_the_measured_ratio_is_the_fastest(self):
        text = self.succeeds("render", PHANTOM, "-o", "p.png", "--size", "64x64", "--layers", "16", "--explain")
        for what in ("texels", "layers 16", "ratio", "skip", "classification"):
            self.assertRegex(text, rf"(?m)^{what}.*: .+")
        line = re.search(r"(?m)^ratio ([^:]+): fastest of those measured on this device: (.+)$", text)
        chosen, measured = line.groups()
        times = {name: float(ms) for name, ms in re.findall(r"(\d+x\d+ \w+) ([\d.e-]+) ms", measured)}
        self.assertGreaterEqual(len(times), 3)
        self.assertEqual(times[chosen], min(times.values()))


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
        total = sweep["conditions"]["totalLayers"]
        for skip in ("none", "proximity"):
            self.assertEqual({row["layersPerPlane"] for row in rows if row["skip"] == skip}, {*self.LAYERS, total})
        for row in rows:
            self.assertGreaterEqual(row["planes"] * row["layersPerPlane"], total)
            self.assertEqual(row["frameMs"]["n"], 2)
            self.assertAlmostEqual(row["frameMs"]["median"], (row["frameMs"]["min"] + row["frameMs"]["max"]) / 2)
            self.assertIs(row["jitter"], False)
            self.assertTrue((folder / row["thumbnail"]).is_file())

        with open(folder / "sweep.csv", newline="", encoding="utf-8") as file:
            table = list(csv.DictReader(file))
        self.assertEqual(len(table), len(rows))
        for line, row in zip(table, rows):
            self.assertEqual((int(line["planes"]), int(line["layersPerPlane"]), line["skip"]),
                             (row["planes"], row["layersPerPlane"], row["skip"]))
            self.assertEqual(int(line["layers_evaluated"]), row["counters"]["layers_evaluated"])
            self.assertEqual((float(line["frame_ms_median"]), line["jitter"]), (row["frameMs"]["median"], "false"))

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


class Accuracy(CliTest):
    """One small grid of a smooth field, measured once for all tests."""

    SPACINGS, LAYERS, TARGETS = (2, 1, 0.5, 0.25), (1, 0), ("rgba8", "rgba16f")
    GRID = ("error", "phantom:marschner-lobb:32", "--size", "48x48", "--out", "err", "--frames", "3",
            "--layer-spacing", "2,1,0.5,0.25", "--layers-per-plane", "1,0", "--classify", "post",
            "--termination", "off", "--jitter", "off")
    PARTS = ("total", "sampling", "table", "gpu")
    NO_COMMIT = "starts anew, as this program was built from sources that no commit names"
    PAGE = r"[^\n]*report\.html\n"

    @classmethod
    def setUpClass(cls):
        cls.measured = Path(tempfile.mkdtemp(prefix="slabcast_accuracy_"))
        cls.addClassCleanup(shutil.rmtree, cls.measured)
        cls.env = {"XDG_CACHE_HOME": str(cls.measured / "cache")}
        subprocess.run([SLABCAST, *cls.GRID], cwd=cls.measured, env={**os.environ, **cls.env}, check=True,
                       capture_output=True, timeout=120)
        cls.report = json.loads((cls.measured / "err" / "error.json").read_text())
        cls.resumes = not cls.report["commit"].endswith("-dirty")

    def copied(self):
        """Rows of the measured report, in a folder of this test's own."""
        shutil.copytree(self.measured / "err", self.folder / "err")
        return self.folder / "err" / "rows.jsonl"

    def table(self):
        (path,) = (self.measured / "cache" / "slabcast").iterdir()
        return path

    def rows(self, **where):
        return [row for row in self.report["rows"] if all(row[key] == value for key, value in where.items())]

    def test_every_setting_is_a_row_with_all_that_was_measured(self):
        settings = [(row["spacing"], row["layers"], row["target"]) for row in self.rows()]
        self.assertEqual(len(settings), len(set(settings)))
        self.assertEqual(set(settings), {(s, n, t) for s in self.SPACINGS for n in self.LAYERS for t in self.TARGETS})
        for key in ("command", "commit", "date", "device", "volume", "conditions", "axes", "reference"):
            self.assertTrue(self.report[key], key)
        for row in self.rows():
            self.assertEqual(row["ratio"], {1: "slicing", 0: "ray casting"}[row["layers"]])
            self.assertEqual(row["frameMs"]["n"], 3)
            self.assertTrue(self.report["started"] <= row["date"] <= self.report["date"])
            self.assertGreater(row["counters"]["volume_fetches"], 0)
            for picture in ("thumbnail", "difference"):
                files.Png((self.measured / "err" / row["pictures"][picture]).read_bytes())
        with open(self.measured / "err" / "error.csv", newline="", encoding="utf-8") as file:
            table = list(csv.DictReader(file))
        self.assertEqual([(line["id"], float(line["rmse"]), line["command"]) for line in table],
                         [(row["id"], row["error"]["total"]["rmse"], row["command"]) for row in self.rows()])

    def test_parts_add_up_as_distances_do(self):
        """Total is the distance between the ends of a path of three: no longer than it, no shorter than its detours."""
        for row in self.rows():
            total, *parts = (row["error"][part]["rmse"] for part in self.PARTS)
            self.assertLessEqual(total, sum(parts) * (1 + 1e-12))
            self.assertGreaterEqual(total, (2 * max(parts) - sum(parts)) * (1 - 1e-12))

    def test_error_falls_with_the_spacing_squared(self):
        rays = self.rows(target="rgba16f", layers=0)  # what is blended once is rounded once
        totals = [row["error"]["total"]["rmse"] for row in rays]
        self.assertEqual([row["spacing"] for row in rays], list(self.SPACINGS))
        self.assertEqual(totals, sorted(totals, reverse=True))
        self.assertAlmostEqual(rays[-1]["order"]["sampling"], 2.0, delta=0.25)  # midpoints of a smooth field
        coarse, fine = (row["error"]["sampling"]["rmse"] for row in rays[-2:])
        self.assertAlmostEqual(rays[-1]["order"]["sampling"], math.log2(coarse / fine), places=9)
        self.assertEqual((rays[0]["coarser"], rays[1]["coarser"]), (None, rays[0]["id"]))
        self.assertEqual(set(rays[0]["order"].values()), {None})

    def test_rounding_of_eight_bits_grows_with_the_planes(self):
        gpu = [row["error"]["gpu"]["rmse"] for row in self.rows(target="rgba8", layers=1)]
        self.assertGreater(gpu[-1], 2 * gpu[0])

    def test_fronts_hold_what_nothing_beats(self):
        costs = {"front": lambda row: row["frameMs"]["median"],
                 "frontByFetches": lambda row: row["counters"]["volume_fetches"] + row["counters"]["skip_fetches"]}
        for name, cost in costs.items():
            places = [(cost(row), row["error"]["total"]["rmse"]) for row in self.rows()]

            def beaten(place):
                return any(other != place and other[0] <= place[0] and other[1] <= place[1] for other in places)
            front = [places[index] for index in self.report[name]]
            self.assertEqual(front, sorted({place for place in places if not beaten(place)}))

    def test_the_command_of_a_row_draws_it(self):
        for row in (self.rows()[0], self.rows()[-1]):
            command = row["command"].split()
            self.assertEqual(command[0], "slabcast")
            text = self.succeeds(*command[1:], "--verify", "--stats", "s.json")
            self.assertRegex(text, r"(?m)^error: RMSE ")
            stats = json.loads((self.folder / "s.json").read_text())
            self.assertEqual(stats["plan"]["planes"], row["plan"]["planes"])
            for key, value in row["error"]["total"].items():
                self.assertAlmostEqual(stats["error"][key], value, places=9)

    def test_a_run_goes_on_where_one_was_cut_short(self):
        if not self.resumes:
            self.skipTest("only a build of committed sources goes on")
        finished = self.copied()
        lines = finished.read_text().splitlines(keepends=True)
        kept, cut = lines[:-2], json.loads(lines[-1])["id"]
        finished.write_text("".join([*kept, lines[-2], lines[-1][:40]]))
        self.succeeds(*self.GRID, env=self.env, notes=rf"slabcast: err: {len(kept)} rows [^\n]* are kept\n{self.PAGE}")
        again = json.loads((self.folder / "err" / "error.json").read_text())["rows"]
        for before, after in zip(self.rows(), again, strict=True):
            self.assertEqual(before["error"], after["error"])
            if before["id"] != cut:
                self.assertEqual(before, after)
        written = finished.stat().st_mtime_ns
        self.succeeds(*self.GRID, env=self.env, notes=rf"slabcast: err: {len(kept) + 1} rows [^\n]* kept\n{self.PAGE}")
        self.assertEqual(finished.stat().st_mtime_ns, written)
        self.assertEqual(json.loads((self.folder / "err" / "error.json").read_text())["rows"], again)

    def test_other_settings_start_anew(self):
        self.copied()
        anew = "holds rows that differ in camera: starts anew" if self.resumes else self.NO_COMMIT
        self.succeeds(*self.GRID[:-6], "--classify", "post", "--target", "rgba8", "--jitter", "off", "--termination",
                      "off", "--camera", "40,10,3", env=self.env,
                      notes=rf"slabcast: err: {anew}\n{self.PAGE}")
        rows = json.loads((self.folder / "err" / "error.json").read_text())["rows"]
        self.assertEqual(len(rows), len(self.SPACINGS) * len(self.LAYERS))
        self.assertNotIn(rows[0]["error"]["total"], [row["error"]["total"] for row in self.rows()])

    def own_cache(self):
        return {"XDG_CACHE_HOME": str(self.folder / "cache")}

    def one_row(self, volume, *more, **axes):
        """The arguments of a run that measures a single row, but for the axes that are given."""
        axes = {"size": "16x16", "layer-spacing": 2, "layers-per-plane": 0, "classify": "post", "target": "rgba8",
                "termination": "off", "jitter": "off", **{name.replace("_", "-"): axes[name] for name in axes}}
        return ("error", volume, "--out", "err", "--frames", "3", *more,
                *(word for name, value in axes.items() for word in (f"--{name}", value)))

    def new_report(self):
        return json.loads((self.folder / "err" / "error.json").read_text())

    def test_damaged_stores_start_anew(self):
        finished = self.copied()
        key, first, *others = finished.read_text().splitlines()
        measured = json.loads(first)
        grid = self.one_row(self.GRID[1], size="48x48", layer_spacing=measured["spacing"], target=measured["target"],
                            layers_per_plane=measured["layers"])
        reference = self.folder / "err" / "reference.f64"
        header, pixels = reference.read_bytes().split(b"\n", 1)

        def spoilt(**members):
            return "\n".join((key, json.dumps({**measured, **members}), *others))
        stores = (spoilt(frameMs=3), spoilt(frameMs={"median": "3"}), spoilt(pictures={"thumbnail": 1}),
                  spoilt(pictures=[]), spoilt(error=None), spoilt(counters={}), spoilt(spacing="1"), spoilt(id=1),
                  spoilt(date=None), "\n".join((key, "7", first)), "7\n" + first, "", "{\n")
        headers = (json.dumps({**json.loads(header), "seconds": "1"}).encode(), b"[]", b"", header)
        anew = r"rows\.jsonl is damaged: starts anew" if self.resumes else self.NO_COMMIT
        for k, rows in enumerate(stores):
            with self.subTest(k):
                finished.write_text(rows)
                reference.write_bytes(headers[k % len(headers)] + b"\n" + pixels[:-8])
                self.succeeds(*grid, env=self.own_cache(), notes=rf"slabcast: err: {anew}\n{self.PAGE}")
                (row,) = self.new_report()["rows"]
                self.assertEqual((row["id"], row["error"]), (measured["id"], measured["error"]))

    def test_where_a_length_holds_all_layers_ray_casting_is_kept(self):
        self.succeeds(*self.one_row("phantom:marschner-lobb:16", layers_per_plane="64,0"), env=self.own_cache(),
                      notes=self.PAGE)
        (row,) = self.new_report()["rows"]
        self.assertEqual((row["layers"], row["ratio"]), (0, "ray casting"))

    def test_a_classification_that_does_not_fit_is_left_out(self):
        """A cube of 48 has 442368 bytes as colours of four, and 110592 as voxels."""
        too_much = ("phantom:shells:48", "--gpu-budget", "0.2")
        self.succeeds(*self.one_row(*too_much, classify="preclassified,post"), env=self.own_cache(), notes=self.PAGE)
        report = self.new_report()
        self.assertEqual([row["classification"] for row in report["rows"]], ["post"])
        (left,) = report["leftOut"]
        self.assertEqual(left["classification"], "preclassified")
        self.assertRegex(left["why"], "442368 bytes.*--downsample 2")
        self.assertIn("442368 bytes", (self.folder / "err" / "report.html").read_text())
        self.assertEqual(self.report["leftOut"], [])
        shutil.rmtree(self.folder / "err")
        run = self.run_cli(*self.one_row(*too_much, classify="preclassified"), env=self.own_cache())
        self.assertEqual(run.returncode, 1)
        self.assertRegex(run.stderr, r"\Aslabcast: [^\n]*442368 bytes[^\n]*\n\Z")

    def test_the_table_holds_what_a_plain_render_keeps(self):
        """Rows under other conditions stay out, and so do those of builds of another commit."""
        shutil.copytree(self.measured / "cache", self.folder / "cache")
        table = self.folder / "cache" / "slabcast" / self.table().name
        before = table.read_bytes()
        for conditions in ("--skip none", "--skip-block 8", "--tighten off", "--lattice shells", "--form loop",
                           "--exact"):
            with self.subTest(conditions):
                shutil.rmtree(self.folder / "err", ignore_errors=True)
                self.succeeds(*self.one_row("phantom:marschner-lobb:16", *conditions.split()), env=self.own_cache(),
                              notes=rf"{self.PAGE}slabcast: the table for --target-error is left as it was[^\n]*\n")
                self.assertEqual(table.read_bytes(), before)
        rows = json.loads(before)["rows"]
        self.assertEqual({row["commit"] for row in rows}, {self.report["commit"]})
        rows[0]["commit"] = "0000000"
        table.write_text(json.dumps({**json.loads(before), "rows": rows}))
        shutil.rmtree(self.folder / "err")
        self.succeeds(*self.one_row("phantom:marschner-lobb:16"), env=self.own_cache(), notes=self.PAGE)
        *old, new = json.loads(table.read_text())["rows"]
        self.assertEqual(old, rows[1:])
        self.assertRegex(new["volume"], "16x16x16$")

    def test_the_table_tells_volumes_and_functions_of_one_name_apart(self):
        def put(points, data):
            self.write("v.nrrd", files.nrrd(data=data))
            self.write("tf.json", json.dumps({"name": "one", "points": points}))

        def measured_with():
            explained = self.succeeds("render", "v.nrrd", "--tf", "tf.json", "-o", "p.png", "--size", "16x16",
                                      "--explain", "--target-error", "1", env=self.own_cache())
            return re.search(r"(?m)^target error .* with (.+)$", explained).group(1)
        points, ramp = [{**POINT, "opacity": 0}, {**POINT, "value": 255}], files.ramp()
        put(points, ramp)
        self.succeeds(*self.one_row("v.nrrd", "--tf", "tf.json"), env=self.own_cache(), notes=self.PAGE)
        self.assertEqual(measured_with(), "this volume and transfer function")
        put([points[0], {**POINT, "value": 254}], ramp)
        self.assertEqual(measured_with(), "other scenes")
        put(points, bytes([9]) + ramp[1:])
        self.assertEqual(measured_with(), "other scenes")

    def test_a_table_that_cannot_be_read_is_left_alone(self):
        table = self.folder / self.write(f"cache/slabcast/{self.table().name}", "{}")
        self.succeeds(*self.one_row("phantom:marschner-lobb:16"), env=self.own_cache(),
                      notes=rf"{self.PAGE}slabcast: [^\n]*no table of measured errors[^\n]*delete it[^\n]*\n")
        self.assertEqual(table.read_text(), "{}")
        self.assertEqual(len(self.new_report()["rows"]), 1)

    def test_a_target_takes_the_cheapest_row_that_reaches_it(self):
        scene = ("render", "phantom:marschner-lobb:32", "-o", "p.png", "--size", "48x48", "--explain", "--verify")
        target = 1.5 * min(row["error"]["total"]["rmse"] for row in self.rows())
        reach = [row for row in self.rows() if row["error"]["total"]["rmse"] <= target]
        best = min(reach, key=lambda row: row["frameMs"]["median"])
        text = self.succeeds(*scene, "--target-error", repr(target), env=self.env)
        self.assertRegex(text, rf"(?m)^target error .*{best['target']}, a layer every {best['spacing']:g} voxels, .*"
                               r"measured with this volume and transfer function$")
        self.assertAlmostEqual(float(re.search(r"(?m)^error: RMSE ([\d.e-]+)", text).group(1)),
                               best["error"]["total"]["rmse"], delta=1e-6)
        other = ("render", "phantom:ramp:16", "-o", "p.png", "--size", "32x32", "--explain", "--target-error", "0.5")
        self.assertRegex(self.succeeds(*other, env=self.env), r"(?m)^target error .* with other scenes$")

    def test_what_cannot_be_measured_or_reached(self):
        bad = self.measured / "bad"
        shutil.copytree(self.measured / "cache" / "slabcast", bad / "slabcast", dirs_exist_ok=True)
        for table in (bad / "slabcast").iterdir():
            table.write_text('{"version": 1, "rows": [{"volume": 3}]}')
        self.write("p.png", "a picture")
        target = ("render", "phantom:marschner-lobb:32", "-o", "p.png", "--target-error", "1e-9")
        self.fails(*target, env=self.env, cause="reaches an RMSE of 1e-09: the best is", remedy="slabcast error")
        self.fails(*target, env={"XDG_CACHE_HOME": str(self.measured / "none")}, cause="no errors were measured",
                   remedy="slabcast error")
        self.fails(*target, env={"XDG_CACHE_HOME": str(bad)}, cause="error-table-.*no table", remedy="delete it")
        self.fails("error", "missing.nrrd", "--out", "d", cause="missing.nrrd", remedy="check the path")


if __name__ == "__main__":
    if len(sys.argv) < 2 or not os.access(sys.argv[1], os.X_OK):
        sys.exit(__doc__)
    SLABCAST = str(Path(sys.argv.pop(1)).resolve())
    unittest.main()
