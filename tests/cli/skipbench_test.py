#!/usr/bin/env python3
"""`slabcast skipbench`, as small as can be, as a process: exit status, tables, figures, and what it refuses.

usage: skipbench_test.py SLABCAST [arguments of unittest]
"""

import csv
import json
import os
import shutil
import statistics
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "support"))
from report_keys import key_of, odd_keys, undocumented_columns, undocumented_keys  # noqa: E402

SLABCAST = None  # the program, from the command line
STRUCTURES = ["none", "blocks", "proximity", "chebyshev", "partitioned", "boolean-octree", "minmax-octree",
              "bitfield-octree"]
OCTREES = STRUCTURES[5:]
MODES = ["marching only", "early exit", "shading"]
PARTITIONS = [16, 32, 64, 128, 256]
TRANSFERS = ["TF1", "TF2", "TF3", "TF4", "TF5", "TF6"]
KEYS = {"command", "commit", "date", "device", "conditions", "volumes", "figures", "papers", "rows", "summary"}
FIGURES = {"distance_map_marching_only_speedup", "distance_map_early_exit_speedup",
           "bitfield_octree_over_distance_map_time", "bitfield_octree_over_minmax_octree_time",
           "bitfield_octree_over_minmax_octree_blocks_visited", "bitfield_octree_over_minmax_octree_blocks_looked_at",
           *(f"hybrid_{mode}_{planes}_speedup" for mode in ("early_exit", "marching_only")
             for planes in ("rectangles", "sphere", "structure")),
           *(f"merge_16_speedup_edge_{edge}" for edge in (4, 2, 1)),
           "bitfield_octree_256_build_ms", "bitfield_octree_256_memory_share"}
BUDGET_MIB = 0.03  # 27,648 bytes fit (6^3 blocks x 128, 12^3 x 16), 55,296 do not


def skipbench(*arguments, **environment):
    return subprocess.run([SLABCAST, "skipbench", *map(str, arguments)], capture_output=True, text=True, timeout=300,
                          env={**os.environ, **environment})


def paired(a, b):
    return statistics.median(x / y for x, y in zip(a["samples"], b["samples"], strict=True))


class SmallRunTest(unittest.TestCase):
    """One run over 24^3 voxels and 32x32 pixels, made once."""

    @classmethod
    def setUpClass(cls):
        cls.folder = Path(tempfile.mkdtemp(prefix="slabcast_skipbench_")) / "out"
        cls.addClassCleanup(shutil.rmtree, cls.folder.parent)
        cls.run_ = skipbench("phantom:gap:24", "--quick", "--size", "32x32", "--sizes", "16,24", "--frames", 3,
                             "--partition-budget", BUDGET_MIB, "--out", cls.folder)
        assert cls.run_.returncode == 0, cls.run_.stderr
        cls.report = json.loads((cls.folder / "skipbench.json").read_text())
        cls.rows = cls.report["rows"]

    def of(self, table, **keys):
        return [row for row in self.rows if row["table"] == table and all(row.get(k) == v for k, v in keys.items())]

    def one(self, table, **keys):
        found = self.of(table, **keys)
        self.assertEqual(len(found), 1, (table, keys))
        return found[0]

    def figure(self, *words):
        found = [f for f in self.report["figures"] if all(word in f["name"] for word in words)]
        self.assertEqual(len(found), 1, words)
        return found[0]

    def test_files_and_keys(self):
        self.assertEqual(sorted(p.name for p in self.folder.iterdir()),
                         ["figures", "report.html", "rows.jsonl", "skipbench.csv", "skipbench.json"])
        self.assertEqual(set(self.report), KEYS)
        self.assertEqual(odd_keys(self.report), [])
        self.assertEqual(undocumented_keys(self.report, "skipbench"), [])
        self.assertEqual(undocumented_columns(self.folder / "skipbench.csv", "skipbench"), [])
        self.assertIn("</html>", (self.folder / "report.html").read_text())

    def test_summary_is_of_numbers_and_its_line_the_last(self):
        summary = self.report["summary"]
        judged = [f for f in self.report["figures"] if f["reached"] is not None]
        self.assertEqual((summary["judged"], summary["reached"]), (len(judged), sum(f["reached"] for f in judged)))
        self.assertIn(f"summary: {summary['reached']} of {summary['judged']} figures reached",
                      self.run_.stdout.splitlines()[-1])
        figures = summary["volumes"][self.report["volumes"][0]["name"]]
        self.assertEqual(set(figures), FIGURES)
        for entry in self.report["figures"]:
            self.assertEqual(figures[entry["key"]], {k: entry[k] for k in (
                "value", "low", "high", "coverage", "goal", "sense", "reached")})
        # What was not measured is null, not 0: refused partitions, a size that was not asked for.
        for name in ("merge_16_speedup_edge_1", "bitfield_octree_256_build_ms", "bitfield_octree_256_memory_share"):
            self.assertIsNone(figures[name]["value"], name)
            self.assertIsNone(figures[name]["reached"], name)

    def test_the_phantom_is_shown_by_its_own_preset(self):
        self.assertEqual([v["transfer_function"] for v in self.report["volumes"]], ["Gap"])

    def test_every_structure_in_every_mode(self):
        for mode in MODES:
            rows = self.of("frames", family="ray casting", mode=mode)
            self.assertEqual([row["skip"] for row in rows], STRUCTURES, mode)
            self.assertEqual({row["planes"] for row in rows}, {1})
        for family, mode in (("hybrid", "marching only"), ("hybrid", "early exit"), ("slicing", "marching only")):
            rows = self.of("frames", family=family, mode=mode)
            self.assertEqual({row["skip"] for row in rows}, set(STRUCTURES), family)
            self.assertEqual(rows[0]["skip"], "none")
        self.assertEqual({row["layers_per_plane"] for row in self.of("frames", family="slicing")}, {1})
        for name in ("layers_evaluated", "volume_fetches", "skip_fetches", "stretches", "blocks_visited"):
            self.assertTrue(all(name in row["counters"] for row in self.of("frames")), name)

    def test_speedups_are_those_of_the_samples(self):
        for family in ("ray casting", "hybrid", "slicing"):
            for mode in MODES:
                rows = self.of("frames", family=family, mode=mode)
                for row in rows:
                    self.assertEqual(len(row["samples"]), row["frame_ms"]["n"])
                    self.assertAlmostEqual(row["frame_ms"]["median"], statistics.median(row["samples"]))
                    self.assertAlmostEqual(row["speedup"], paired(rows[0], row), places=9)
                    ratios = [a / b for a, b in zip(rows[0]["samples"], row["samples"])]
                    self.assertAlmostEqual(row["speedup_low"], min(ratios), places=9)  # of three rounds
                    self.assertAlmostEqual(row["speedup_high"], max(ratios), places=9)
                    self.assertEqual(row["speedup_coverage"], 0.75)

    def test_equal_parameters_skip_equally_much_where_nothing_lies_between(self):
        layers = {row["skip"]: row["counters"]["layers_evaluated"] for row in self.of("work")}
        self.assertEqual(list(layers), STRUCTURES)
        # Exact ones of blocks of 4 voxels agree; the TF as one range, or bin by bin, never shows less.
        for name in ("proximity", "chebyshev", "boolean-octree"):
            self.assertEqual(layers[name], layers["blocks"], name)
        self.assertLessEqual(layers["blocks"], layers["bitfield-octree"])
        self.assertLessEqual(layers["bitfield-octree"], layers["minmax-octree"])
        self.assertLessEqual(layers["minmax-octree"], layers["none"])

    def test_the_best_was_searched_for(self):
        for structure in OCTREES:
            tried = [tuple(row.get(k) for k in ("skip_block", "skip_bits", "initial_level", "traversal"))
                     for row in self.of("search", skip=structure)]
            self.assertEqual(len(tried), len(set(tried)))
            self.assertGreaterEqual(len(tried), 4)
            best = self.one("structures", skip=structure)
            for mode in MODES[:2]:
                fastest = max(self.of("finals", skip=structure, mode=mode), key=lambda row: row["speedup"])
                drawn = self.one("frames", skip=structure, family="ray casting", mode=mode)
                for key in ("skip_block", "initial_level", "traversal"):
                    self.assertEqual(drawn[key], fastest[key], (structure, mode))
                    if mode == "marching only":
                        self.assertEqual(best[key], fastest[key], structure)

    def test_finals_are_ratios_to_none(self):
        for structure in ["blocks", "proximity", "chebyshev", *OCTREES]:
            for mode in MODES[:2]:
                rows = self.of("finals", finals_of=structure, mode=mode)
                self.assertEqual([row["skip"] for row in rows], ["none"] + [structure] * (len(rows) - 1))
                for row in rows:
                    self.assertAlmostEqual(row["speedup"], paired(rows[0], row), places=9)
                    ratios = [a / b for a, b in zip(rows[0]["samples"], row["samples"])]
                    self.assertAlmostEqual(row["speedup_low"], min(ratios), places=9)  # of three rounds
                    self.assertAlmostEqual(row["speedup_high"], max(ratios), places=9)
                    self.assertEqual(row["speedup_coverage"], 0.75)

    def test_what_structures_take(self):
        for structure in STRUCTURES[1:]:
            row = self.one("structures", skip=structure)
            for name in ("build_ms", "gpu_build_ms"):
                self.assertGreater(row[name]["min"], 0)
                self.assertLessEqual(row[name]["min"], row[name]["median"])
                self.assertLessEqual(row[name]["median"], row[name]["max"])
                self.assertIn(row[name]["n"], (1, 2, 3))
            self.assertNotIn("gpu_refused", row)
            self.assertGreater(row["gpu_bytes"], 0)
        self.assertGreater(self.one("structures", skip="partitioned")["host_bytes"], 0)

    def test_partitions_over_the_budget_are_refused_with_what_they_need(self):
        for row in self.of("partitions"):
            blocks = (24 // row["skip_block"]) ** 3
            needed = blocks * row["partitions"]
            self.assertEqual("refused" in row, needed > BUDGET_MIB * 2 ** 20, row)
            merges = self.of("merge", skip_block=row["skip_block"], partitions=row["partitions"])
            if "refused" in row:
                self.assertRegex(row["refused"], r"\d.*(MiB|KiB|bytes)")
                self.assertEqual(merges, [])
            else:
                self.assertEqual(row["host_bytes"], needed)
                self.assertEqual([m["tf"] for m in merges], TRANSFERS)
        self.assertEqual([row["partitions"] for row in self.of("partitions", skip_block=4)], PARTITIONS)
        self.assertEqual({row["skip_block"] for row in self.of("partitions") if "refused" in row}, {1, 4})

    def test_every_way_to_rebuild(self):
        for edge in (1, 2, 4):
            for structure in ("chebyshev", "proximity"):
                rows = self.of("rebuild", skip_block=edge, skip=structure)
                self.assertEqual([row["tf"] for row in rows], TRANSFERS)
                self.assertTrue(all(row["build_ms"]["median"] > 0 and row["of_ranges_ms"]["median"] > 0 for row in rows))

    def test_cost_against_size(self):
        for edge in (16, 24):
            rows = self.of("sizes", edge=edge)
            self.assertEqual([row["skip"] for row in rows], STRUCTURES)
            self.assertEqual({row["volume_bytes"] for row in rows}, {2 * edge ** 3})
        self.assertGreater(self.one("sizes", edge=24, skip="bitfield-octree")["gpu_bytes"],
                           self.one("sizes", edge=16, skip="bitfield-octree")["gpu_bytes"])

    def test_figures_follow_from_rows(self):
        for mode in ("marching only", "early exit"):
            maps = [self.one("frames", family="ray casting", mode=mode, skip=s)
                    for s in ("proximity", "chebyshev")]
            best = max(row["speedup"] for row in maps)
            self.assertAlmostEqual(self.figure("distance map against none", mode)["value"], best)
        marching = {s: self.one("frames", family="ray casting", mode="marching only", skip=s) for s in STRUCTURES}
        fast = max((marching[s] for s in ("proximity", "chebyshev")), key=lambda row: row["speedup"])
        self.assertAlmostEqual(self.figure("bitfield octree against the distance map")["value"],
                               paired(marching["bitfield-octree"], fast))
        visited = {s: self.one("work", skip=s)["counters"]["blocks_visited"] for s in OCTREES}
        self.assertAlmostEqual(self.figure("blocks visited")["value"],
                               visited["bitfield-octree"] / visited["minmax-octree"])
        self.assertEqual(self.figure("blocks visited")["goal"], 0.6)
        hybrid = {tight: {row["skip"]: row for row in
                          self.of("frames", family="hybrid", mode="early exit", tighten=tight)}
                  for tight in (True, False)}
        for words, with_tight, without_tight in (("both with planes as rectangles", True, True),
                                                 ("both with planes of the sphere", False, False),
                                                 ("against none of the sphere", True, False)):
            self.assertEqual(sorted(hybrid[with_tight]), sorted(STRUCTURES))
            best = max((row for name, row in hybrid[with_tight].items() if name != "none"),
                       key=lambda row: row["speedup"])
            self.assertAlmostEqual(self.figure("hybrid", "early exit", words)["value"],
                                   paired(hybrid[without_tight]["none"], best))
        merges = [row["speedup"] for row in self.of("merge", skip_block=4, partitions=16)]
        self.assertAlmostEqual(self.figure("merging 16", "blocks of 4")["value"], statistics.median(merges))
        self.assertIsNone(self.figure("merging 16", "blocks of 1")["value"])  # refused

    def test_a_figure_is_reached_where_its_value_meets_its_goal(self):
        for figure in self.report["figures"]:
            if figure["value"] is None or figure["goal"] is None:
                self.assertIsNone(figure["reached"], figure)
            else:
                meets = figure["value"] >= figure["goal"] if figure["sense"] == ">=" else (
                    figure["value"] <= figure["goal"])
                self.assertEqual(figure["reached"], meets, figure)
        bone = [f["goal"] for f in self.report["figures"] if "distance map against none" in f["name"]]
        self.assertEqual(bone, [None, None])  # goals of the skull are not the phantom's

    def test_published_columns_are_in_order(self):
        faludi = self.report["papers"]["faludi"]
        self.assertEqual(len(faludi["datasets"]), 6)
        # What the paper says of its table: the map is the fastest, and generated the slowest, for every dataset.
        for data in faludi["datasets"]:
            for key in map(key_of, MODES):
                self.assertEqual(min(data[key]), data[key][1], data["name"])
            self.assertEqual(max(data["generation"]), data["generation"][0], data["name"])
        lungs = faludi["datasets"][0]
        self.assertAlmostEqual(lungs["early_exit"][3] / lungs["early_exit"][4] - 1, 1.14, delta=0.005)  # "up to 114%"
        # "up to factor 10 for 256 partitions and up to factor 30 for 16", a little more in the table itself
        update = [line for data in self.report["papers"]["rauter"]["datasets"] for line in data["update"]]
        self.assertEqual({len(line) for line in update}, {6})
        self.assertLess(max(line[0] / line[5] for line in update), 10)
        self.assertLess(30, max(line[0] / line[1] for line in update))

    def test_table_has_a_line_per_row(self):
        with open(self.folder / "skipbench.csv", newline="", encoding="utf-8") as table:
            lines = list(csv.DictReader(table))
        self.assertEqual(len(lines), len(self.rows))
        self.assertEqual([line["table"] for line in lines], [row["table"] for row in self.rows])
        self.assertLessEqual({"volume", "family", "mode", "skip", "skip_block", "skip_bits", "initial_level",
                              "traversal", "partitions", "tf", "speedup", "build_ms", "gpu_bytes",
                              "refused", "frame_ms_median", "layers_evaluated", "blocks_visited"}, set(lines[0]))
        for line, row in zip(lines, self.rows):
            if row["table"] == "frames":
                self.assertEqual(float(line["frame_ms_median"]), row["frame_ms"]["median"])


class GoesOnTest(unittest.TestCase):
    """A run that is cut short, and goes on; without matplotlib, as pages take most of the time."""

    ARGUMENTS = ("phantom:gap:12", "--quick", "--size", "16x16", "--sizes", "8", "--frames", 3, "--out")

    def test_what_was_finished_is_not_measured_again(self):
        with tempfile.TemporaryDirectory() as folder:
            out = Path(folder) / "out"
            (Path(folder) / "matplotlib.py").write_text('raise ImportError("left out")\n')
            run = skipbench(*self.ARGUMENTS, out, PYTHONPATH=folder)
            self.assertRegex(run.stderr, r"report\.html is not: install[^\n]*\n\Z")
            before = json.loads((out / "skipbench.json").read_text())
            if before["commit"].endswith("-dirty"):
                self.skipTest("only a build of committed sources goes on")
            rows = (out / "rows.jsonl").read_text().splitlines(keepends=True)
            key, *pieces = rows
            races = [piece for piece in pieces if "/frames/" in piece and "/round 2" in piece]
            self.assertTrue(races)
            (out / "rows.jsonl").write_text("".join([key, *(piece for piece in pieces if piece not in races)]))
            run = skipbench(*self.ARGUMENTS, out, PYTHONPATH=folder)
            self.assertRegex(run.stderr, rf"{len(pieces) - len(races)} rows of an earlier run")
            after = json.loads((out / "skipbench.json").read_text())
            self.assertEqual(len(after["rows"]), len(before["rows"]))
            for was, row in zip(before["rows"], after["rows"]):
                self.assertEqual(row.get("samples", [])[:2], was.get("samples", [])[:2])
                for name in ("search_ms", "build_ms", "gpu_build_ms", "update_ms", "init_ms", "of_ranges_ms", "counters"):
                    self.assertEqual(row.get(name), was.get(name), (row["table"], name))
            self.assertTrue(any(was.get("samples") != row.get("samples")
                                for was, row in zip(before["rows"], after["rows"])))
            other = skipbench("phantom:shells:12", *self.ARGUMENTS[1:], out)
            self.assertEqual(other.returncode, 1)
            self.assertRegex(other.stderr, r"holds a 'skipbench' run of phantom:gap:12 [^\n]*which differs in volumes: ")


class RefusalTest(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.out = Path(temporary.name) / "out"

    def refuses(self, cause, *arguments, status=1):
        run = skipbench(*arguments)
        self.assertEqual(run.returncode, status, run.stderr)
        self.assertRegex(run.stderr, rf"\Aslabcast[^\n]*{cause}[^\n]*\n\Z")
        self.assertFalse(self.out.exists())

    def test_bad_usage(self):
        self.refuses("VOLUME", "--out", self.out, status=2)
        self.refuses("--out", "phantom:gap:8", status=2)
        self.refuses("--sizes", "phantom:gap:8", "--sizes", "0", "--out", self.out, status=2)
        self.refuses("--partition-budget", "phantom:gap:8", "--partition-budget", "much", "--out", self.out, status=2)

    def test_any_volume_that_cannot_be_read_stops_before_the_first_is_measured(self):
        self.refuses("no phantom 'cube'", "phantom:cube", "--out", self.out, status=2)
        self.refuses("nowhere.nrrd", "phantom:gap:8", "nowhere.nrrd", "--out", self.out)

    def test_transfer_function_that_is_none(self):
        self.refuses("--tf: 'bones' is not one of", "phantom:gap:8", "--tf", "bones", "--out", self.out, status=2)

    def test_transfer_function_that_shows_nothing(self):
        with tempfile.NamedTemporaryFile("w", suffix=".json") as file:
            json.dump({"name": "Nothing", "points": [{"value": 0, "color": [1, 1, 1], "opacity": 0}]}, file)
            file.flush()
            self.refuses("'Nothing' shows nothing", "phantom:shells:8", "--tf", file.name, "--sizes", "8", "--out",
                         self.out, status=2)

    def test_folder_that_cannot_be_made(self):
        with tempfile.NamedTemporaryFile() as file:
            self.refuses("cannot make this folder", "phantom:gap:8", "--out", Path(file.name) / "out")


if __name__ == "__main__":
    SLABCAST = sys.argv.pop(1)
    unittest.main()
