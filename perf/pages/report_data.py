"""A sweep's measurements as the report needs them: read, checked, ordered."""

from dataclasses import dataclass, field
from pathlib import Path

import page_input
from page_input import BadInput, number

# What may tell two rows of one ratio apart, in the order in which labels name it.
SERIES_KEYS = ("skip", "form", "tighten", "lattice", "classify", "termination")
COUNTERS = {
    "fragments": "fragments",
    "layers_evaluated": "layers evaluated",
    "layers_skipped": "layers skipped",
    "volume_fetches": "volume fetches",
    "skip_fetches": "skip fetches",
}
# Tukora 2020, section 3 and Fig. 4: frames per second (without skipping, with skipping) on the paper's phone.
PAPER_FIGURES = {"ray casting": (4.7, 8.5), "hybrid": (None, 36.0), "slicing": (13.9, 13.9)}


@dataclass
class Row:
    raw: dict
    planes: int
    layers: int
    median_ms: float
    low_ms: float
    high_ms: float

    @property
    def ratio(self):
        return (self.planes, self.layers)

    @property
    def label(self):
        return f"{self.planes}×{self.layers}"

    @property
    def fps(self):
        return 1000.0 / self.median_ms

    def counter(self, name):
        return number((self.raw.get("counters") or {}).get(name))

    def speed_up(self, over):
        """How many times as fast as `over` ("slicing" of the same series, "plain", "plain_slicing"); None where that
        was not measured."""
        return number(self.raw.get(f"speedup_over_{over}"))

    def interval(self, over):
        """(low, high) of that; None each where not known."""
        return tuple(number(self.raw.get(f"speedup_over_{over}_{end}")) for end in ("low", "high"))

    def model(self, gpu):
        """What a model says of this ratio on a GPU: {"frame_ms": ...}; None where it says nothing."""
        said = (self.raw.get("model") or {}).get(gpu)
        return said if isinstance(said, dict) and (number(said.get("frame_ms")) or 0) > 0 else None

    @property
    def coverage(self):
        return number(self.raw.get("speedup_coverage"))


@dataclass
class Series:
    label: str
    skips: bool
    rows: list

    @property
    def slicing(self):
        """The pure slicing row (one layer per plane), which ratios refer to; None where not measured."""
        return next((row for row in self.rows if row.layers == 1), None)

    @property
    def best(self):
        return min(self.rows, key=lambda row: row.median_ms)


@dataclass
class Sweep:
    raw: dict
    folder: Path
    rows: list
    series: list = field(default_factory=list)

    @property
    def ratios(self):
        """Every (planes, layers) once, from ray casting to slicing."""
        return sorted({row.ratio for row in self.rows}, key=lambda r: (r[0], -r[1]))

    @property
    def modelled(self):
        """The series that is drawn unless told otherwise, if a model says anything of it, and the GPUs that it knows."""
        last = self.series[-1] if self.series else None
        gpus = sorted({gpu for row in last.rows for gpu in (row.raw.get("model") or {}) if row.model(gpu)}) if last else []
        return last, gpus

    def section(self, name):
        return page_input.section(self.raw, name)


def _row(raw, where):
    planes, layers = number(raw.get("planes")), number(raw.get("layers_per_plane"))
    times = page_input.section(raw, "frame_ms")
    median = number(times.get("median"))
    for name, value in (("planes", planes), ("layers_per_plane", layers), ("frame_ms.median", median)):
        if value is None or value <= 0:
            raise BadInput(f"{where}.{name} is no positive number; run the sweep again")
    low, high = number(times.get("min")), number(times.get("max"))
    return Row(raw, int(planes), int(layers), median,
               median if low is None else min(low, median),
               median if high is None else max(high, median))


def _splitting_keys(rows):
    """The fewest keys that tell apart all rows of equal ratio: what varies only *with* the ratio splits nothing."""
    chosen = ["skip"]
    for key in SERIES_KEYS[1:]:
        values = {}
        for row in rows:
            place = (row.ratio, *(str(row.raw.get(k)) for k in chosen))
            values.setdefault(place, set()).add(str(row.raw.get(key)))
        if any(len(seen) > 1 for seen in values.values()):
            chosen.append(key)
    return chosen


def _describe(key, value):
    if key == "skip":
        return "no skipping" if value in (None, "none") else f"skipping ({value})"
    if key == "tighten":
        return "tight polygons" if value else "full polygons"
    return str(value) if value is not None else f"{key} unknown"


def _group(rows):
    keys = _splitting_keys(rows)
    groups = {}
    for row in rows:
        groups.setdefault(tuple(str(row.raw.get(key)) for key in keys), []).append(row)
    series = []
    for members in groups.values():
        first = members[0].raw
        label = ", ".join(_describe(key, first.get(key)) for key in keys)
        members.sort(key=lambda row: (row.planes, -row.layers))
        series.append(Series(label, first.get("skip") not in (None, "none"), members))
    return sorted(series, key=lambda s: (s.skips, s.label))


def load(folder):
    """DIR/sweep.json. Raises BadInput."""
    path, raw = page_input.read(folder, "sweep.json", "rows", "sweep VOLUME")
    rows = [_row(row, f"{path}: rows[{i}]") for i, row in enumerate(raw["rows"])]
    return Sweep(raw, Path(folder), rows, _group(rows))
