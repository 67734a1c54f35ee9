"""Compiles variants under a GPU's compiler; goes on where a compiler gives up or hangs, and says so in that row."""

import json
import os
import signal
import subprocess
import tempfile
from pathlib import Path
from threading import Timer

import gpus
from compiler_output import fragment_figures

PATIENCE_S = 180  # for one variant
BATCH = 64  # variants of one process


class Broken(Exception):
    """One line: why nothing could be compiled."""


def keys_of(program, options):
    """{label: key of its text} of what would be compiled, without a compiler. Raises Broken."""
    asked = subprocess.run([program, "--list", *options], capture_output=True, text=True)
    if asked.returncode != 0:
        raise Broken(asked.stderr.strip() or f"{program} ended with status {asked.returncode}")
    return {label: key for key, label in (line.split(" ", 1) for line in asked.stdout.splitlines())}


class Known:
    """Rows of texts that were compiled before, in a file of its own for each GPU; a run cut short goes on from it."""

    def __init__(self, path):
        self.path, self.rows = path, {}
        try:
            for line in path.read_text(encoding="utf-8").splitlines():
                row = json.loads(line)
                self.rows[row.pop("key")] = row
        except (OSError, ValueError, KeyError):
            pass  # what cannot be read is compiled again

    def add(self, key, row):
        if key == "-" or "failed" in row or key in self.rows:
            return
        self.rows[key] = row
        with self.path.open("a", encoding="utf-8") as file:
            file.write(json.dumps({"key": key, **row}) + "\n")


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


def compile_all(gpu, program, keys, options=(), progress=lambda count: None, known=None):
    """{label: row} of these variants on a GPU; a row has "fragment", its figures, or "failed", why it has none.
    `keys`: as keys_of(); `known`: what need not be compiled again. Raises Broken and gpus.NoCompilers."""
    labels, known = list(keys), known or Known(Path(os.devnull))
    rows = {label: {**known.rows[key], "variant": label} for label, key in keys.items() if key in known.rows}
    while missing := [label for label in labels if label not in rows]:
        before = len(rows)
        _run_once(gpu, program, options, missing[:BATCH], rows)
        if len(rows) == before:
            raise Broken(f"{gpu.title}: {program} compiled nothing of what it was asked for")
        for label in missing[:BATCH]:
            if label in rows:
                if "fragment" not in rows[label]:
                    rows[label].setdefault("failed", "the compiler gave no figures")
                known.add(keys[label], rows[label])
        progress(len(rows))
    return rows
