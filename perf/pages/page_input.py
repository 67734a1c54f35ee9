"""Measurements as all pages read them: one line for what cannot be used, None for what is not known."""

import json
import math
from pathlib import Path


class BadInput(Exception):
    """One line for a person: the cause, then the remedy."""


def number(value):
    """`value` as a finite float, or None: JSON of other makers holds nulls and strings."""
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        return None
    return float(value) if math.isfinite(value) else None


def section(raw, name):
    """The object `name` of `raw`; empty where there is none."""
    part = raw.get(name)
    return part if isinstance(part, dict) else {}


def read(folder, name, rows, subcommand):
    """The object in DIR/name, which holds a list `rows` that is not empty. `subcommand`: of slabcast, or the path of a
    script, that makes it. Raises BadInput."""
    path = Path(folder) / name
    program = subcommand if "/" in subcommand else f"slabcast {subcommand}"
    again = f"run `{program}` again"
    try:
        raw = json.loads(path.read_text(encoding="utf-8"))
    except FileNotFoundError:
        raise BadInput(f"{path}: no such file; `{program} --out {folder}` makes it") from None
    except OSError as error:
        raise BadInput(f"{path}: {error.strerror}; check the path and its permissions") from None
    except ValueError as error:
        raise BadInput(f"{path}: not JSON ({error}); {again}") from None
    if not isinstance(raw, dict) or not isinstance(raw.get(rows), list) or not raw[rows]:
        raise BadInput(f"{path}: holds no {rows}; {again}")
    for i, row in enumerate(raw[rows]):
        if not isinstance(row, dict):
            raise BadInput(f"{path}: {rows}[{i}] is no object; {again}")
    conditions = section(raw, "conditions")
    if conditions:  # settings are conditions, too
        raw["conditions"] = {**section(conditions, "settings"), **conditions}
    return path, raw


def picture(folder, relative):
    """The path of a picture, only inside the measurements' own folder; None where there is none."""
    path = (folder / str(relative)).resolve()
    if not relative or not path.is_relative_to(folder.resolve()) or not path.is_file():
        return None
    return path
