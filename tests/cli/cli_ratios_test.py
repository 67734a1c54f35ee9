#!/usr/bin/env python3
"""How the program comes to a ratio of planes to layers that nobody named, and what it keeps of measuring.

usage: cli_ratios_test.py SLABCAST [arguments of unittest]
"""

import json
import re
import shutil
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "support"))
from cli_case import PHANTOM, CliTest, main  # noqa: E402

LAYERS = ("--layers", "8")  # planes are left open: few candidates, soon compiled
MEASURED = r"(?m)^ratio ([^:]+): fastest of those measured on this device: (.+)$"


class Ratios(CliTest):
    @classmethod
    def setUpClass(cls):
        cls.compiled = Path(tempfile.mkdtemp(prefix="slabcast_shaders_"))  # by the driver: for all tests
        cls.addClassCleanup(shutil.rmtree, cls.compiled)

    def env(self, **more):
        return {"XDG_CACHE_HOME": str(self.folder / "cache"), "MESA_SHADER_CACHE_DIR": str(self.compiled), **more}

    def tables(self):
        return list((self.folder / "cache" / "slabcast").glob("ratio-table-*.json"))

    def scenes(self):
        (table,) = self.tables()
        return json.loads(table.read_text())["scenes"]

    def turn(self, *arguments, volume=PHANTOM, size="64x64", notes="", **more):
        """What is explained of several frames."""
        return self.succeeds("render", volume, "-o", "p.png", "--frames", "2", "--stats", "s.json", "--explain",
                             "--size", size, *LAYERS, *arguments, env=self.env(**more), notes=notes)

    def shaders(self, *arguments):
        """How many texts a render gives to the driver."""
        dump = self.folder / "shaders"
        dump.mkdir()
        self.picture(PHANTOM, "--size", "64x64", "--stats", "s.json", *LAYERS, *arguments,
                     env=self.env(MESA_SHADER_DUMP_PATH=str(dump), MESA_SHADER_CACHE_DISABLE="true"))
        count = 0
        for path in dump.iterdir():
            path.unlink()
            count += 1
        dump.rmdir()
        return count

    def test_a_still_picture_is_the_same_in_every_run_and_measures_nothing(self):
        def still():
            picture = self.picture(PHANTOM, "--size", "64x64", "--stats", "s.json", *LAYERS, env=self.env())
            return picture, json.loads((self.folder / "s.json").read_text())["plan"]

        first = still()
        self.assertEqual([reason["why"] for reason in first[1]["reasons"] if reason["what"] == "ratio 1x8 loop"],
                         ["nothing was measured: a software driver loops over whole rays, which says nothing of a GPU"])
        self.assertEqual(self.tables(), [])
        self.turn()
        (table,) = self.tables()
        slow = table.read_text().replace('"frame_ms": ', '"frame_ms": 1e-9, "was": ', 1)  # what is kept is not a still
        table.write_text(slow)                                                            # picture's
        self.assertEqual(still(), first)

    def test_a_still_picture_compiles_no_candidates(self):
        asked = self.shaders("--planes", "1", "--form", "loop")
        if asked == 0:
            self.skipTest("this driver writes no shaders to MESA_SHADER_DUMP_PATH: nothing to count")
        self.assertEqual(self.shaders(), asked)
        self.assertGreater(self.shaders("--frames", "2"), asked)
        self.assertEqual(self.shaders("--frames", "2", "--planes", "1", "--form", "loop"), asked)

    def test_frames_take_the_fastest_ratio_measured_once(self):
        text = self.turn()
        chosen, measured = re.search(MEASURED, text).groups()
        times = {name: float(ms) for name, ms in re.findall(r"(\d+x\d+ \w+) ([\d.e-]+) ms", measured)}
        self.assertGreaterEqual(len(times), 2)  # measuring stops at a ratio that is hopelessly slow
        self.assertEqual(times[chosen], min(times.values()))
        self.assertRegex(text, r"(?m)^ratios: measured now, kept in \S+ratio-table-\S+\.json$")
        (scene,) = self.scenes()
        again = self.turn()
        self.assertEqual(re.search(MEASURED, again)[0], re.search(MEASURED, text)[0])
        self.assertIn(f"ratios: measured {scene['date']}, kept in ", again)
        self.assertEqual(self.scenes(), [scene])

    def test_what_is_kept_decides(self):
        self.turn()
        (table,) = self.tables()
        content = json.loads(table.read_text())
        content["scenes"][0]["ratios"].append({"planes": 4, "layers_per_plane": 2, "unrolled": True, "frame_ms": 1e-6})
        table.write_text(json.dumps(content))
        self.assertIn("ratio 4x2 unrolled: fastest", self.turn())

    def test_what_is_kept_is_of_one_scene_its_view_and_its_settings(self):
        self.turn()
        others = ({"volume": "phantom:shells:16"}, ("--tf", "mr"), ("--camera", "1,2,3"), ("--termination", "off"),
                  {"size": "48x64"}, ("--stereo", "60"))
        for count, other in enumerate(others, start=2):
            text = self.turn(**other) if isinstance(other, dict) else self.turn(*other)
            self.assertIn("ratios: measured now", text)
            self.assertEqual(len({scene["key"] for scene in self.scenes()}), count)
        self.assertIn("ratios: measured now", self.turn(SLABCAST_MASK_EXTENSIONS="mobile-strict"))  # another device

    def test_a_damaged_table_is_said_and_replaced(self):
        self.turn()
        (table,) = self.tables()
        whole = json.loads(table.read_text())
        bad = dict(whole["scenes"][0], ratios=[{"planes": 0, "layers_per_plane": 1, "unrolled": False, "frame_ms": 1}])
        for content in (table.read_text()[:-20], "[1]", json.dumps(dict(whole, version=99)),
                        json.dumps(dict(whole, scenes=[bad]))):
            table.write_text(content)
            text = self.turn(notes=r"slabcast: \S+ratio-table-\S+: no table of measured ratios [^\n]+ anew\n")
            self.assertIn("ratios: measured now", text)
            self.assertEqual(len(self.scenes()), 1)
            self.assertIn("ratios: measured 20", self.turn())

    def test_where_nothing_can_be_kept_it_is_measured_all_the_same(self):
        self.write("cache/slabcast", "no folder")
        text = self.turn(notes=r"slabcast: [^\n]*not kept[^\n]*\n")
        self.assertIn("ratios: measured now, not kept", text)
        text = self.turn(notes=r"slabcast: [^\n]*set XDG_CACHE_HOME or HOME\n", XDG_CACHE_HOME="", HOME="")
        self.assertRegex(text, r"(?m)^ratios: measured now$")

    def test_a_sweep_keeps_what_it_measured(self):
        scene = (*self.sparse()[:3], "--size", "64x64")
        self.succeeds("sweep", *scene, "--layers", "8,16", "--form", "loop", "--frames", "3", "--out", "sweep",
                      env=self.env(), notes=r"[^\n]*report\.html\n")
        (kept,) = self.scenes()
        rows = json.loads((self.folder / "sweep" / "sweep.json").read_text())["rows"]
        tight = {row["layers_per_plane"]: row["frame_ms"]["median"] for row in rows if row["tighten"]}
        self.assertEqual({one["layers_per_plane"]: one["frame_ms"] for one in kept["ratios"]}, tight)
        text = self.succeeds("render", *scene, "-o", "p.png", "--form", "loop", "--frames", "2", "--stats", "s.json",
                             "--explain", env=self.env())
        self.assertIn(f"ratios: measured {kept['date']}, kept in ", text)


if __name__ == "__main__":
    main(__doc__)
