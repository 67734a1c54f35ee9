#!/usr/bin/python3
"""perf/pages/edit_report.py from made-up edits: what the page says, what it refuses, what it survives.

With a folder as its argument, writes the made-up edits and their page there, to look at.
"""

import json
import math
import re
import subprocess
import sys
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "support"))
from report_pages import ReportTest, check_figures, words_of  # noqa: E402

REPORT = Path(__file__).resolve().parent.parent.parent / "perf" / "pages" / "edit_report.py"
FRAMES = 120


def frame(i):
    """Sixty frames of edits, then a pause in which the map is rebuilt; again."""
    edited, settled = i % 60 < 45, i % 60 > 52
    octree = 8 + math.sin(i / 9)
    parts = {"edit_ms": 0.7 if edited else 0.0, "work_ms": 2.0 if 48 < i % 60 < 53 else 0.0, "prepare_ms": 0.1,
             "draw_ms": octree * (0.8 if settled else 1)}
    return {"frame": i, "step": "interpolate" if edited else "pause", "edit": edited,
            "progress": "swapped" if i % 60 == 52 else "settled" if settled else "waiting",
            "skip": "proximity" if settled else "bitfield-octree", "frame_ms": sum(parts.values()), "parts": parts,
            "octree_ms": octree, "budget_ms": 1.5 * octree, "naive_ms": 7 + (40 if edited else 0), "equal": True,
            "counters": {"volume_fetches": 4e6, "skip_fetches": 1e6 + 1e4 * i}}


def measured():
    rows = [frame(i) for i in range(FRAMES)]
    worst = max(row["frame_ms"] / row["octree_ms"] for row in rows)
    return {"command": "slabcast edit <skull> --out edit", "commit": "abc", "date": "2026-11-24T10:00:00Z",
            "device": {"renderer": "made up", "vendor": "nobody", "version": "1", "software": False},
            "volume": {"name": "<skull>", "dims": [256, 256, 108]},
            "conditions": {"size": [512, 512], "planes": 13, "layers_per_plane": 32, "settings": {"classify": "post"},
                           "edits": "interpolation", "work_budget_ms": 2, "quiet_frames": 3, "octree_frames": 3,
                           "replays": 3, "turn_degrees": 90},
            "builds": {"always": {"structure": "bitfield-octree", "skip_block": 4, "ms": 50, "gpu_bytes": 600000},
                       "settled": {"structure": "proximity", "skip_block": 4, "last_ms": 5, "gpu_bytes": 110592},
                       "naive_ms": 40},
            "summary": {"compared_with": "bitfield-octree", "worst_over_octree_frame": worst,
                        "worst_of_single_replays": 1.41, "worst_added_over_octree_frame": 1.237,
                        "worst_octree_frame_over_median": 1.33, "budget_ms": None,
                        "budget_over_octree": 1.5, "frames_over_budget": 0, "frames_equal": FRAMES, "frames_to_correct": 1,
                        "frame_ms": {"median": 8.5, "p90": 9.5, "max": 10.1},
                        "naive": {"frame_ms": {"median": 47}, "worst_over_octree_frame": 6.6, "frames_over_budget": 90}},
            "rows": rows}


class EditReportTest(ReportTest):
    report, data = REPORT, "edit.json"

    def page(self, data):
        (self.folder / self.data).write_text(json.dumps(data))
        return words_of(self.folder, "edit_data", "edit_page")

    def whole_page(self, data):
        (self.folder / self.data).write_text(json.dumps(data))
        result = subprocess.run([REPORT, self.folder], capture_output=True, text=True, check=False)
        self.assertEqual(result.returncode, 0, result.stderr)
        text = (self.folder / "report.html").read_text(encoding="utf-8")
        check_figures(self, self.folder, text)
        return text

    def test_says_what_was_found(self):
        page = self.whole_page(measured())
        worst = max(row["frame_ms"] / row["octree_ms"] for row in measured()["rows"])
        for said in (f"{worst:.2f}×", "6.60×", "23.7 %", "1.33×", "1 frame<", "120 of 120 pictures", "1.41×", "&lt;skull&gt;", "13 × 32",
                     "skipping: bitfield-octree", "skipping: proximity", "1.5 times the frame by"):
            self.assertIn(said, page)
        self.assertNotIn("<skull>", page)
        self.assertEqual(len(re.findall(r'<div class="wide"><svg', page)), 3)
        self.assertEqual(len(re.findall(r'<div class="narrow"><svg', page)), 3)
        self.assertEqual(re.findall(r'(?:src|href)="(?!#|data:)[^"]*"', page), [], "loads nothing from elsewhere")

    def test_names_what_frames_are_compared_with_and_what_served(self):
        page = self.page(measured())
        for said in ("of a frame by the bitfield octree at rest", "frames of edits: the bitfield octree (90 frames).",
                     "the bitfield octree (16 frames) and the proximity cloud (14 frames)", "it took over 2 times.",
                     ">bitfield octree, made beforehand<", "1.5 times the frame by the bitfield octree of the same view"):
            self.assertIn(said, page)

        data = measured()
        data["summary"]["compared_with"] = "partitioned"
        data["builds"]["always"]["structure"] = "partitioned"
        del data["builds"]["settled"]
        for row in data["rows"]:
            row["skip"] = "none" if row["edit"] else "partitioned"
        page = self.page(data)
        self.assertIn("frames of edits: nothing (90 frames). In those without: the partitioned maps (30 frames). The "
                      "partitioned maps serve under any transfer function, and nothing is rebuilt.", page)
        self.assertFalse("ctree" in page)  # nor all of the page in a complaint

    def test_a_budget_of_all_frames_is_named(self):
        data = measured()
        data["summary"]["budget_ms"] = 12
        for row in data["rows"]:
            row["budget_ms"] = 12
        self.assertIn("The dashed line is the budget: 12 ms, as asked for.", self.page(data))

    def test_without_edits_there_is_no_time_of_one(self):
        data = measured()
        data["summary"]["frames_to_correct"] = data["summary"]["edit_frame_ms"] = None
        for row in data["rows"]:
            row["edit"] = False
        page = self.page(data)
        self.assertNotIn("frames of edits:", page)
        self.assertNotIn("1 frame<", page)

    def test_survives_what_is_not_known(self):
        data = measured()
        del data["summary"]["frames_equal"], data["builds"], data["summary"]["budget_over_octree"], data["conditions"]
        for row in data["rows"]:
            row["counters"] = row["budget_ms"] = None
        page = self.page(data)
        self.assertIn("not compared: --verify does", page)
        self.assertEqual(len(re.findall(r'<div class="wide"><svg', page)), 2)

    def test_refuses_what_is_no_measurement(self):
        self.refusal("no such file")
        self.refusal("not JSON", "{")
        self.refusal("holds no rows", {"rows": []})
        data = measured()
        data["rows"][3]["octree_ms"] = 0
        self.refusal("rows[3]: octree_ms is 0", data)
        data["rows"][3]["octree_ms"] = "fast"
        self.refusal("rows[3]: octree_ms is no time", data)


if __name__ == "__main__":
    if len(sys.argv) == 2 and Path(sys.argv[1]).is_dir():
        (Path(sys.argv[1]) / "edit.json").write_text(json.dumps(measured()))
        sys.exit(subprocess.run([REPORT, sys.argv[1]], check=False).returncode)
    unittest.main()
