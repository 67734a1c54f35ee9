#!/usr/bin/python3
"""perf/pages/skipbench_report.py from a made-up comparison: what the page says, what it refuses, what it survives.

With a folder as its argument, writes the made-up comparison and its page there, to look at.
"""

import json
import re
import shutil
import subprocess
import sys
import unittest
from pathlib import Path
from types import SimpleNamespace

from report_test import external

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "support"))
from report_pages import ReportTest, check_figures, words_of  # noqa: E402

sys.path.insert(0, str(Path(__file__).resolve().parent.parent.parent / "perf" / "pages"))
import skipbench_plots  # noqa: E402

REPORT = Path(__file__).resolve().parent.parent.parent / "perf" / "pages" / "skipbench_report.py"
SPEEDUPS = {"none": 1.0, "blocks": 1.6, "proximity": 2.9, "chebyshev": 3.1, "partitioned": 3.0,
            "boolean-octree": 2.2, "minmax-octree": 1.3, "bitfield-octree": 2.1}
MODES = {"marching only": 40.0, "early exit": 25.0, "shading": 90.0}
TRANSFERS = {"TF1": "all but the minimum", "TF2": "all", "TF5": "CT <bone>"}
PARTITIONS = (16, 64, 256)
NO_COMPUTE = "this device offers 4 storage blocks, <16> are needed"
REFUSED = "256 partitions take 1.7 GiB, more than the budget of 256 MiB"


def times(median):
    return {"median": median, "min": 0.9 * median, "max": 1.2 * median, "p10": median, "p90": median, "n": 5}


def parameters(structure):
    row = {"skip": structure}
    if structure != "none":
        row["skip_block"] = 4
    if structure == "bitfield-octree":
        row["skip_bits"] = 32
    if structure == "partitioned":
        row["partitions"] = 64
    if structure.endswith("octree"):
        row.update({"initial_level": 3, "traversal": "bidirectional"})
    return row


def ratio(name, value):
    return {name: value, f"{name}_low": 0.9 * value, f"{name}_high": 1.25 * value, "speedup_coverage": 0.9375}


def counters(structure):
    return {"fragments": 15_000, "layers_evaluated": round(1.4e6 / SPEEDUPS[structure]), "layers_skipped": 10,
            "volume_fetches": round(1.4e6 / SPEEDUPS[structure]), "skip_fetches": 2_500_000, "stretches": 180_000,
            "blocks_visited": 82_000}


def frames(volume):
    rows = []
    for family, modes in (("ray casting", MODES), ("hybrid", ("marching only", "early exit")),
                          ("slicing", ("marching only",))):
        for mode in modes:
            for structure, speedup in SPEEDUPS.items():
                for tight in (False, True) if family != "ray casting" and structure != "none" else (False,):
                    ms = MODES[mode] / speedup / (1.4 if tight else 1)
                    finer = {"skip_block": 2} if structure == "chebyshev" and mode == "early exit" else {}
                    rows.append({"table": "frames", "volume": volume, "family": family, "mode": mode,
                                 **parameters(structure), **finer, "planes": 7, "layers_per_plane": 64, "tighten": tight,
                                 "order": "back-to-front", "frame_ms": times(ms), "samples": [ms] * 5,
                                 **ratio("speedup", MODES[mode] / ms), "counters": counters(structure)})
    return rows


def searched(volume):
    return [{"table": "search", "volume": volume, **parameters(structure), "skip_block": edge, "initial_level": level,
             **({"skip_bits": bits} if bits else {}), "traversal": way, "search_ms": 4 + edge / 4 + level / 3 + (way == "top-down")}
            for structure in ("boolean-octree", "bitfield-octree") for edge in (2, 4, 8) for level in (0, 3)
            for way in ("bidirectional", "top-down") for bits in ((8, 32) if structure[1] == "i" else (None,))]


def built(volume, table="structures", **more):
    return [{"table": table, "volume": volume, **parameters(structure), "build_ms": times(12.0),
             **({"gpu_build_ms": None, "gpu_refused": NO_COMPUTE} if structure == "partitioned" else
                {"gpu_build_ms": times(7.5)}),
             "update_ms": times(0.4) if structure.startswith(("min", "bit")) else None, "gpu_bytes": 1_200_000,
             "host_bytes": 7_000_000 if structure == "partitioned" else 0, "occupied_fraction": 0.22, **more}
            for structure in SPEEDUPS if structure != "none"]


def merging(volume):
    rows = []
    for edge in (4, 1):
        for count in PARTITIONS:
            refused = {"refused": REFUSED} if edge == 1 and count > 16 else {
                "init_ms": 3.0 * count, "gpu_bytes": 1000, "host_bytes": 110_592 * count}
            rows.append({"table": "partitions", "volume": volume, "skip": "partitioned", "skip_block": edge,
                         "partitions": count, **refused})
        for tf, name in TRANSFERS.items():
            named = {"volume": volume, "skip_block": edge, "tf": tf, "tf_name": name}
            rows += [{"table": "rebuild", "skip": structure, "build_ms": times(9.0), "of_ranges_ms": times(1.0),
                      **named} for structure in ("chebyshev", "proximity")]
            rows += [{"table": "merge", "skip": "partitioned", "partitions": count, "update_ms": times(count / 64),
                      **ratio("speedup", 9 * 64 / count), **named} for count in PARTITIONS if edge == 4 or count == 16]
    return rows


def figure(name, volume, value, goal, sense=">="):
    reached = None if value is None or goal is None else value >= goal if sense == ">=" else value <= goal
    paired = {"low": 0.9 * value, "high": 1.25 * value, "coverage": 0.9375} if value and "map" in name else {}
    return {"name": name, "volume": volume, "value": value, **paired, "goal": goal, "sense": sense, "reached": reached,
            "from": "of these rows"}


def compared():
    skull = "skull & co"
    rows = (frames(skull) + searched(skull) + built(skull) + merging(skull)
            + [{"table": "work", "volume": skull, **parameters(s), "counters": counters(s)} for s in SPEEDUPS]
            + [row for edge in (64, 256) for row in built(skull, "sizes", edge=edge, frame_ms=times(edge / 8))]
            + frames("gap"))
    lungs = [12.05, 5.98, 7.32, 15.59, 7.91]
    columns = ["none", "distance map", "boolean-octree", "minmax-octree", "bitfield-octree"]
    return {
        "command": "slabcast skipbench skull.nrrd phantom:gap --out bench", "commit": "abc1234", "date": "2026-01-02",
        "device": {"vendor": "Maker", "renderer": "Test <GPU>", "version": "OpenGL ES 3.2", "software": True},
        "conditions": {"size": [256, 256], "camera": [0, 10, 2.5], "fov_degrees": 40,
                       "settings": {"layer_spacing": 1.0, "lattice": "planar", "target": "rgba8", "space": "display",
                                    "termination": 0.9961},
                       "frames_per_row_at_most": 5, "partition_budget_bytes": 2 ** 28, "quick": True},
        "volumes": [{"name": skull, "dims": [256, 256, 108], "type": "int16", "transfer_function": "CT <bone>",
                     "texel_bytes": 14155776, "codes_ms": 17.0},
                    {"name": "gap", "dims": [128] * 3, "type": "uint16", "transfer_function": "Gap"}],
        "figures": [figure("distance map against none", skull, 3.1, 2.0),
                    figure("bitfield octree of 256^3, build", skull, 61.0, 60.0, "<="),
                    figure("distance map against none", "gap", 3.1, None),
                    figure("merging at edge 1", skull, None, 10.0)],
        "papers": {"faludi": {"source": "Someone 2021, table 1", "device": "a GPU",
                              "structures": columns,
                              "datasets": [{"name": "Lungs", "marching_only": lungs, "early_exit": lungs, "shading": lungs,
                                            "generation": [59.2, 7.7, 7.1, 7.0]}]},
                   "rauter": {"source": "Someone 2024, table 1", "device": "another",
                              "partitions": [16, 32, 64, 128, 256],
                              "datasets": [{"name": "manix", "update": [[3.5, 0.2, 0.27, 0.42, 0.69, 1.3]] * 6}]}},
        "rows": rows, "summary": {"judged": 2, "reached": 1, "volumes": {}}}


def write(folder, data):
    (folder / "skipbench.json").write_text(json.dumps(data))


class SkipbenchReportTest(ReportTest):
    report = REPORT
    data = "skipbench.json"

    full = ""  # the page of all that is compared, made once

    def setUp(self):
        super().setUp()
        if not self.full:
            type(self).full = self.whole_page(compared())
            check_figures(self, self.folder, self.full)
            shutil.rmtree(self.folder)
            self.folder.mkdir()

    def page(self, data):
        write(self.folder, data)
        return words_of(self.folder, "skipbench_data", "skipbench_page")

    def whole_page(self, data):
        write(self.folder, data)
        result = subprocess.run([REPORT, self.folder], capture_output=True, text=True, check=False)
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        self.assertEqual(sorted(p.name for p in self.folder.iterdir()), ["figures", "report.html", "skipbench.json"])
        return (self.folder / "report.html").read_text()

    def test_all_parts_are_there_and_nothing_outside(self):
        text = self.full
        self.assertEqual(external(text), [])
        for title in ("Figures to reach", "ray casting", "work at equal parameters", "hybrid and slicing",
                      "building and memory", "which parameters", "a new transfer function", "Cost against size",
                      "This run"):
            self.assertTrue(re.search(rf"<h2>[^<]*{title}", text), title)
        # wide and narrow: speeds and families of two volumes; merging and sizes of one
        self.assertEqual(len(re.findall(r'<figure><div class="wide"><svg', text)), 6)

    def test_names_are_escaped(self):
        text = self.full
        for raw in ("<GPU>", "CT <bone>", "skull & co"):
            self.assertFalse(raw in text, raw)
        self.assertTrue("skull &amp; co: ray casting" in text)

    def test_figures_say_whether_they_are_reached(self):
        text = self.full
        self.assertTrue("1 of 2" in text)
        goals = text[text.index("Figures to reach"):text.index("ray casting</h2>")]
        self.assertIn("256³", goals)
        self.assertEqual(goals.count("<b class=fail>no</b>"), 1)
        self.assertIn("1 figure without a goal", goals)
        self.assertIn("<td>3.1<br><i>2.79 – 3.88</i></td>", goals)  # paired, as builds are not
        self.assertIn("<td>61</td>", goals)
        self.assertIn("here 93.8 %.", goals)

    def test_ratios_have_their_intervals(self):
        self.assertIn("<b>2.90×</b><br><i>2.61 – 3.62</i>", self.full)
        self.assertIn("9.0×</b> <i>8.1 – 11.2</i>", self.full)

    def test_without_goals_there_is_nothing_to_reach(self):
        data = compared()
        for entry in data["figures"]:
            entry["goal"] = entry["reached"] = None
        data["rows"] = [row for row in data["rows"] if row["table"] == "frames"]
        text = self.page(data)
        self.assertIn("<h2>Figures</h2>", text)
        self.assertIn("Goals were set for the project’s own scenes only.", text)
        for words in ("Figures to reach", "<th scope=col>goal</th>", "Figures reached"):
            self.assertFalse(words in text, words)

    def test_the_papers_ratios_stand_beside(self):
        text = self.full
        for ratio in (12.05 / 5.98, 12.05 / 7.32, 12.05 / 15.59, 12.05 / 7.91):
            self.assertEqual(text.count(f"<td>{ratio:.2f}</td>") % 3, 0)  # in each mode
            self.assertTrue(f"<td>{ratio:.2f}</td>" in text, ratio)
        for words in (f"{3.5 / 0.2:.1f}×", "Someone 2021, table 1", "Someone 2024, table 1"):
            self.assertTrue(words in text, words)

    def test_a_refusal_is_shown_with_its_reason(self):
        text = self.full
        self.assertEqual(text.count(REFUSED), 2)

    def test_parameters_of_early_exit_are_named_where_they_are_others(self):
        casting = self.full[self.full.index("ray casting</h2>"):self.full.index("work at equal parameters</h2>")]
        self.assertEqual(re.findall(r"early exit: [^<]*", casting), ["early exit: 2³"])

    def test_builds_on_either_side_with_their_spread(self):
        text = self.full
        builds = text[text.index("building and memory</h2>"):text.index("which parameters</h2>")]
        self.assertEqual(builds.count("<td>7.5<br><i>6.75 – 9</i></td>"), len(SPEEDUPS) - 2)
        self.assertEqual(builds.count("<td>12<br><i>10.8 – 14.4</i></td>"), len(SPEEDUPS) - 1)
        self.assertEqual(builds.count(NO_COMPUTE.replace("<", "&lt;").replace(">", "&gt;")), 1)

    def test_bars_start_at_what_none_takes(self):
        """Also those of what is slower, which lie to the line's other side."""
        bars, spreads = [], []
        axes = SimpleNamespace(barh=lambda place, width, left, **_: bars.append((left, left + width)),
                               errorbar=lambda x, y, xerr, **_: spreads.append((x, xerr)))
        for speedup in (0.8, 1.0, 3.0):
            skipbench_plots._bar(axes, 0, SimpleNamespace(speedup=speedup, interval=(0.5 * speedup, 2 * speedup)))
        self.assertEqual(bars, [(1, 0.8), (1, 1.0), (1, 3.0)])
        self.assertEqual(spreads[2], (3.0, [[1.5], [3.0]]))

    def test_lives_without_what_was_not_measured(self):
        data = compared()
        data["rows"] = [row for row in data["rows"] if row["table"] == "frames" and row["family"] == "ray casting"]
        for name in ("figures", "papers", "conditions"):
            del data[name]
        for row in data["rows"]:
            row["counters"] = None
        text = self.page(data)
        for title in ("Figures to reach", "a new transfer function", "Cost against size", "which parameters"):
            self.assertFalse(re.search(rf"<h2>[^<]*{title}", text), title)

    def test_refuses_bad_input_in_one_line(self):
        self.refusal("no such file")
        self.refusal("not JSON", "{")
        self.refusal("no rows", {"rows": []})
        data = compared()
        data["rows"][3]["frame_ms"]["median"] = None
        self.refusal("rows[3].frame_ms.median", data)
        data = compared()
        del data["rows"][2]["volume"]
        self.refusal("rows[2].volume", data)
        self.refusal("no rows of frames", {"rows": [{"table": "work", "volume": "skull"}]})


if __name__ == "__main__":
    if len(sys.argv) == 2 and Path(sys.argv[1]).is_dir():
        write(Path(sys.argv[1]), compared())
        sys.exit(subprocess.run([REPORT, sys.argv[1]], check=False).returncode)
    unittest.main()
