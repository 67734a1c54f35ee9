#!/usr/bin/env python3
"""The command line's own words: bad usage, and the help.

usage: cli_usage_test.py SLABCAST [arguments of unittest]
"""

import re
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "support"))
from cli_case import PHANTOM, QUICK, CliTest, main  # noqa: E402
from report_keys import key_of  # noqa: E402

COMMANDS = ("render", "sweep", "error", "stability", "skipbench", "edit", "info", "device")


class BadUsage(CliTest):
    def test_values_that_options_do_not_take(self):
        bad = {
            "--size": ("32", "0x5", "32x32x32", "99999x2"),
            "--planes": ("-1", "many", "1.5", "99999999999999999999"), "--layers": ("0",), "--frames": ("0",),
            "--camera": ("1,2", "nan,2,3", "1,2,inf", "1,2,-1"), "--fov": ("180", "nan"), "--stereo": ("-1", "nan"),
            "--background": ("red", "+12345", "#12345", "##123456"), "--layer-spacing": ("0", "nan"), "--termination": ("0", "2", "nan"),
            "--tf": ("",), "--series": ("",), "--unit": ("",),
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
                           "--target-error: excludes --planes"),
                          (("render", PHANTOM, "-o", "p.png", "--verify", "--shade", "phong"), "--verify.*shading"),
                          (("render", PHANTOM, "-o", "p.png", "--target-error", "0.1", "--shade", "phong"),
                           "--target-error.*shading"),
                          (("error", PHANTOM, "--out", "d", "--shade", "phong"), "--shade"),
                          (("error", PHANTOM, "--out", "d", "--frames", "2"), "--frames: '2'"),
                          (("paint",), "paint"),
                          (("info",), "VOLUME is required"),
                          (("device", "2"), "2"),
                          (("device", "--device", "g7"), "--device: 'g7' is not one of g71, "),
                          (("render", PHANTOM, "-o", "p.png", "--device", ""), "--device: '' is not one of g71, ")))

    def test_a_variable_that_names_no_device(self):
        self.all_fail([(arguments, "SLABCAST_DEVICE: 'G71' is not", "one of g71, ")
                       for arguments in (("device",), ("render", PHANTOM, "-o", "p.png", *QUICK))],
                      status=2, env={"SLABCAST_DEVICE": "G71"})

    def test_files_of_settings_that_hold_none(self):
        bad = {"text.json": ("layers: 4", "is no JSON"), "list.json": ("[1]", "holds no settings"),
               "other.json": ('{"no_such": 1}', "no_such: is no setting"), "value.json": ('{"layers": 0}', "layers: '0' is not .+")}
        for name, (content, _) in bad.items():
            self.write(name, content)
        self.all_misused([(("render", PHANTOM, "-o", "p.png", "--settings", name), f"--settings: {name}: {cause}")
                          for name, (_, cause) in (*bad.items(), ("missing.json", ("", "no such file of settings; check the path")))])

    def test_options_that_would_do_nothing(self):
        """Each is refused by name, with what makes it idle."""
        self.write("v.nrrd", "no volume; nothing reads it")
        render, edit = ("render", PHANTOM, "-o", "p.png"), ("edit", PHANTOM, "--out", "d")
        self.all_misused((
            ((*render, "--layers", "9", "--layer-spacing", "2"), "--layers: excludes --layer-spacing"),
            ((*render, "--planes", "2", "--layers-per-plane", "2"), "--planes: excludes --layers-per-plane"),
            ((*render, "--frames", "5"), "--frames: does nothing without --stats"),
            ((*render, "--heatmap-scale", "9"), "--heatmap-scale: does nothing without --heatmap"),
            ((*render, "--heatmap", "layers", "--background", "none"), "--heatmap: excludes --background"),
            ((*render, "--raw", "8x8x8,uint8,1x1x1"), f"--raw: does nothing beside {PHANTOM}"),
            ((*render, "--series", "1.2"), f"--series: does nothing beside {PHANTOM}"),
            (("info", "v.nrrd", "--series", "1.2"), "--series: does nothing beside v.nrrd"),
            (("info", "v", "--raw", "8x8x8,uint8,1x1x1", "--series", "1.2"), "--raw: excludes --series"),
            ((*render, "--partition-budget", "9"), "--partition-budget: is of partitioned; --skip is auto"),
            ((*render, "--shade", "phong", "--classify", "preintegrated"), "pre-integrated .*shading"),
            ((*edit, "--script", "s.json", "--tf", "mr"), "--script: excludes --tf"),
            ((*edit, "--script", "s.json", "--interpolate", "mr,angio"), "--script: excludes --interpolate"),
            ((*edit, "--script", "s.json", "--frames", "30"), "--script: excludes --frames"),
            ((*edit, "--interpolate", "mr,angio", "--tf", "mr"), "--interpolate: excludes --tf"),
            ((*edit, "--work", "3", "--skip", "bitfield-octree"), "--work: does nothing beside --skip bitfield-octree"),
            ((*edit, "--quiet", "3", "--skip", "minmax-octree"), "--quiet: does nothing beside --skip minmax-octree"),
        ))

    def test_settings_that_only_the_volume_decides_are_bad_usage_too(self):
        self.all_fail([(("render", PHANTOM, "-o", "p.png", "--size", "32x32", "--layers", "99", "--planes", "1", "--form",
                         "unrolled"), "segments of 99 layers", "at most 64")], status=2)

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

    def test_every_setting_is_an_option_and_in_the_statistics(self):
        """docs/settings.md lists the table; a unit test holds it to that."""
        page = (Path(__file__).resolve().parents[2] / "docs" / "settings.md").read_text()
        names = re.findall(r"(?m)^\| `([a-z-]+)` \|", page)
        self.assertGreater(len(names), 20)
        text = self.succeeds("render", "--help")
        for name in names:
            self.assertRegex(text, rf"(?m)^  --{name} ")
        held = self.stats(PHANTOM, *QUICK)["settings"]
        self.assertEqual(set(held), set(map(key_of, names)))
        self.assertEqual((held["layers"], held["planes"], held["jitter"], held["classify"]), (16, 4, False, "post"))

    def test_a_colour_may_have_its_sign(self):
        self.assertEqual(self.picture(PHANTOM, *QUICK, "--background", "#ff8000"),
                         self.picture(PHANTOM, *QUICK, "--background", "ff8000"))

    def test_defaults_are_shown(self):
        text = " ".join(self.succeeds("render", "--help").split())
        for default in ("1024x1024", "0,10,2.5", "40", "display", "auto", "rgba8", "000000"):
            self.assertIn(f"(default: {default})", text)
        self.assertRegex(text, r"--termination .+ \(default: 0\.99\d+\)")


if __name__ == "__main__":
    main(__doc__)
