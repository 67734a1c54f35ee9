#!/usr/bin/env python3
"""Holds the committed table of perf/mobile: no named variant may cost a phone's GPU 2 % more than it says.

usage: mobile_costs_test.py SLABCAST_COMPILE     exit status 77 where Debian 12's compilers were not made
"""

import sys
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "perf" / "mobile"))
import gpus  # noqa: E402
import table_files  # noqa: E402
from compile_run import keys_of  # noqa: E402
from table import measured, named  # noqa: E402

GPUS = ("g71", "g57", "adreno660")
TOLERANCE = 1.02
# What a fragment costs, and what else must not grow: an Adreno's waits, what does not fit registers, a loop's layer.
WATCHED = ("cost", "cost_per_layer", "sy", "spills", "fills")


def found(row, name):
    """A watched figure of a compiled row; None where the compiler gives none."""
    if name == "cost_per_layer":
        return row["layer"]["cost"] if row["layers"] == 0 else None
    return row["fragment"].get(name)


def dearer(row, committed):
    """Why this row is dearer than the committed one, or None."""
    name = f"{row['variant']} on {gpus.GPUS[row['gpu']].title}"
    if "failed" in row:
        return f"{name}: {row['failed']}"
    if committed is None or not committed["cost"]:
        return f"{name}: not in {table_files.COMMITTED.name}; make it again with perf/mobile/table.py --commit"
    for figure in WATCHED:
        now, before = found(row, figure), committed[figure]
        if now is not None and before and now > TOLERANCE * float(before):
            return f"{name}: {figure} {now:g}, was {before}"
    return None


class MobileCosts(unittest.TestCase):
    program = None

    def test_named_variants_cost_no_more_than_the_table_says(self):
        committed = table_files.read_csv(table_files.COMMITTED)
        # Of every variant there is, whatever plans come to prefer.
        options = ["--choices", "all"]
        keys = named(keys_of(self.program, options), "general", "lean")
        self.assertEqual(list(keys), table_files.named_labels("general", "lean"), "rows.csv names what is not there")
        self.assertGreater(len(keys), 5)
        rows = [row for name in GPUS for row in measured(name, self.program, keys, options, lambda text: None)]
        found = [why for row in rows if (why := dearer(row, committed.get((row["gpu"], row["variant"]))))]
        self.assertFalse(found, "\n" + "\n".join(found))


class Comparison(unittest.TestCase):
    def row(self, **figures):
        return {"gpu": "adreno660", "variant": "post/unroll16", "layers": 16, "layer": {"cost": 1.0},
                "fragment": {"cost": 100, "sy": 4, **figures}}

    def test_more_than_two_in_a_hundred_is_dearer(self):
        committed = {"cost": "100", "cost_per_layer": "6.25", "sy": "4", "spills": "0", "fills": "0"}
        self.assertIsNone(dearer(self.row(cost=102), committed))
        self.assertIsNone(dearer(self.row(cost=50, sy=1), committed))
        self.assertIn("post/unroll16 on Adreno 650/660: cost 103, was 100", dearer(self.row(cost=103), committed))
        self.assertIn("sy 5, was 4", dearer(self.row(sy=5), committed))
        self.assertIn("spills 1, was 0", dearer(self.row(spills=1), committed))
        self.assertIn("not in table.csv", dearer(self.row(), None))
        self.assertIn("it broke", dearer({**self.row(), "failed": "it broke"}, committed))

    def test_a_loop_is_held_to_its_layer(self):
        committed = {"cost": "100", "cost_per_layer": "1", "sy": "", "spills": "", "fills": ""}
        loop = {**self.row(), "layers": 0, "layer": {"cost": 1.1}}
        self.assertIn("cost_per_layer 1.1, was 1", dearer(loop, committed))
        self.assertIsNone(dearer({**loop, "layer": {"cost": 1.0}}, committed))


if __name__ == "__main__":
    MobileCosts.program = sys.argv.pop(1)
    if not gpus.present("22"):
        print("skipped: Debian 12's compilers are not here; perf/mobile/compilers.sh 22 makes them")
        sys.exit(77)
    unittest.main()
