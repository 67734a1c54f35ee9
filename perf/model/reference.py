#!/usr/bin/env python3
"""Writes reference_work.inc, the counted work that core/plan/known_gpus.h is reckoned from, out of two reports.

usage: perf/model/reference.py SKULL FULL
  SKULL  folder of `slabcast model` on the demo's skull
  FULL   folder of `slabcast model` on a volume of which all is visible
A line is a ratio at the eye buffers of the first headset; perf/model/reference_work.cpp says what its numbers are.
"""

import json
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "mobile"))
from table_files import write_whole  # noqa: E402

WAVES = ("wave_4", "wave_8", "wave_16", "wave_64")  # pixels


def lines(scene, folder):
    report = json.loads((Path(folder) / "model.json").read_text(encoding="utf-8"))
    headset = report["headsets"][0]
    pixels = 2 * headset["eye_pixels"][0] * headset["eye_pixels"][1]
    for row in headset["rows"]:
        layers = 0 if row["planes"] == 1 else row["layers_per_plane"]
        numbers = [layers, row["total_layers"], pixels, row["fragments"], row["rays"], row["layers_evaluated"],
                   row["volume_fetches"], row["skip_fetches"], row["volume_bytes"]]
        for wave in WAVES:
            numbers += row["divergence_by_wave"][wave]
        yield ",".join([scene, *(f"{number:.6g}" for number in numbers)])


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__.split("\n\n")[1])
    all_lines = [*lines("skull", sys.argv[1]), *lines("full", sys.argv[2])]
    write_whole(HERE / "reference_work.inc", 'R"work(\n' + "\n".join(all_lines) + '\n)work"\n')


if __name__ == "__main__":
    main()
