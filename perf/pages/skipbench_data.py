"""The ways of skipping as the page needs them: read, checked, by table."""

from dataclasses import dataclass, field
from pathlib import Path
from statistics import median

import page_input
from page_input import BadInput, number

NAMES = {"none": "none", "blocks": "block occupancy", "proximity": "proximity cloud", "chebyshev": "Chebyshev map",
         "partitioned": "partitioned maps", "boolean-octree": "Boolean octree", "minmax-octree": "min-max octree",
         "bitfield-octree": "bitfield octree"}
STRUCTURES = tuple(NAMES)
# Which of a paper's columns a structure of ours stands beside.
PUBLISHED = {"proximity": "distance map", "chebyshev": "distance map", "boolean-octree": "boolean-octree",
             "minmax-octree": "minmax-octree", "bitfield-octree": "bitfield-octree"}
# What frames do, and its key in a paper's table.
MODES = {"marching only": "marching_only", "early exit": "early_exit", "shading": "shading"}
AGAIN = "run `slabcast skipbench` again"


@dataclass(eq=False)
class Row:
    raw: dict

    def get(self, name, default=None):
        return self.raw.get(name, default)

    def at(self, *names):
        """A number inside; None where there is none."""
        part = self.raw
        for name in names[:-1]:
            part = page_input.section(part, name)
        return number(part.get(names[-1]))

    @property
    def structure(self):
        return str(self.raw.get("skip", "none"))

    @property
    def name(self):
        return NAMES.get(self.structure, self.structure)

    @property
    def ms(self):
        return self.at("frame_ms", "median")

    @property
    def spread(self):
        low, high = self.at("frame_ms", "min"), self.at("frame_ms", "max")
        return (self.ms if low is None else low), (self.ms if high is None else high)

    @property
    def speedup(self):
        return self.at("speedup")

    @property
    def interval(self):
        """(low, high) of the speed-up; None each where not known."""
        return self.at("speedup_low"), self.at("speedup_high")

    @property
    def parameters(self):
        """In a few words; what a structure does not have goes without saying."""
        words = []
        for key, say in (("skip_block", "{}³"), ("skip_bits", "{} bits"), ("partitions", "{} partitions"),
                         ("initial_level", "level {}"), ("traversal", "{}")):
            if self.raw.get(key) is not None:
                words.append(say.format(self.raw[key]))
        return ", ".join(words)

    def has(self, keys):
        return all(self.raw.get(name) == value for name, value in keys.items())


@dataclass
class Bench:
    raw: dict
    folder: Path
    rows: list
    figures: list = field(default_factory=list)

    def section(self, name):
        return page_input.section(self.raw, name)

    @property
    def volumes(self):
        return [volume for volume in self.raw.get("volumes", []) if isinstance(volume, dict)]

    def entry(self, volume):
        """What is said of a volume of that name; nothing where there is none."""
        return next((entry for entry in self.volumes if entry.get("name") == volume), {})

    def paper(self, name):
        return page_input.section(self.section("papers"), name)

    def of(self, table, **keys):
        return [row for row in self.rows if row.has({"table": table, **keys})]

    def one(self, table, **keys):
        found = self.of(table, **keys)
        return found[0] if found else None

    def published(self, structure, mode):
        """How many times as fast as none the paper's structure was, dataset by dataset; empty where it had none."""
        faludi = self.paper("faludi")
        columns, column = faludi.get("structures", []), PUBLISHED.get(structure)
        if column not in columns:
            return []
        place, key = columns.index(column), MODES[mode]
        return [data[key][0] / data[key][place] for data in faludi.get("datasets", []) if data.get(key)]

    def published_merges(self, transfer, partitions):
        """Rebuilding over merging, dataset by dataset."""
        rauter = self.paper("rauter")
        counts = rauter.get("partitions", [])
        line = int(transfer[2:]) - 1 if transfer[2:].isdigit() else -1
        if partitions not in counts:
            return []
        place = 1 + counts.index(partitions)
        return [data["update"][line][0] / data["update"][line][place] for data in rauter.get("datasets", [])
                if 0 <= line < len(data.get("update", []))]

    @property
    def sized(self):
        """The volume that was resampled; None without sizes."""
        sizes = self.of("sizes")
        return sizes[0].get("volume") if sizes else None


def span(values, form):
    """Least to greatest of several, one of one, nothing of none."""
    if not values:
        return ""
    low, high = form(min(values)), form(max(values))
    return low if low == high else f"{low} – {high}"


def middle(values):
    known = [value for value in values if value is not None]
    return median(known) if known else None


def load(folder):
    """DIR/skipbench.json. Raises BadInput."""
    path, raw = page_input.read(folder, "skipbench.json", "rows", "skipbench VOLUME...")
    rows = [Row(row) for row in raw["rows"]]
    for i, row in enumerate(rows):
        where = f"{path}: rows[{i}]"
        for name in ("table", "volume"):
            if not isinstance(row.get(name), str):
                raise BadInput(f"{where}.{name} is no text; {AGAIN}")
        if row.get("table") == "frames":
            for name, value in (("frame_ms.median", row.ms), ("speedup", row.speedup)):
                if value is None or value <= 0:
                    raise BadInput(f"{where}.{name} is no number that makes sense; {AGAIN}")
    if not any(row.get("table") == "frames" for row in rows):
        raise BadInput(f"{path}: holds no rows of frames; {AGAIN}")
    figures = [figure for figure in raw.get("figures") or [] if isinstance(figure, dict)]
    return Bench(raw, Path(folder), rows, figures)
