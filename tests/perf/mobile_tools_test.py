#!/usr/bin/env python3
"""perf/mobile's tools without a compiler: what is read from its words, and what is survived."""

import os
import sys
import tempfile
import unittest
from pathlib import Path
from unittest import mock

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "perf" / "mobile"))
import compile_run  # noqa: E402
import gpus  # noqa: E402
import table_files  # noqa: E402
from compiler_output import fragment_figures  # noqa: E402
from table import per_layer  # noqa: E402

BIFROST = ("SHADER-DB: MESA_SHADER_FRAGMENT shader: 3124 inst, 2170 tuples, 424 clauses, 88.333336 cycles, 88.333336 "
           "arith, 32.500000 texture, 0.125000 vary, 0.000000 ldst, 1949 quadwords, 1 threads, 0 loops, 2:3 spills:fills")
VALHALL = ("SHADER-DB: MESA_SHADER_FRAGMENT shader: 270 inst, 2.062500 cycles, 2.062500 fma, 1.843750 cvt, 1.000000 "
           "sfu, 0.125000 v, 4.250000 t, 0.000000 ls, 136 quadwords, 2 threads, 0 loops, 0:0 spills:fills")
ADRENO = ("FRAG shader: 283 inst, 91 nops, 192 non-nops, 8 mov, 9 cov, 448 dwords, 0 last-baryf, 0 half, 5 full, "
          "24 constlen, 94 cat0, 17 cat1, 139 cat2, 25 cat3, 5 cat4, 3 cat5, 0 cat6, 0 cat7, 0 stp, 0 ldp, 0 sstall, "
          "5 (ss), 65 systall, 2 (sy), 12 waves, 0 loops\n")

# Compiles what it is asked for: "good" well, at "crash" it ends by a signal, at "hang" it says nothing more.
PROGRAM = """#!/usr/bin/env python3
import json, os, signal, sys, time
if "--list" in sys.argv:
    print("0123 good/unroll4 shells")
    sys.exit(0)
for label in sys.stdin.read().splitlines():
    print(json.dumps({"variant": label, "layers": 4}), file=sys.stderr, flush=True)
    if label == "crash":
        os.kill(os.getpid(), signal.SIGSEGV)
    if label == "hang":
        time.sleep(60)
    if label == "unknown":
        print(json.dumps({"variant": label, "failed": "no plan reaches it"}), file=sys.stderr)
    elif label != "silent":
        print("SHADER-DB: MESA_SHADER_VERTEX shader: 9999 inst, 9.0 cycles, 9.0 arith, 0:0 spills:fills", file=sys.stderr)
        print(%r, file=sys.stderr)
        print("SHADER-DB: MESA_SHADER_FRAGMENT shader: 7 inst, 1.0 cycles, 1.0 arith, 0:0 spills:fills", file=sys.stderr)
print(json.dumps({"end": True}), file=sys.stderr)
""" % BIFROST


class Words(unittest.TestCase):
    def test_the_busiest_unit_of_a_mali_is_the_cost(self):
        found = fragment_figures(BIFROST, None)
        self.assertEqual((found["cost"], found["unit"], found["texture"], found["instructions"], found["quadwords"]),
                         (88.3333, "arithmetic", 32.5, 3124, 1949))
        self.assertEqual((found["spills"], found["fills"], found["threads"]), (2, 3, 1))
        found = fragment_figures(VALHALL, None)
        self.assertEqual((found["cost"], found["unit"], found["arithmetic"], found["threads"]), (4.25, "texture", 2.0625, 2))

    def test_instructions_are_the_cost_of_an_adreno(self):
        found = fragment_figures("", ADRENO)
        self.assertEqual((found["cost"], found["nops"], found["sy"], found["fetches"], found["full_registers"],
                          found["waves"], found["code_bytes"]), (283, 91, 2, 3, 5, 12, 1792))

    def test_other_lines_are_no_figures(self):
        for line in ("", "slabcast: hello", BIFROST.replace("FRAGMENT", "VERTEX"), "MESA: info: export failed"):
            self.assertIsNone(fragment_figures(line, None))
        self.assertIsNone(fragment_figures("", ADRENO.replace("FRAG", "VERT")))

    def test_a_layer_is_a_share_or_what_a_body_adds(self):
        self.assertEqual(per_layer({"layers": 16, "fragment": {"cost": 24}}, None), 1.5)
        self.assertEqual(per_layer({"layers": 0, "fragment": {"cost": 24}}, {"fragment": {"cost": 8}}), 2.0)
        self.assertIsNone(per_layer({"layers": 0, "fragment": {"cost": 24}}, {"failed": "no body"}))


class Runs(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.program = Path(temporary.name, "program")
        self.program.write_text(PROGRAM)
        self.program.chmod(0o755)
        for patch in (mock.patch.object(gpus, "command", lambda gpu, program, words: ([program, *words], os.environ)),
                      mock.patch.object(compile_run, "PATIENCE_S", 5)):
            patch.start()
            self.addCleanup(patch.stop)

    def compiled(self, *labels):
        return compile_run.compile_all(gpus.GPUS["g71"], self.program, {label: "-" for label in labels})

    def test_rows_come_in_spite_of_crashes_and_hangs(self):
        rows = self.compiled("a", "crash", "b", "hang", "c", "unknown", "silent")
        self.assertEqual(list(rows), ["a", "crash", "b", "hang", "c", "unknown", "silent"])
        for label in "abc":
            self.assertEqual(rows[label]["fragment"]["instructions"], 3124)
            self.assertNotIn("failed", rows[label])
        for label, why in (("crash", "status -11"), ("hang", "took more than 5 s"), ("unknown", "no plan reaches"),
                           ("silent", "gave no figures")):
            self.assertIn(why, rows[label]["failed"])
            self.assertNotIn("fragment", rows[label])

    def test_a_program_that_compiles_nothing_is_an_error(self):
        self.program.write_text("#!/bin/sh\necho 'slabcast-compile: no context' >&2\nexit 1\n")
        with self.assertRaisesRegex(compile_run.Broken, "Mali-G71: slabcast-compile: no context"):
            self.compiled("a")

    def test_labels_and_keys_are_asked_of_the_program(self):
        self.assertEqual(compile_run.keys_of(self.program, []), {"good/unroll4 shells": "0123"})

    def test_what_was_compiled_is_known_again_by_its_text(self):
        file = self.program.parent / "costs.jsonl"
        gpu, keys = gpus.GPUS["g71"], {"a": "1", "b": "2", "crash": "3"}
        first = compile_run.compile_all(gpu, self.program, keys, known=compile_run.Known(file))
        with file.open("a") as damaged:
            damaged.write('{"cut sho')
        self.program.write_text(PROGRAM.replace("3124 inst", "1 inst"))
        again = compile_run.compile_all(gpu, self.program, {"renamed": "1", "b": "4", "crash": "3"},
                                        known=compile_run.Known(file))
        self.assertEqual(again["renamed"], {**first["a"], "variant": "renamed"})
        self.assertEqual(again["b"]["fragment"]["instructions"], 7)  # another text
        self.assertIn("failed", again["crash"])  # tried again


class Files(unittest.TestCase):
    def test_a_table_is_read_as_it_was_written(self):
        rows = [{"gpu": "g71", "variant": "post/unroll16", "layers": 16, "fragment": fragment_figures(BIFROST, None),
                 "layer": {"cost": 5.5208}},
                {"gpu": "g71", "variant": "post+fetch/loop", "layers": 0, "failed": 'no "fetch", here'}]
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder, "table.csv")
            self.assertEqual(table_files.read_csv(path), {})
            table_files.write_whole(path, table_files.csv_of(rows))
            read = table_files.read_csv(path)
            self.assertEqual(read["g71", "post/unroll16"]["cost"], "88.3333")
            self.assertEqual(read["g71", "post+fetch/loop"]["failed"], 'no "fetch", here')
            again = table_files.read_json_rows(path)
        self.assertEqual(len(again), 1)
        self.assertEqual(again[0]["fragment"]["texture"], 32.5)
        self.assertEqual(again[0]["layer"]["cost"], 5.5208)

    def test_named_rows_are_in_the_committed_tables(self):
        before = table_files.read_csv(table_files.BEFORE)
        for row in table_files.named_rows():
            self.assertIn(("g71", row["before"]), before, row["row"])


if __name__ == "__main__":
    unittest.main()
