#!/usr/bin/env python3
"""Writes segment_costs.inc, what the model reckons with: whole segment shaders by mobile compilers, a line each.

usage: perf/model/costs.py [--program FILE] [--check]
  --program FILE  slabcast-compile [build/bin/slabcast-compile]
  --check         compare with the file that is there, write nothing; exit status 1 where they differ
A line: GPU, variant, slots, fetches, bytes of code. Slots are what the compiler issues for one fragment: tuples of a
Bifrost, of a Valhall its busiest arithmetic unit in multiply-adds, instructions of an Adreno. Mesa gives cycles of a
Mali by one set of rates for all of a family; they are taken out here, and gpu_rates.cpp has each GPU's own.
Compilers that are missing are built first (perf/mobile/compilers.sh). Exit status: 77 where they cannot be had here.
"""

import argparse
import re
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "mobile"))
import gpus  # noqa: E402
from compile_run import Broken, compile_all, keys_of  # noqa: E402
from table_files import write_whole  # noqa: E402

MADE = HERE / "segment_costs.inc"
GPUS = ("g71", "g52", "g57", "adreno630", "adreno660", "adreno740")  # the compilers of gpu_rates.cpp
# Parts come from two lengths, with and without skipping; slices and short segments stand for themselves. Of every
# variant there is; light, texels that are fetched one by one, jitter, structures that nobody gets unasked, and shells
# whose layers' opacity is not in a table are left out.
FORMS = re.compile(r"/(unroll1|unroll2|unroll4|unroll8|unroll16|loop)( shells)?$")
LEFT_OUT = re.compile(r"[+](exact|shaded|counts|boxes|[a-z-]*octree)|^(post|preclassified)(?!.*[+]baked).* shells$")
# Per cycle, as Mesa's statistics have it (bi_print_stats, va_print_stats).
MESA_ISSUES = {"bifrost": 24, "valhall": 64}
MESA_TEXELS = {"bifrost": 2, "valhall": 4}


def line_of(gpu, row):
    """None where the compiler gave up."""
    figures = row.get("fragment")
    if figures is None:
        return None
    if gpu.family == "adreno":
        slots, fetches, code = figures["instructions"], figures["fetches"], figures["code_bytes"]
    else:
        slots = round(figures["arithmetic"] * MESA_ISSUES[gpu.family], 2)
        fetches = round(figures["texture"] * MESA_TEXELS[gpu.family], 2)
        code = 16 * figures["quadwords"]
    return f"{gpu.name},{row['variant']},{slots:g},{fetches:g},{code:g}"


def lines(program):
    keys = {label: key for label, key in keys_of(program, ["--choices", "all"]).items()
            if FORMS.search(label) and not LEFT_OUT.search(label)}

    def of(name):
        gpu = gpus.GPUS[name]
        rows = compile_all(gpu, program, keys, ["--choices", "all"],
                           lambda count: print(f"{gpu.title}: {count} of {len(keys)}", file=sys.stderr, flush=True))
        return [line_of(gpu, rows[label]) for label in keys]

    for mesa in sorted({gpus.GPUS[name].mesa for name in GPUS}):
        gpus.build_folder(mesa)
    with ThreadPoolExecutor(2) as pool:
        return [line for part in pool.map(of, GPUS) for line in part if line is not None]


def main():
    parser = argparse.ArgumentParser(usage=__doc__.split("usage: ")[1], add_help=False)
    parser.add_argument("--program", type=Path, default=HERE.parents[1] / "build" / "bin" / "slabcast-compile")
    parser.add_argument("--check", action="store_true")
    given = parser.parse_args()
    if not given.program.exists():
        parser.error(f"--program: {given.program} is not there: build it")
    try:
        made = 'R"costs(\n' + "\n".join(lines(given.program)) + '\n)costs"\n'
    except (gpus.NoCompilers, Broken) as error:
        print(f"costs: {error}", file=sys.stderr)
        return 77 if isinstance(error, gpus.NoCompilers) else 1
    if not given.check:
        write_whole(MADE, made)
        return 0
    same = MADE.read_text(encoding="utf-8") == made
    print(f"costs: {MADE.name} is {'as' if same else 'not what'} the compilers have it", file=sys.stderr)
    return 0 if same else 1


if __name__ == "__main__":
    sys.exit(main())
