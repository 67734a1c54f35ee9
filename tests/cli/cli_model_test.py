#!/usr/bin/env python3
"""`slabcast model` as a process: what it predicts is whole, labelled, and of the model alone.

usage: cli_model_test.py SLABCAST [arguments of unittest]
"""

import json
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "support"))
from cli_case import CliTest, main  # noqa: E402
from report_keys import odd_keys, undocumented_keys  # noqa: E402


class Model(CliTest):
    def test_headsets_and_the_papers_figures(self):
        text = self.succeeds("model", "phantom:shells:16", "--layers", "1,8,0", "--out", "m")
        for line in text.splitlines():
            self.assertRegex(line, r"\Amodel: ")
        report = json.loads((self.folder / "m" / "model.json").read_text())
        self.assertEqual(odd_keys(report), [])
        self.assertEqual(undocumented_keys(report, "model"), [])
        self.assertEqual([headset["name"] for headset in report["headsets"]], ["Quest 2", "Quest 3", "Galaxy S8"])
        for headset in report["headsets"]:
            rows = headset["rows"]
            self.assertEqual([row["layers_per_plane"] for row in rows][:2], [1, 8])
            self.assertEqual(rows[2]["planes"], 1)
            self.assertEqual(headset["best"], min(rows, key=lambda row: row["frame_ms"]))
            for row in rows:
                self.assertTrue(0 < row["low_ms"] <= row["frame_ms"] <= row["high_ms"])
                parts = {"instructions": "issue_ms", "texture": "texture_ms", "fragments": "fragment_ms",
                         "blending": "blend_ms", "memory": "memory_ms"}
                busiest = max(row[part] for part in parts.values())
                self.assertEqual(row[parts[row["limit"]]], busiest)
                self.assertAlmostEqual(row["frame_ms"], busiest + row["code_low_ms"], places=9)
                self.assertGreaterEqual(row["layer_divergence"], 1.0)
        paper = report["paper"]
        self.assertEqual([figure["published_fps"] for figure in paper["figures"]], [4.7, 8.5, 13.9, 36.0])
        self.assertTrue(all(figure["model_fps"] > 0 for figure in paper["figures"]))

    def test_what_it_has_no_use_for(self):
        self.fails("model", "phantom:shells:16", "--out", "m", "--size", "64x64", cause="--size: has no effect here",
                   remedy="headsets", status=2)


if __name__ == "__main__":
    main(__doc__)
