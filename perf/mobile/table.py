#!/usr/bin/env python3
"""What the segment shaders cost on mobile GPUs, by their open compilers, without a device.

usage: perf/mobile/table.py [--out DIR] [--gpu NAME,...] [--only REGEX | --rows] [--choices N] [--program FILE] [--print]
  --out DIR       mobile.json, mobile.csv, report.html and figures go there [build/mobile]
  --gpu NAMES     of the list in perf/mobile/gpus.py [all]
  --only REGEX    variants whose label it is found in, as '^post[+]balls[+]terminate/unroll16 shells$' [all]
  --rows          the variants that perf/mobile/rows.csv names, whether plans reach them or not
  --choices N     those that plans reach from settings with N choices other than the default, 1 to 3 [2]; all: every
                  variant there is
  --program FILE  slabcast-compile [build/bin/slabcast-compile]
  --print         a line per row on stdout, no files: for a look while a shader is changed
  --commit        to perf/mobile/table.csv, too: what tests compare with
Compilers that are missing are built first (perf/mobile/compilers.sh, about ten minutes each).
Exit status: 77 where they cannot be had here.
"""

import argparse
import shlex
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import gpus
import table_files
from compile_run import Broken, Known, compile_all, keys_of

ROOT = Path(__file__).resolve().parents[2]
PAGE = ROOT / "perf" / "pages" / "mobile_report.py"
GROUP_LAYERS = 8  # what a loop's body does at once


def per_layer(row, empty):
    """The cost of one layer: of straight-line code a share of all; of a loop what its body adds to it."""
    cost = row["fragment"]["cost"]
    if row["layers"] > 0:
        return round(cost / row["layers"], 4)
    if empty is None or "fragment" not in empty:
        return None
    return round((cost - empty["fragment"]["cost"]) / GROUP_LAYERS, 4)


def measured(name, program, keys, options, say, known=None):
    """The rows of one GPU, in the order of `keys` (keys_of())."""
    gpu = gpus.GPUS[name]
    rows = compile_all(gpu, program, keys, options, lambda count: say(f"{gpu.title}: {count} of {len(keys)}"), known)
    hollow = [*options, "--empty-loops"]
    loops = {label for label in keys if rows[label].get("layers") == 0}
    loops = {label: key for label, key in keys_of(program, hollow).items() if label in loops} if loops else {}
    empty = compile_all(gpu, program, loops, hollow, known=known)
    for label in keys:
        row = rows[label]
        row["gpu"] = name
        if "fragment" in row:
            row["layer"] = {"cost": per_layer(row, empty.get(label))}
    return [rows[label] for label in keys]


def line_of(row):
    if "failed" in row:
        return f"{row['gpu']:10} {row['variant']:48} failed: {row['failed']}"
    figures = " ".join(f"{name} {value:g}" for name, value in row["fragment"].items() if name not in ("cost", "unit"))
    layer = row["layer"]["cost"]
    return (f"{row['gpu']:10} {row['variant']:48} {row['fragment']['cost']:8g} {row['fragment']['unit']} "
            f"| layer {'-' if layer is None else f'{layer:g}'} | {figures}")


def commit_of(root):
    """Of the sources, with a plus where they were changed since."""
    def git(*words):
        return subprocess.run(["git", "-C", root, *words], capture_output=True, text=True).stdout.strip()
    return git("rev-parse", "--short", "HEAD") + ("+" if git("status", "--porcelain", "-uno") else "")


def head_of(given):
    """What was run, when, of which sources, and by which compilers."""
    return {"command": shlex.join(["perf/mobile/table.py", *sys.argv[1:]]), "commit": commit_of(ROOT),
            "date": time.strftime("%Y-%m-%dT%H:%M:%SZ", time.gmtime()),
            "device": {"renderer": "none: compilers only", "version": ", ".join(sorted(
                {gpus.MESAS[gpus.GPUS[name].mesa] for name in given.gpu}))},
            "named": table_files.named_rows(), "before": table_files.read_json_rows(table_files.BEFORE),
            "gpus": {name: {"title": gpus.GPUS[name].title, "family": gpus.GPUS[name].family,
                            "cache_bytes": gpus.GPUS[name].cache_bytes,
                            "mesa": gpus.MESAS[gpus.GPUS[name].mesa]} for name in given.gpu}}


def arguments():
    parser = argparse.ArgumentParser(usage=__doc__.split("usage: ")[1], add_help=False)
    parser.add_argument("--out", type=Path, default=ROOT / "build" / "mobile")
    parser.add_argument("--gpu", default=",".join(gpus.GPUS))
    parser.add_argument("--only", default="")
    parser.add_argument("--rows", action="store_true")
    parser.add_argument("--choices", default="2", choices=("1", "2", "3", "all"))
    parser.add_argument("--program", type=Path, default=ROOT / "build" / "bin" / "slabcast-compile")
    parser.add_argument("--print", action="store_true")
    parser.add_argument("--commit", action="store_true")
    given = parser.parse_args()
    given.gpu = given.gpu.split(",")
    for name in given.gpu:
        if name not in gpus.GPUS:
            parser.error(f"--gpu: '{name}' is not one of {', '.join(gpus.GPUS)}")
    if not given.program.exists():
        parser.error(f"--program: {given.program} is not there: build it, as target slabcast-compile")
    return given


def chosen(given, options):
    """{label: key}. Raises Broken where nothing fits."""
    if given.rows:
        return named(keys_of(given.program, options), "before", "general", "lean")
    return keys_of(given.program, [*options, *(["--only", given.only] if given.only else [])])


def named(keys, *columns):
    """Of all keys those that these columns of rows.csv name."""
    return {label: keys[label] for label in table_files.named_labels(*columns) if label in keys}


def write(given, rows):
    given.out.mkdir(parents=True, exist_ok=True)
    table_files.write_whole(given.out / "mobile.json", table_files.json_of(head_of(given), rows))
    table_files.write_whole(given.out / "mobile.csv", table_files.csv_of(rows))
    if given.commit:
        table_files.write_whole(table_files.COMMITTED, table_files.csv_of(rows))
    return subprocess.run(["/usr/bin/python3", PAGE, given.out]).returncode


def main():
    given = arguments()
    options = ["--choices", "all" if given.rows else given.choices]
    say = (lambda text: None) if given.print else (lambda text: print(text, file=sys.stderr, flush=True))
    try:
        keys = chosen(given, options)
        for mesa in sorted({gpus.GPUS[name].mesa for name in given.gpu}):
            gpus.build_folder(mesa)
        with ThreadPoolExecutor() as pool:
            parts = list(pool.map(lambda name: measured(
                name, given.program, keys, options, say, Known(gpus.cache() / f"costs-{name}.jsonl")), given.gpu))
    except gpus.NoCompilers as error:
        print(f"table: {error}", file=sys.stderr)
        return 77
    except Broken as error:
        print(f"table: {error}", file=sys.stderr)
        return 1
    rows = [row for part in parts for row in part]
    if given.print:
        print("\n".join(map(line_of, rows)))
        return 0
    return write(given, rows)


if __name__ == "__main__":
    sys.exit(main())
