"""Replayed edits as the page needs them: read and checked, frame by frame."""

from collections import Counter
from dataclasses import dataclass
from itertools import groupby

import page_input
from page_input import BadInput, number

AGAIN = "run `slabcast edit` again"
TIMES = ("frame_ms", "octree_ms", "naive_ms")
KINDS = {"bitfield-octree": "bitfield octree", "minmax-octree": "min-max octree", "boolean-octree": "Boolean octree",
         "partitioned": "partitioned maps", "proximity": "proximity cloud", "chebyshev": "Chebyshev map",
         "blocks": "block occupancy", "none": "nothing"}
PARTS = {"edit_ms": "edit", "work_ms": "rebuilding", "prepare_ms": "plan and uploads", "draw_ms": "drawing"}


@dataclass(eq=False)
class Frame:
    raw: dict
    step: str
    edited: bool
    structure: str
    swapped: bool
    times: dict  # ms by name, of TIMES and PARTS

    def __getattr__(self, name):
        if name in self.times:
            return self.times[name]
        raise AttributeError(name)

    def count(self, name):
        """Of the work counters; None where the device cannot count."""
        return number(page_input.section(self.raw, "counters").get(name))

    @property
    def over_compared(self):
        return self.times["frame_ms"] / self.times["octree_ms"]


@dataclass
class Edit:
    raw: dict
    frames: list

    def section(self, name):
        return page_input.section(self.raw, name)

    @property
    def budget(self):
        """What was given for all frames, ms; None where each has its own."""
        return number(self.section("summary").get("budget_ms"))

    @property
    def budgets(self):
        """Each frame's, ms; empty where that is not known."""
        budgets = [number(frame.raw.get("budget_ms")) for frame in self.frames]
        return [] if None in budgets else budgets

    @property
    def compared(self):
        """What each frame is compared with: the structure that is right under any transfer function."""
        structure = self.section("summary").get("compared_with")
        return "structure" if structure is None else KINDS.get(structure, str(structure))

    @property
    def structures(self):
        """Those that served, in the order in which they first did."""
        return list(dict.fromkeys(frame.structure for frame in self.frames))

    @property
    def edits(self):
        return [frame for frame in self.frames if frame.edited]

    def served(self, edited):
        """[(structure, frames)] of those with an edit or of those without, most frames first."""
        return Counter(frame.structure for frame in self.frames if frame.edited == edited).most_common()

    def runs(self, key):
        """[(value, first frame, frame after the last)] of neighbours with the same `key(frame)`."""
        runs, first = [], 0
        for value, alike in groupby(self.frames, key):
            length = sum(1 for _ in alike)
            runs.append((value, first, first + length))
            first += length
        return runs


def _frame(raw, where):
    times = {name: number(raw.get(name)) for name in TIMES}
    times |= {name: number(page_input.section(raw, "parts").get(name)) for name in PARTS}
    for name, value in times.items():
        if value is None or value < 0:
            raise BadInput(f"{where}: {name} is no time; {AGAIN}")
    if times["octree_ms"] == 0:
        raise BadInput(f"{where}: octree_ms is 0; {AGAIN}")
    return Frame(raw, str(raw.get("step", "")), raw.get("edit") is True, str(raw.get("skip", "unknown")),
                 raw.get("progress") == "swapped", times)


def load(folder):
    """The edits in DIR/edit.json. Raises BadInput."""
    path, raw = page_input.read(folder, "edit.json", "rows", "edit")
    return Edit(raw, [_frame(row, f"{path}: rows[{i}]") for i, row in enumerate(raw["rows"])])
