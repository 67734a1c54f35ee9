#!/usr/bin/python3
"""perf/pages/mobile_report.py from a made-up table: what the page says, what it refuses, what it survives.

With a folder as its argument, writes the made-up table and its page there, to look at.
"""

import json
import re
import subprocess
import sys
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "support"))
from report_pages import ReportTest, check_figures, words_of  # noqa: E402

REPORT = Path(__file__).resolve().parent.parent.parent / "perf" / "pages" / "mobile_report.py"
LENGTHS = (1, 2, 4, 8, 12, 16, 24, 32, 48, 64)


def mali(layers, per_layer, texture):
    figures = {"cost": 3 + per_layer * layers, "unit": "arithmetic", "arithmetic": 3 + per_layer * layers,
               "texture": texture * layers, "instructions": 60 * layers, "quadwords": 70 * layers, "threads": 1,
               "loops": 0, "spills": 0, "fills": 0}
    return {"fragment": figures, "layer": {"cost": figures["cost"] / layers}}


def adreno(layers, per_layer):
    figures = {"cost": 100 + per_layer * layers, "unit": "instructions", "instructions": 100 + per_layer * layers,
               "nops": 20 * layers, "sy": layers, "fetches": 2 * layers, "full_registers": 9, "half_registers": 2,
               "waves": 1, "loops": 0, "spills": 1, "fills": 2, "code_bytes": 500 * layers}
    return {"fragment": figures, "layer": {"cost": figures["cost"] / layers}}


def rows(factor):
    made = []
    for layers in LENGTHS:
        for name, weight in (("post", 1), ("post+balls", 1.5), ("preclassified", 0.8)):
            of = {"variant": f"{name}/unroll{layers}", "layers": layers}
            made += [{"gpu": "g71", **of, **mali(layers, factor * weight, 1.0)},
                     {"gpu": "adreno740", **of, **adreno(layers, 30 * factor * weight)}]
    return made


def measured():
    return {"command": "perf/mobile/table.py --out <mobile>", "commit": "abc", "date": "2026-11-24T10:00:00Z",
            "device": {"renderer": "none: compilers only", "version": "Mesa 1, Mesa 2"},
            "gpus": {"g71": {"title": "Mali-G71", "family": "bifrost", "mesa": "Mesa 1", "cache_bytes": None},
                     "adreno740": {"title": "Adreno 740", "family": "adreno", "mesa": "Mesa 2", "cache_bytes": 4096}},
            "named": [{"row": "slicing, post", "before": "post/unroll1", "general": "post/unroll1", "lean": ""},
                      {"row": "16, post, proximity", "before": "post+balls/unroll16", "general": "post+balls/unroll16",
                       "lean": "preclassified/unroll16"}],
            "before": rows(4.0),
            "rows": [*rows(1.0), {"gpu": "g71", "variant": "post+fetch/loop", "layers": 0,
                                  "failed": 'program "post+fetch/loop": no <extension>'}]}


class MobileReportTest(ReportTest):
    report, data = REPORT, "mobile.json"

    def page(self, data):
        (self.folder / self.data).write_text(json.dumps(data))
        return words_of(self.folder, "mobile_data", "mobile_page")

    def test_says_what_was_found(self):
        (self.folder / self.data).write_text(json.dumps(measured()))
        result = subprocess.run([REPORT, self.folder], capture_output=True, text=True, check=False)
        self.assertEqual(result.returncode, 0, result.stderr)
        page = (self.folder / "report.html").read_text(encoding="utf-8")
        check_figures(self, self.folder, page)
        for said in ("27 cycles", "before: 99", "820 instructions", "before: 2,980", "820 <i>16 (sy)</i>", "27 <i>16 t</i>",
                     "9 full, 2 half, 1 wave", "1 thread", "1 : 2", "4 KiB: 2.0 times over", "4 KiB: fits", "not published",
                     "31 variants", "2 compilers", "1 row could not be compiled", "no &lt;extension&gt;", "now, lean",
                     "as post+fetch/loop", "post, proximity", "every other variant"):
            self.assertIn(said, page)
        self.assertNotIn("<extension>", page)
        self.assertEqual(len(re.findall(r'<div class="wide"><svg', page)), 2)
        self.assertEqual(re.findall(r'(?:src|href)="(?!#|data:)[^"]*"', page), [], "loads nothing from elsewhere")

    def test_survives_what_is_not_known(self):
        data = measured()
        del data["named"], data["before"], data["gpus"]["g71"]["cache_bytes"]
        page = self.page(data)
        self.assertNotIn("Before and after", page)
        self.assertEqual(len(re.findall(r'<div class="wide"><svg', page)), 1)
        data["rows"] = data["rows"][-1:]
        page = self.page(data)
        self.assertIn("could not be compiled", page)
        self.assertNotIn("<svg", page)

    def test_a_figure_that_a_compiler_does_not_give_is_missing(self):
        data = measured()
        for row in data["rows"]:
            for name in ("waves", "texture", "quadwords", "code_bytes"):
                row.get("fragment", {}).pop(name, None)
        self.assertIn("9 full, 2 half<", self.page(data))

    def test_refuses_what_is_no_table(self):
        self.refusal("perf/mobile/table.py --out")
        self.refusal("not JSON", "{")
        self.refusal("run `perf/mobile/table.py` again", {"rows": []})
        data = measured()
        data["rows"][3]["fragment"]["cost"] = "cheap"
        self.refusal("rows[3]: cost is no number", data)
        del data["rows"][3]["variant"]
        self.refusal("rows[3]: is no row of a variant", data)
        data = measured()
        del data["gpus"]["adreno740"]
        self.refusal("gpus does not say what adreno740 is", data)


if __name__ == "__main__":
    if len(sys.argv) == 2 and Path(sys.argv[1]).is_dir():
        (Path(sys.argv[1]) / "mobile.json").write_text(json.dumps(measured()))
        sys.exit(subprocess.run([REPORT, sys.argv[1]], check=False).returncode)
    unittest.main()
