#!/usr/bin/env python3
"""How empty space is skipped, as the command line takes it and tells of it.

usage: cli_skip_test.py SLABCAST [arguments of unittest]
"""

import json
import re
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "support"))
import cli_files as files  # noqa: E402
from cli_case import PHANTOM, POINT, QUICK, CliTest, main  # noqa: E402

GRIDS = ("blocks", "proximity", "chebyshev", "partitioned")
OCTREES = ("boolean-octree", "minmax-octree", "bitfield-octree")
STRUCTURES = GRIDS + OCTREES
EDGES = {"blocks": (1, 2, 4, 8, 16, 32), **dict.fromkeys(GRIDS[1:], (1, 2, 4, 8)),
         **dict.fromkeys(OCTREES, (2, 4, 8, 16, 32, 64))}
# Of each option: a word, its key in statistics and value there, the structures that have a use for it.
PARAMETERS = {
    "--skip-bits": ("64", "skip_bits", 64, ("bitfield-octree",)),
    "--partitions": ("32", "partitions", 32, ("partitioned",)),
    "--separate-minimum": ("on", "separate_minimum", True, ("partitioned", "bitfield-octree")),
    "--value-range": ("10,200", "value_range", [10, 200], ("partitioned", "bitfield-octree")),
    "--initial-level": ("1", "initial_level", 1, OCTREES),
    "--traversal": ("top-down", "traversal", "top-down", OCTREES),
}


def either(names):
    return " or ".join(filter(None, (", ".join(names[:-1]), names[-1])))


def render(*arguments):
    return ("render", PHANTOM, "-o", "p.png", *QUICK, *map(str, arguments))


class Parameters(CliTest):
    def test_block_edges_are_those_of_the_structure(self):
        cases = []
        for structure, edges in EDGES.items():
            for edge in {1, 2, 4, 8, 16, 32, 64} - set(edges):
                offered = ", ".join(map(str, edges))
                cases.append((render("--skip", structure, "--skip-block", edge),
                              f"--skip-block: '{edge}' is not one of {offered}, as {structure} takes"))
        cases.append((render("--skip-block", 16), "--skip-block: '16' is not one of 1, 2, 4, 8, as proximity takes; "
                      "--skip is auto, which takes proximity"))
        self.all_misused(cases)

    def test_values_that_no_structure_takes(self):
        bad = {"--skip-block": "5", "--partitions": "7", "--skip-bits": "12", "--initial-level": "40",
               "--traversal": "sideways", "--value-range": "200,10", "--separate-minimum": "2", "--skip-builder": "tpu"}
        self.all_misused([(render(flag, word), f"{flag}: '{word}' is not .+") for flag, word in bad.items()])

    def test_options_without_a_use_are_refused(self):
        cases = []
        for flag, (word, _, _, users) in PARAMETERS.items():
            for structure in set(STRUCTURES) - set(users):
                cases.append((render("--skip", structure, flag, word),
                              f"{flag}: is of {either(users)}; --skip is {structure};"))
            cases.append((render(flag, word), f"{flag}: is of .*; --skip is auto, which takes proximity;"))
        for flag, word in (("--skip-block", "64"), ("--skip-block", "4"), ("--skip-builder", "cpu")):
            cases.append((render("--skip", "none", "--tighten", "off", flag, word),
                          f"{flag}: is of blocks, proximity, .* or bitfield-octree; --skip is none;"))
        cases.append((("sweep", PHANTOM, "--out", "d", "--skip-bits", "64"), "--skip-bits: is of bitfield-octree"))
        cases.append((("error", PHANTOM, "--out", "d", "--skip-bits", "64"), "--skip-bits: is of bitfield-octree"))
        self.all_misused(cases)

    def test_edits_take_what_serves_them(self):
        def edit(*arguments):
            return ("edit", PHANTOM, "--out", "d", "--frames", "20", *map(str, arguments))
        self.all_misused([
            (edit("--skip", "none"), "--skip: 'none' is not one of auto, blocks, "),
            (edit("--skip", "boolean-octree"), "--skip: 'boolean-octree' is not one of auto, blocks, "),
            (edit("--skip-builder", "gpu"), "--skip-builder"),  # the CPU builds
            (edit("--background", "none"), "--background"),  # no picture is kept
            (edit("--partitions", 32),
             "--partitions: is of partitioned; --skip is auto, which takes bitfield-octree or proximity;"),
            (edit("--skip", "partitioned", "--skip-bits", 64),
             "--skip-bits: is of bitfield-octree; --skip is partitioned"),
            (edit("--skip-block", 1), "--skip-block: '1' is not one of 2, .*, as bitfield-octree takes"),
            (edit("--skip-block", 16), "--skip-block: '16' is not one of 1, .*, as proximity takes"),
        ])


class Told(CliTest):
    def test_statistics_name_the_structure_and_its_parameters(self):
        for structure in STRUCTURES:
            mine = {flag: given for flag, given in PARAMETERS.items() if structure in given[3]}
            words = [word for flag, (word, *_) in mine.items() for word in (flag, word)]
            with self.subTest(structure):
                skip = self.stats(PHANTOM, *QUICK, "--skip", structure, "--skip-block", "8", "--skip-builder", "cpu",
                                  *words)["skip"]
                self.assertEqual(skip["structure"], structure)
                self.assertEqual(skip["parameters"],
                                 {"skip_block": 8, **{key: value for _, key, value, _ in mine.values()}})
                self.assertEqual((skip["builder"], skip["skips"], skip["tightens"]), ("cpu", True, True))
                self.assertGreater(skip["build_ms"], 0)
                self.assertGreater(skip["gpu_bytes"], 0)
                # The host keeps a byte per block and partition: 3 blocks along each axis.
                self.assertEqual(skip["host_bytes"], 27 * 32 if structure == "partitioned" else 0)
                self.assertTrue(0 < skip["occupied_fraction"] <= 1)

    def test_occupied_fraction_is_that_of_the_blocks(self):
        """A voxel of 16 x 8 x 8, in its corner: of two blocks of 8, the one is occupied."""
        self.write("v.nrrd", files.nrrd("16 8 8", data=bytes([255] + [0] * 1023)))
        self.write("tf.json", json.dumps({"points": [{**POINT, "value": 100, "opacity": 0}, {**POINT, "value": 255}]}))
        skip = self.stats("v.nrrd", "--tf", "tf.json", *QUICK, "--skip", "blocks", "--skip-block", "8")["skip"]
        self.assertEqual(skip["occupied_fraction"], 0.5)

    def test_without_skipping_blocks_tighten_planes_or_nothing_is_built(self):
        skip = self.stats(PHANTOM, *QUICK, "--skip", "none")["skip"]
        self.assertEqual((skip["structure"], skip["skips"], skip["tightens"]), ("blocks", False, True))
        self.assertIsNone(self.stats(PHANTOM, *QUICK, "--skip", "none", "--tighten", "off")["skip"])

    def explained(self, *arguments):
        return self.succeeds(*render("--explain", *arguments))

    def test_explained_are_parameters_builder_and_cost(self):
        text = self.explained("--skip", "bitfield-octree", "--skip-bits", 64, "--skip-builder", "cpu")
        self.assertRegex(text, r"(?m)^skip structure: bitfield-octree --skip-block 4 --skip-bits 64 --separate-minimum "
                         r"off --initial-level 2 --traversal bidirectional, built on the CPU in [\d.e-]+ ms, "
                         r"[\d.e-]+ MiB on the GPU; at most [\d.]+ % of its leaves are occupied")
        self.assertRegex(text, r"(?m)^skip bitfield-octree: asked for; at most [\d.]+ % of the 4-voxel leaves hold")

    def test_auto_says_what_it_goes_by(self):
        sparse = ("render", "-o", "p.png", *self.sparse(), "--explain")
        text = self.succeeds(*sparse)
        occupied = re.search(r"(?m)^skip proximity: auto: only ([\d.]+) % of the 4-voxel blocks hold something visible "
                             r"under this transfer function, and planes of 16 layers \(.* pays from 4 on, as measured",
                             text)
        self.assertIsNotNone(occupied, text)
        skip = self.stats(*self.sparse())["skip"]
        self.assertAlmostEqual(float(occupied[1]), 100 * skip["occupied_fraction"], delta=0.05)
        slices = self.succeeds(*sparse[:-3], "--layers-per-plane", "2", "--explain")
        self.assertRegex(slices, r"(?m)^skip none: auto: planes of 2 layers \(.* pays from 4 on")
        self.write("full.json", json.dumps({"points": [POINT]}))
        self.assertRegex(self.explained("--tf", "full.json"),
                         r"(?m)^skip none: auto: 100 % of the 4-voxel blocks .*: above 95 % looks cost more")


if __name__ == "__main__":
    main(__doc__)
