#!/usr/bin/env python3
"""The command line where it cannot do what it is told: exit status, one line, no file touched.

usage: cli_refusals_test.py SLABCAST [arguments of unittest]
"""

import json
import os
import re
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "support"))
import cli_files as files  # noqa: E402
from cli_case import PHANTOM, POINT, QUICK, RATIO, CliTest, main  # noqa: E402


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
            "four.nrrd": (files.nrrd("8 8 4 2", spacings="1 1 1 1"), "2 volumes over time", "--time"),
            "two.nrrd": (files.nrrd("8 64", spacings="1 1"), "2 dimensions", "stack"),
            "four.nii": (files.nifti((8, 8, 4, 2)), "2 volumes over time", "--time"),
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
        def renders(cases):
            return [(("v.raw", "--raw", layout), cause, remedy) for layout, cause, remedy in cases]
        self.renders_fail(renders((
            ("8x8x8,uint8,1x1x1", "has 100 bytes.* take 512", "correct the layout"),
            ("4x4x4,uint8,1x1x1", "has 100 bytes.* take 64: 36 are left over", "--skip-bytes 36"),
            ("2000000x2000000x2000000,uint8,1x1x1", "8000000000000000000", "correct the layout"))))
        example = "as 256x256x128,uint16,1x1x1.5"
        self.renders_fail(renders((
            ("8x8x8", "--raw: .*'8x8x8'", example),
            ("8x8,uint8,1x1x1", "--raw: .*2 dimensions where a volume has three", example),
            ("8x0x8,uint8,1x1x1", "--raw: .*has 0 voxels", "at least one"),
            ("8x8x8,uint12,1x1x1", "--raw: .*uint12", "uint8"),
            ("8x8x8,uint8,1x0x1", "--raw: .*spacing", "positive"),
            ("8x8x8,uint8,1xnanx1", "--raw: .*spacing", "positive"))), status=2)

    def test_places_without_a_volume(self):
        (self.folder / "empty").mkdir()
        self.write("letters/a.txt", "Dear reader")
        self.write("v.nrrd", files.nrrd())
        cases = (("missing.nrrd", "no such file", "check the path"),
                 ("v.nrrd/below.nrrd", "no such file", "check the path"),
                 ("empty", "holds no files", "name a folder"),
                 ("letters", "holds no DICOM images", "name a folder"))
        self.renders_fail([((place,), f"{place}: {cause}", remedy) for place, cause, remedy in cases])

    def test_pipes_and_devices(self):
        os.mkfifo(self.folder / "pipe.nrrd")
        self.renders_fail([((place,), f"{place}: is no regular file", "write") for place in ("/dev/zero", "pipe.nrrd")])

    def test_one_of_two_dicom_series_is_to_be_named(self):
        for series in ("1.2.3.7", "1.2.3.8"):
            for z in range(3):
                self.write(f"head/{series}_{z}.dcm", files.dicom(series, z))
        line = self.render_fails("head", cause="holds 2 DICOM series", remedy="--series")
        self.assertIn("1.2.3.7", line)
        self.assertIn("1.2.3.8", line)
        self.assertRegex(self.succeeds("info", "head", "--series", "1.2.3.8"), "8 x 8 x 3, int16")
        self.render_fails("head", "--series", "1.2.3.9", cause="no series 1.2.3.9", remedy="--series may be .*1.2.3.7",
                          status=2)

    def test_dicom_slice_that_is_cut_short(self):
        for z in range(3):
            self.write(f"head/{z}.dcm", files.dicom("1.2.3.7", z)[:-40 if z == 1 else None])
        self.render_fails("head", cause="head/1.dcm", remedy="again")

    def test_phantoms_that_cannot_be(self):
        self.renders_fail([((name,), cause, remedy) for name, cause, remedy in (
            ("phantom:nosuch", "'nosuch'", "marschner-lobb"),
            ("phantom:", "''", "marschner-lobb"),
            ("phantom:shells:-3", "'-3'", "give"),
            ("phantom:shells:2x2", "'2x2'", "give"),
            ("phantom:shells:many", "'many'", "give"))], status=2)
        self.render_fails("phantom:shells:0", cause="0", remedy="at least one")
        self.render_fails("phantom:ramp:100000", cause="100000", remedy="ask for 1024")

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
            "unknown_unit": (tf({}, unit="Hu"), "unit: 'Hu' is not known", "known are HU, and range"),
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

    def test_a_unit_that_is_not_the_volumes_is_said(self):
        """A phantom's values have no unit. The picture is drawn all the same."""
        self.write("hu.json", json.dumps({"unit": "HU", "points": [POINT, {**POINT, "value": 1}]}))
        self.picture(PHANTOM, "--tf", "hu.json", *QUICK,
                     notes=r"slabcast: hu\.json: its values are in HU, the volume's in no unit[^\n]*\n")
        self.write("hu.nrrd", files.nrrd().replace(b"\n\n", b"\nunit:=HU\n\n", 1))
        self.picture("hu.nrrd", "--tf", "hu.json", *QUICK)

    def test_a_file_relative_to_the_data_draws_what_its_preset_draws(self):
        presets = Path(__file__).resolve().parents[2] / "assets" / "transfer_functions"
        for name in ("mr", "angio", "linear"):
            self.assertEqual(self.picture("phantom:vessels:32", *QUICK, "--tf", presets / f"{name}.json"),
                             self.picture("phantom:vessels:32", *QUICK, "--tf", name), name)

    def test_names_that_lead_nowhere(self):
        (self.folder / "folder.json").mkdir()
        self.render_fails(PHANTOM, "--tf", "gold", cause="--tf: 'gold' is not", remedy="ct-bone.*json", status=2)
        self.renders_fail([((PHANTOM, "--tf", "gold.json"), "gold.json", "check the path"),
                           ((PHANTOM, "--tf", "folder.json"), "folder.json", "check|name")])


class BadOutputs(CliTest):
    def test_places_that_take_no_file(self):
        self.write("file", "kept")
        (self.folder / "folder.png").mkdir()
        (self.folder / "full.png").symlink_to("/dev/full")
        def renders(cases):
            return [(("render", PHANTOM, *QUICK, flag, name, other, "good.png"), f"{name}: .*{cause}", remedy)
                    for flag, other, name, cause, remedy in cases]
        self.all_fail(renders((("-o", "--stats", "no/such/p.png", "no folder no/such", "make it"),
                               ("-o", "--stats", "file/p.png", "no folder file", "make it"),
                               ("-o", "--stats", "folder.png", "not a file", "name a file"),
                               ("-o", "--stats", "full.png", "not a file", "name a file"),
                               ("--stats", "-o", "no/s.json", "no folder no", "make it"),
                               ("--stats", "-o", "folder.png", "not a file", "name a file"))))
        self.all_misused([(("render", PHANTOM, *QUICK, "-o", name), f"--output: '{name}' is not .*png or .exr")
                          for name in ("p.jpg", "p")])
        self.all_misused([(("render", PHANTOM, *QUICK, "-o", "good.png", "--stats", "./good.png"),
                           "--stats: ./good.png .*both.*another name")])

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
        self.render_fails(*budget, "--downsample", fitting - 1, cause="110592 bytes", remedy="--downsample 3$")
        self.assertEqual(self.stats(*budget, *QUICK, "--downsample", fitting)["volume"]["dims"], [16, 16, 16])

    def test_budget_is_asked_before_a_file_is_read(self):
        """As of phantoms. Of 8 GiB, which the test could not read in time: all of it is a hole of the disk."""
        elsewhere = tempfile.NamedTemporaryFile()  # the files of the folder are compared
        self.addCleanup(elsewhere.close)
        elsewhere.truncate(2048 ** 3)
        huge = (elsewhere.name, "--raw", "2048x2048x2048,uint8,1x1x1", "--gpu-budget", "1000")
        self.render_fails(*huge, cause="8589934592 bytes.*1048576000", remedy="--downsample 3$")
        self.render_fails(*huge, "--downsample", "2", cause="8589934592 bytes", remedy="--downsample 3$")
        self.fails("error", *huge, "--out", "report", cause="8589934592 bytes", remedy="--downsample 3$")
        # What fits once it is smaller is read.
        (self.folder / "small.raw").write_bytes(bytes(range(64)) * 1000)
        small = ("small.raw", "--raw", "40x40x40,uint8,1x1x1", "--gpu-budget", "0.01")
        self.render_fails(*small, cause="64000 bytes", remedy="--downsample 2$")
        self.assertEqual(self.stats(*small, *QUICK, "--downsample", "2")["volume"]["dims"], [20, 20, 20])

    def test_budget_counts_what_is_uploaded(self):
        """A cube of 48 has 442368 bytes as colours of four, 110592 as voxels, and 55296 as colours of half the edge."""
        budget = ("phantom:shells:48", "--gpu-budget", "0.2")  # 209715 bytes
        self.picture(*budget, *QUICK)
        pre = (*budget, "--classify", "preclassified")
        self.render_fails(*pre, cause="442368 bytes.*209715", remedy="--downsample 2$")
        self.assertEqual(self.stats(*pre, *QUICK, "--downsample", "2")["memory"]["gpu_volume_bytes"], 55296)


if __name__ == "__main__":
    main(__doc__)
