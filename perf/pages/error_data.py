"""Errors against run time as the page needs them: read, checked, in families."""

from dataclasses import dataclass
from pathlib import Path

import page_input
from page_input import BadInput, number

PARTS = ("total", "sampling", "table", "gpu")
# As texts call them; what is not here is called by its own name.
NAMES = {"post": "post-classified", "preclassified": "pre-classified", "preintegrated": "pre-integrated",
         "rgba8": "RGBA8", "rgba16f": "RGBA16F"}
FRACTIONS = {0.125: "⅛", 0.25: "¼", 0.5: "½", 0.75: "¾"}
# What one row's settings are called by, in this order; settings that no two rows differ in go without saying.
SETTINGS = ("classify", "layer_spacing", "layers_per_plane", "target", "termination", "jitter")
FAMILY = ("layers_per_plane", "classify", "target", "termination", "jitter")


@dataclass(eq=False)
class Row:
    raw: dict
    id: str
    classification: str
    target: str
    jitter: bool
    ratio: str  # "slicing", "hybrid" or "ray casting"
    layers: int  # a plane, as asked for; 0: all of them
    spacing: float  # voxels per layer
    planes: int
    median_ms: float
    low_ms: float
    high_ms: float
    rank: int = 0  # on the front by time, fastest first; 0: not on it
    rank_by_fetches: int = 0

    def error(self, part="total", measure="rmse"):
        return number(page_input.section(page_input.section(self.raw, "error"), part).get(measure))

    def order_of(self, part):
        return number(page_input.section(self.raw, "order").get(part))

    @property
    def rmse(self):
        return self.error()

    @property
    def fetches(self):
        """Of the volume and of the skip structure; None where nothing was counted."""
        counters = page_input.section(self.raw, "counters")
        volume, skip = number(counters.get("volume_fetches")), number(counters.get("skip_fetches"))
        return None if volume is None else volume + (skip or 0)

    @property
    def frames(self):
        """How many were timed; None where that is not said."""
        count = number(page_input.section(self.raw, "frame_ms").get("n"))
        return None if count is None else int(count)

    def key(self, names):
        return tuple(str(self.raw.get(name)) for name in names)


def say(row, setting):
    """One setting in words: "½ voxel", "8 layers a plane"."""
    value = row.raw.get(setting)
    if setting == "layer_spacing":
        text = FRACTIONS.get(row.spacing, f"{row.spacing:g}")
        return f"{text} voxel" if row.spacing <= 1 else f"{text} voxels"
    if setting == "layers_per_plane":
        return row.ratio if row.ratio in ("slicing", "ray casting") else f"{value} layers a plane"
    if setting == "termination":
        return "never stops" if value == "off" else f"stops at {value:.3g}" if number(value) else "termination unknown"
    if setting == "jitter":
        return "jitter" if value else "no jitter"
    return NAMES.get(value, str(value))


@dataclass
class Errors:
    raw: dict
    folder: Path
    rows: list
    front: list  # fastest first
    front_by_fetches: list  # fewest first
    varying: tuple  # settings that tell rows apart

    def section(self, name):
        return page_input.section(self.raw, name)

    @property
    def classifications(self):
        return list(dict.fromkeys(row.classification for row in self.rows))

    def name(self, row, without=()):
        """The row's settings, as far as they vary."""
        return ", ".join(say(row, setting) for setting in self.varying or SETTINGS[:1] if setting not in without)

    @property
    def sorted_rows(self):
        """The front's, then the others, each the most accurate first."""
        return sorted(self.rows, key=lambda row: (row.rank == 0, row.rmse))

    def best_within(self, ms, classification):
        """The most accurate row in that time; None where none is that fast."""
        return min((row for row in self.rows if row.median_ms <= ms and row.classification == classification),
                   key=lambda row: row.rmse, default=None)

    @property
    def measured_earlier(self):
        """Rows from before this run began; dates are of one form and in order as text."""
        started = str(self.raw.get("started", ""))
        return [row for row in self.rows if str(row.raw.get("date", started)) < started]

    def families(self):
        """Rows that differ in their spacing alone, coarse to fine."""
        found = {}
        for row in self.rows:
            found.setdefault(row.key(FAMILY), []).append(row)
        return [sorted(family, key=lambda row: -row.spacing) for family in found.values()]

    def pairs(self, setting, first, second):
        """(row, its counterpart) for all rows that are equal but for `setting`: `first` against `second`."""
        others = [name for name in SETTINGS if name != setting]
        counterparts = {row.key(others): row for row in self.rows if row.raw.get(setting) == second}
        return [(row, counterparts[row.key(others)]) for row in self.rows
                if row.raw.get(setting) == first and row.key(others) in counterparts]


def _row(raw, where):
    times = page_input.section(raw, "frame_ms")
    spacing, median = number(raw.get("layer_spacing")), number(times.get("median"))
    planes = number(page_input.section(raw, "plan").get("planes"))
    layers = number(raw.get("layers_per_plane"))
    for name, value, good in (("layer_spacing", spacing, spacing is not None and spacing > 0),
                              ("layers_per_plane", layers, layers is not None and layers >= 0),
                              ("plan.planes", planes, planes is not None and planes >= 0),
                              ("frame_ms.median", median, median is not None and median > 0)):
        if not good:
            raise BadInput(f"{where}.{name} is no number that makes sense; run `slabcast error` again")
    for name in ("id", "classify", "target"):
        if not isinstance(raw.get(name), str) or not raw[name]:
            raise BadInput(f"{where}.{name} is no text; run `slabcast error` again")
    low, high = number(times.get("min")), number(times.get("max"))
    row = Row(raw, raw["id"], raw["classify"], raw["target"], bool(raw.get("jitter")),
              str(raw.get("ratio", "hybrid")), int(layers), spacing, int(planes), median,
              median if low is None else min(low, median), median if high is None else max(high, median))
    if row.rmse is None or row.rmse < 0:
        raise BadInput(f"{where}.error.total.rmse is no error; run `slabcast error` again")
    return row


def _front(raw, name, rows, path):
    indices = raw.get(name, [])
    valid = isinstance(indices, list) and all(
        isinstance(i, int) and not isinstance(i, bool) and 0 <= i < len(rows) for i in indices)
    if not valid:
        raise BadInput(f"{path}: {name} does not name rows; run `slabcast error` again")
    return [rows[i] for i in indices]


def load(folder):
    """DIR/error.json. Raises BadInput."""
    path, raw = page_input.read(folder, "error.json", "rows", "error VOLUME")
    rows = [_row(row, f"{path}: rows[{i}]") for i, row in enumerate(raw["rows"])]
    front, by_fetches = (_front(raw, name, rows, path) for name in ("front", "front_by_fetches"))
    for rank, row in enumerate(front, 1):
        row.rank = rank
    for rank, row in enumerate(by_fetches, 1):
        row.rank_by_fetches = rank
    varying = tuple(name for name in SETTINGS if len({str(row.raw.get(name)) for row in rows}) > 1)
    return Errors(raw, Path(folder), rows, front, by_fetches, varying)
