"""Compiles variants under a GPU's compiler; goes on where a compiler gives up or hangs, and says so in that row."""

import json
import os
import signal
import subprocess
import tempfile
from threading import Timer

import gpus
from compiler_output import fragment_figures

PATIENCE_S = 180  # for one variant


class Broken(Exception):
    """One line: why nothing could be compiled."""


def labels_of(program, options):
    """What would be compiled, without a compiler. Raises Broken."""
    asked = subprocess.run([program, "--list", *options], capture_output=True, text=True)
    if asked.returncode != 0:
        raise Broken(asked.stderr.strip() or f"{program} ended with status {asked.returncode}")
    return asked.stdout.splitlines()


def _parsed(line):
    try:
        return json.loads(line) if line.startswith("{") else {}
    except ValueError:
        return {}


def _follow(process, rows):
    """Adds a row per variant that was begun; (the one that was not ended, the program's own last words)."""
    begun, words, watch = None, "", Timer(PATIENCE_S, process.kill)
    watch.start()
    for line in process.stderr:
        said = _parsed(line)
        if said.get("end"):
            begun = None
        elif "variant" in said:
            begun = rows.setdefault(said["variant"], {})
            begun.update(said)
            watch.cancel()
            watch = Timer(PATIENCE_S, process.kill)
            watch.start()
        elif begun is not None:
            figures = fragment_figures(line, said.get("driver"))
            # Drivers compile small fragment shaders of their own, too.
            if figures and figures["instructions"] > begun.get("fragment", {}).get("instructions", -1):
                begun["fragment"] = figures
        elif line.startswith("slabcast-compile:"):
            words = line.strip()
    watch.cancel()
    return begun, words


def _run_once(gpu, program, options, labels, rows):
    words, environment = gpus.command(gpu, program, [*options, "--labels"])
    with tempfile.TemporaryFile("w+") as asked:
        asked.write("".join(f"{label}\n" for label in labels))
        asked.seek(0)
        with subprocess.Popen(words, env=environment, stdin=asked, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE,
                              text=True, errors="replace", preexec_fn=lambda: os.nice(10)) as process:
            begun, said = _follow(process, rows)
        status = process.returncode
    if begun is not None and status != 0:
        begun["failed"] = (f"the compiler took more than {PATIENCE_S} s" if status == -signal.SIGKILL else
                           f"the compiler ended with status {status}")
        begun.pop("fragment", None)
    elif status != 0:
        raise Broken(f"{gpu.title}: {said or f'{program} ended with status {status}'}")


def compile_all(gpu, program, labels, options=(), progress=lambda count: None):
    """{label: row} of these variants on a GPU; a row has "fragment", its figures, or "failed", why it has none.
    Raises Broken and gpus.NoCompilers."""
    rows = {}
    while missing := [label for label in labels if label not in rows]:
        before = len(rows)
        _run_once(gpu, program, options, missing[:256], rows)
        if len(rows) == before:
            raise Broken(f"{gpu.title}: {program} compiled nothing of what it was asked for")
        progress(len(rows))
    for row in rows.values():
        if "fragment" not in row:
            row.setdefault("failed", "the compiler gave no figures")
    return rows
