"""Keys of reports: lowerCamel, everywhere the same."""

import re

LOWER_CAMEL = re.compile(r"[a-z][a-zA-Z0-9]*")
# Of these, where they are objects, the keys are names of volumes and of structures, as they are.
BY_NAME = {"volumes", "framesByStructure"}


def key_of(words):
    """What words name, as a key: layersEvaluated of "layers_evaluated" and of "layers-evaluated"."""
    first, *others = re.split("[-_ ]", words)
    return first + "".join(word[:1].upper() + word[1:] for word in others)


def odd_keys(part, place=""):
    """Where in a report, however deep, keys are not lowerCamel: to be none."""
    if isinstance(part, list):
        # One of many rows stands for those with the same fault.
        return sorted({odd for entry in part for odd in odd_keys(entry, place + "[]")})
    if not isinstance(part, dict):
        return []
    names = place.rpartition(".")[2] in BY_NAME
    odd = [f"{place}.{key}" for key in part if not names and not LOWER_CAMEL.fullmatch(key)]
    return odd + [found for key, value in part.items() for found in odd_keys(value, f"{place}.{key}")]
