"""Keys of reports: snake_case, everywhere the same."""

import re

SNAKE_CASE = re.compile(r"[a-z][a-z0-9]*(_[a-z0-9]+)*")
# Of these, where they are objects, the keys are names of volumes and of structures, as they are.
BY_NAME = {"volumes", "frames_by_structure"}


def key_of(words):
    """What words name, as a key: layers_evaluated of "layers evaluated" and of "layers-evaluated"."""
    return re.sub("[- ]", "_", words)


def odd_keys(part, place=""):
    """Where in a report, however deep, keys are not snake_case: to be none."""
    if isinstance(part, list):
        # One of many rows stands for those with the same fault.
        return sorted({odd for entry in part for odd in odd_keys(entry, place + "[]")})
    if not isinstance(part, dict):
        return []
    names = place.rpartition(".")[2] in BY_NAME
    odd = [f"{place}.{key}" for key in part if not names and not SNAKE_CASE.fullmatch(key)]
    return odd + [found for key, value in part.items() for found in odd_keys(value, f"{place}.{key}")]
