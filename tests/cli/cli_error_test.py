#!/usr/bin/env python3
"""`slabcast error` as a process, and what `render` makes of its measurements.

usage: cli_error_test.py SLABCAST [arguments of unittest]
"""

import csv
import json
import math
import os
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "support"))
import cli_files as files  # noqa: E402
from cli_case import POINT, CliTest, main  # noqa: E402
from report_keys import odd_keys, undocumented_columns, undocumented_keys  # noqa: E402


class Accuracy(CliTest):
    """One small grid of a smooth field, measured once for all tests."""

    SPACINGS, LAYERS, TARGETS = (2, 1, 0.5, 0.25), (1, 0), ("rgba8", "rgba16f")
    GRID = ("error", "phantom:marschner-lobb:32", "--size", "48x48", "--out", "err", "--frames", "3",
            "--layer-spacing", "2,1,0.5,0.25", "--layers-per-plane", "1,0", "--classify", "post",
            "--termination", "off", "--jitter", "off")
    PARTS = ("total", "sampling", "table", "gpu")
    PAGE = r"[^\n]*report\.html\n"

    @classmethod
    def setUpClass(cls):
        cls.measured = Path(tempfile.mkdtemp(prefix="slabcast_accuracy_"))
        cls.addClassCleanup(shutil.rmtree, cls.measured)
        cls.env = {"XDG_CACHE_HOME": str(cls.measured / "cache")}
        subprocess.run([cls.program, *cls.GRID], cwd=cls.measured, env={**os.environ, **cls.env}, check=True,
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
        settings = [(row["layer_spacing"], row["layers_per_plane"], row["target"]) for row in self.rows()]
        self.assertEqual(len(settings), len(set(settings)))
        self.assertEqual(set(settings), {(s, n, t) for s in self.SPACINGS for n in self.LAYERS for t in self.TARGETS})
        for key in ("command", "commit", "date", "device", "volume", "conditions", "axes", "reference"):
            self.assertTrue(self.report[key], key)
        for row in self.rows():
            self.assertEqual(row["ratio"], {1: "slicing", 0: "ray casting"}[row["layers_per_plane"]])
            self.assertEqual(row["frame_ms"]["n"], 3)
            self.assertTrue(self.report["started"] <= row["date"] <= self.report["date"])
            self.assertGreater(row["counters"]["volume_fetches"], 0)
            for picture in ("thumbnail", "difference"):
                files.Png((self.measured / "err" / row["pictures"][picture]).read_bytes())
        with open(self.measured / "err" / "error.csv", newline="", encoding="utf-8") as file:
            table = list(csv.DictReader(file))
        self.assertEqual([(line["id"], float(line["rmse"]), line["command"]) for line in table],
                         [(row["id"], row["error"]["total"]["rmse"], row["command"]) for row in self.rows()])

    def test_keys_are_lower_camel_in_all_that_is_kept(self):
        kept = [json.loads(line) for line in (self.measured / "err" / "rows.jsonl").read_text().splitlines()]
        reference = (self.measured / "err" / "reference.f64").read_bytes().partition(b"\n")[0]
        for content in (self.report, kept, json.loads(reference), json.loads(self.table().read_text())):
            self.assertEqual(odd_keys(content), [])

    def test_parts_add_up_as_distances_do(self):
        """Total is the distance between the ends of a path of three: no longer than it, no shorter than its detours."""
        for row in self.rows():
            total, *parts = (row["error"][part]["rmse"] for part in self.PARTS)
            self.assertLessEqual(total, sum(parts) * (1 + 1e-12))
            self.assertGreaterEqual(total, (2 * max(parts) - sum(parts)) * (1 - 1e-12))

    def test_bias_and_deviation_make_up_the_error(self):
        for row in self.rows():
            for part in self.PARTS:
                error = row["error"][part]
                self.assertAlmostEqual(error["rmse"] ** 2, error["bias"] ** 2 + error["deviation"] ** 2, places=14)
                self.assertAlmostEqual(error["alpha_rmse"] ** 2,
                                       error["alpha_bias"] ** 2 + error["alpha_deviation"] ** 2, places=14)
                colours = [error[f"{name}_bias"] for name in ("red", "green", "blue")]
                self.assertAlmostEqual(error["bias"], sum(colours) / 3, places=14)
                self.assertTrue(error["max"] > 1 / 255 or error["visible_share"] == 0)
            self.assertTrue(0 <= row["flip"]["mean"] <= row["flip"]["max"] <= 1)
        coarse, fine = self.rows(layers_per_plane=0, target="rgba16f")[::3]
        self.assertGreater(coarse["flip"]["mean"], fine["flip"]["mean"])
        self.assertGreater(coarse["error"]["total"]["visible_share"], fine["error"]["total"]["visible_share"])

    def test_refinement_finds_every_order_and_every_mistake(self):
        studies = self.report["refinement"]["studies"]
        self.assertEqual(self.report["refinement"]["device_refused"], None)
        for study in studies:
            told = (study["kind"], study["method"], study["order"], study["why"])
            self.assertTrue(study["as_expected"], told)
            self.assertEqual(study["looks_right"], not study["control"], told)
        kinds = {(study["kind"], study["control"]) for study in studies}
        self.assertEqual(kinds, {(kind, control) for kind in ("step", "grid", "pixel") for control in (True, False)})
        device = [study["kind"] for study in studies if "device" in study["method"]]
        self.assertEqual(device, ["step", "grid"])
        with open(self.measured / "err" / "refinement.csv", newline="", encoding="utf-8") as file:
            table = list(csv.DictReader(file))
        self.assertEqual([(line["method"], float(line["rmse"])) for line in table],
                         [(study["method"], level["rmse"]) for study in studies for level in study["levels"]])

    def test_columns_and_keys_of_its_own_files_are_documented(self):
        for name in ("refinement.csv", "worst_ray.csv"):
            self.assertEqual(undocumented_columns(self.measured / "err" / name, "error"), [])
        self.assertEqual(undocumented_keys(json.loads((self.measured / "err" / "worst_ray.json").read_text()), "error"),
                         [])

    def test_this_volumes_own_convergence_is_judged(self):
        (family,) = self.report["convergence"]
        self.assertEqual((family["classify"], family["expected_order"]), ("post", 2))
        self.assertEqual([level["rmse"] for level in family["levels"]],
                         [row["error"]["sampling"]["rmse"] for row in self.rows(target="rgba16f", layers_per_plane=0)])
        self.assertEqual(family["as_expected"],
                         family["asymptotic"] and abs(family["order"] - 2) <= 0.2)

    def test_the_worst_ray_is_taken_apart(self):
        ray = json.loads((self.measured / "err" / "worst_ray.json").read_text())
        self.assertEqual({**self.report["worst_ray"], "layers": ray["layers"]}, ray)
        (row,) = (row for row in self.rows() if row["id"] == ray["row"])
        self.assertEqual((row["layer_spacing"], ray["pixel"]), (1, row["worst_pixel"]["pixel"]))
        self.assertEqual(row["worst_pixel"]["error"], row["error"]["total"]["max"])
        for sampled, exact, reference in zip(ray["layers"][-1]["gathered"], ray["exact"], ray["reference"]):
            self.assertAlmostEqual(exact, reference, places=8)  # another path to the same integral
            self.assertLess(abs(sampled - exact), 2 * ray["error"] + 0.01)
        lengths = sum(layer["length_mm"] for layer in ray["layers"])
        self.assertAlmostEqual(lengths, ray["exit_mm"] - ray["entry_mm"], places=6)
        with open(self.measured / "err" / "worst_ray.csv", newline="", encoding="utf-8") as file:
            table = list(csv.DictReader(file))
        self.assertEqual([(int(line["layer"]), float(line["value"]), float(line["exact_alpha"])) for line in table],
                         [(layer["layer"], layer["value"], layer["exact"][3]) for layer in ray["layers"]])

    def test_a_step_is_predicted_beside_the_measured_one(self):
        found = self.report["predicted_step"]
        good = [row["layer_spacing"] for row in self.rows(target="rgba16f", layers_per_plane=0)
                if row["error"]["sampling"]["rmse"] <= found["threshold_rmse"]]
        self.assertEqual(found["measured_voxels"], max(good, default=None))
        self.assertAlmostEqual(found["predicted_mm"],
                               0.5 / (found["transfer_cycles_per_unit"] * found["gradient_per_mm"]))
        self.assertTrue(found["why"])

    def test_verification_can_be_left_out(self):
        self.succeeds(*self.one_row("phantom:marschner-lobb:16"), env=self.own_cache(), notes=self.PAGE)
        report = self.new_report()
        self.assertEqual((report["refinement"], report["worst_ray"]), (None, None))
        self.assertTrue(report["predicted_step"] and report["convergence"])
        files = {path.name for path in (self.folder / "err").iterdir()}
        self.assertEqual(files & {"refinement.csv", "worst_ray.csv", "worst_ray.json"}, set())

    def test_error_falls_with_the_spacing_squared(self):
        rays = self.rows(target="rgba16f", layers_per_plane=0)  # what is blended once is rounded once
        totals = [row["error"]["total"]["rmse"] for row in rays]
        self.assertEqual([row["layer_spacing"] for row in rays], list(self.SPACINGS))
        self.assertEqual(totals, sorted(totals, reverse=True))
        self.assertAlmostEqual(rays[-1]["order"]["sampling"], 2.0, delta=0.25)  # midpoints of a smooth field
        coarse, fine = (row["error"]["sampling"]["rmse"] for row in rays[-2:])
        self.assertAlmostEqual(rays[-1]["order"]["sampling"], math.log2(coarse / fine), places=9)
        self.assertEqual((rays[0]["coarser"], rays[1]["coarser"]), (None, rays[0]["id"]))
        self.assertEqual(set(rays[0]["order"].values()), {None})

    def test_rounding_of_eight_bits_grows_with_the_planes(self):
        gpu = [row["error"]["gpu"]["rmse"] for row in self.rows(target="rgba8", layers_per_plane=1)]
        self.assertGreater(gpu[-1], 2 * gpu[0])

    def test_fronts_hold_what_nothing_beats(self):
        costs = {"front": lambda row: row["frame_ms"]["median"],
                 "front_by_fetches": lambda row: row["counters"]["volume_fetches"] + row["counters"]["skip_fetches"]}
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

    def test_the_command_of_a_row_skips_as_the_row_did(self):
        def command(*skipping, **axes):
            self.succeeds(*self.one_row("phantom:shells:16", *skipping, **axes), env=self.own_cache(),
                          notes=self.PAGE + r"slabcast: the table for --target-error is left as it was[^\n]*\n")
            (row,) = self.new_report()["rows"]
            self.succeeds(*shlex.split(row["command"])[1:])
            return row["command"]
        octree = command("--skip", "bitfield-octree", "--skip-bits", "64", "--skip-block", "8", "--traversal",
                         "top-down")
        self.assertIn("--skip bitfield-octree --skip-block 8 --skip-bits 64 --traversal top-down", octree)
        shutil.rmtree(self.folder / "err")
        slicing = command("--skip-block", "8", layers_per_plane=1)  # too few layers to skip
        self.assertIn("--skip none", slicing)
        self.assertNotIn("--skip-block", slicing)

    def test_a_run_goes_on_where_one_was_cut_short(self):
        if not self.resumes:
            self.skipTest("only a build of committed sources goes on")
        finished = self.copied()
        lines = finished.read_text().splitlines(keepends=True)
        kept, cut = lines[:-2], json.loads(lines[-1])["id"]
        finished.write_text("".join([*kept, lines[-2], lines[-1][:40]]))
        rows_alone = (*self.GRID, "--verification", "off")
        self.succeeds(*rows_alone, env=self.env,
                      notes=rf"slabcast: err: {len(kept)} rows [^\n]* are kept\n{self.PAGE}")
        again = json.loads((self.folder / "err" / "error.json").read_text())["rows"]
        for before, after in zip(self.rows(), again, strict=True):
            self.assertEqual(before["error"], after["error"])
            if before["id"] != cut:
                self.assertEqual(before, after)
        written = finished.stat().st_mtime_ns
        self.succeeds(*rows_alone, env=self.env,
                      notes=rf"slabcast: err: {len(kept) + 1} rows [^\n]* kept\n{self.PAGE}")
        self.assertEqual(finished.stat().st_mtime_ns, written)
        self.assertEqual(json.loads((self.folder / "err" / "error.json").read_text())["rows"], again)

    def test_other_settings_are_refused_unless_they_may_start_anew(self):
        self.copied()
        other = (*self.GRID[:-6], "--classify", "post", "--target", "rgba8", "--jitter", "off", "--termination", "off",
                 "--camera", "40,10,3", "--verification", "off")
        self.fails(*other, env=self.env, cause="err: holds an 'error' run of marschner-lobb .*which differs in camera:",
                   remedy="give --out another folder, or --fresh")
        self.succeeds(*other, "--fresh", env=self.env, notes=self.PAGE)
        rows = json.loads((self.folder / "err" / "error.json").read_text())["rows"]
        self.assertEqual(len(rows), len(self.SPACINGS) * len(self.LAYERS))
        self.assertNotIn(rows[0]["error"]["total"], [row["error"]["total"] for row in self.rows()])

    def own_cache(self):
        return {"XDG_CACHE_HOME": str(self.folder / "cache")}

    def one_row(self, volume, *more, **axes):
        """The arguments of a run that measures a single row, but for the axes that are given."""
        axes = {"size": "16x16", "layer-spacing": 2, "layers-per-plane": 0, "classify": "post", "target": "rgba8",
                "termination": "off", "jitter": "off", **{name.replace("_", "-"): axes[name] for name in axes}}
        return ("error", volume, "--out", "err", "--frames", "3", "--verification", "off", *more,
                *(word for name, value in axes.items() for word in (f"--{name}", value)))

    def new_report(self):
        return json.loads((self.folder / "err" / "error.json").read_text())

    def test_damaged_stores_start_anew(self):
        if not self.resumes:
            self.skipTest("only a build of committed sources goes on")
        finished = self.copied()
        key, first, *others = finished.read_text().splitlines()
        measured = json.loads(first)
        grid = self.one_row(self.GRID[1], size="48x48", layer_spacing=measured["layer_spacing"], target=measured["target"],
                            layers_per_plane=measured["layers_per_plane"])
        reference = self.folder / "err" / "reference.f64"
        header, pixels = reference.read_bytes().split(b"\n", 1)

        def spoilt(**members):
            return "\n".join((key, json.dumps({**measured, **members}), *others))
        stores = (spoilt(frame_ms=3), spoilt(frame_ms={"median": "3"}), spoilt(pictures={"thumbnail": 1}),
                  spoilt(pictures=[]), spoilt(error=None), spoilt(counters={}), spoilt(layer_spacing="1"), spoilt(id=1),
                  spoilt(date=None), "\n".join((key, "7", first)), "7\n" + first, "", "{\n")
        headers = (json.dumps({**json.loads(header), "seconds": "1"}).encode(), b"[]", b"", header)
        for k, rows in enumerate(stores):
            with self.subTest(k):
                finished.write_text(rows)
                if not rows.startswith(key):  # whose rows they are is not known: a finished report would be kept
                    (self.folder / "err" / "error.json").unlink(missing_ok=True)
                reference.write_bytes(headers[k % len(headers)] + b"\n" + pixels[:-8])
                self.succeeds(*grid, env=self.own_cache(), notes=rf"slabcast: err: rows\.jsonl is damaged: starts anew\n{self.PAGE}")
                (row,) = self.new_report()["rows"]
                self.assertEqual((row["id"], row["error"]), (measured["id"], measured["error"]))

    def test_where_a_length_holds_all_layers_ray_casting_is_kept(self):
        self.succeeds(*self.one_row("phantom:marschner-lobb:16", layers_per_plane="64,0"), env=self.own_cache(),
                      notes=self.PAGE)
        (row,) = self.new_report()["rows"]
        self.assertEqual((row["layers_per_plane"], row["ratio"]), (0, "ray casting"))

    def test_a_classification_that_does_not_fit_is_left_out(self):
        """A cube of 48 has 442368 bytes as colours of four, and 110592 as voxels."""
        too_much = ("phantom:shells:48", "--gpu-budget", "0.2")
        self.succeeds(*self.one_row(*too_much, classify="preclassified,post"), env=self.own_cache(), notes=self.PAGE)
        report = self.new_report()
        self.assertEqual([row["classify"] for row in report["rows"]], ["post"])
        (left,) = report["left_out"]
        self.assertEqual(left["classify"], "preclassified")
        self.assertRegex(left["why"], "442368 bytes.*--downsample 2")
        self.assertIn("442368 bytes", (self.folder / "err" / "report.html").read_text())
        self.assertEqual(self.report["left_out"], [])
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
        best = min(reach, key=lambda row: row["frame_ms"]["median"])
        text = self.succeeds(*scene, "--target-error", repr(target), env=self.env)
        self.assertRegex(text, rf"(?m)^target error .*{best['target']}, a layer every {best['layer_spacing']:g} voxels, .*"
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
        self.fails(*target, env=self.env, cause="reaches an RMSE of 1e-09: the best is", remedy="slabcast error",
                   status=2)
        self.fails(*target, env={"XDG_CACHE_HOME": str(self.measured / "none")}, cause="no errors were measured",
                   remedy="slabcast error")
        self.fails(*target, env={"XDG_CACHE_HOME": str(bad)}, cause="error-table-.*no table", remedy="delete it")
        self.fails("error", "missing.nrrd", "--out", "d", cause="missing.nrrd", remedy="check the path")


if __name__ == "__main__":
    main(__doc__)
