"""Keys of reports: snake_case, everywhere the same."""

import csv
import re
from pathlib import Path

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


PAGE = Path(__file__).resolve().parents[2] / "docs" / "reports.md"


def _sections(command):
    """What docs/reports.md says of one command's report: its own section, and what stands before all sections of
    commands."""
    shared, *sections = re.split(r"(?m)^## (?=`)", PAGE.read_text(encoding="utf-8"))
    (own,) = (section for section in sections if section.startswith(f"`{command}`"))
    return shared, own


def undocumented_columns(table, command):
    """Headings of a CSV file that docs/reports.md does not name as a column, each in a line with a unit: to be none."""
    known = set()
    for section in _sections(command):
        columns = False
        for line in section.splitlines():
            cells = [cell.strip() for cell in re.split(r"(?<!\\)\|", line)[1:-1]]
            if len(cells) >= 4 and cells[0].startswith("column"):
                columns = cells[2] == "unit"
            elif not line.startswith("|"):
                columns = False
            elif columns and cells[2]:
                known |= set(re.findall(r"`([^`]+)`", cells[0]))
    with open(table, newline="", encoding="utf-8") as file:
        return sorted(set(next(csv.reader(file))) - known)


def undocumented_keys(report, command):
    """Keys of a report, however deep, that docs/reports.md does not name: to be none. Settings have their own page."""
    known = set()
    for section in _sections(command):
        known |= {word for words in re.findall(r"`([^`]+)`", section) for word in re.findall(r"\w+", words)}
    # "`R`, `R_low`, `R_high`" of any ratio
    known |= {f"{name}{end}" for name in known for end in ("_low", "_high", "_coverage")}

    def unknown(part, name=""):
        if isinstance(part, list):
            return {key for entry in part for key in unknown(entry, name)}
        if not isinstance(part, dict) or name == "settings":
            return set()
        own = set() if name in BY_NAME else {key for key in part if key not in known}
        return own | {found for key, value in part.items() for found in unknown(value, key)}
    return sorted(unknown(report))
