"""What compilers say of segment shaders, as the page needs it: read and checked, row by row."""

from dataclasses import dataclass, field

import page_input
from page_input import BadInput, number

AGAIN = "run `perf/mobile/table.py` again"
KINDS = {"before": "before", "general": "now", "lean": "now, lean"}  # columns of perf/mobile/rows.csv


@dataclass(eq=False)
class Row:
    gpu: str
    variant: str
    layers: int  # written out; 0 of a loop
    figures: dict  # of a fragment; empty where it was not compiled
    per_layer: float | None
    failed: str = ""

    @property
    def cost(self):
        return number(self.figures.get("cost"))

    def figure(self, name):
        return number(self.figures.get(name))

    @property
    def family(self):
        """All of the variant but its form."""
        name, _, form = self.variant.partition("/")
        return " ".join([name, *form.split(" ")[1:]])


@dataclass
class Table:
    raw: dict
    gpus: dict  # {name: {"title", "family", "mesa"}}, in their order
    rows: list
    named: list  # [(name, {column: label})]
    now: dict = field(default_factory=dict)  # {(gpu, label): Row}
    before: dict = field(default_factory=dict)

    def section(self, name):
        return page_input.section(self.raw, name)

    def is_mali(self, gpu):
        return self.gpus[gpu].get("family") != "adreno"

    def cell(self, gpu, name, column):
        """The row of a named row's column; None where it is not there."""
        label = dict(self.named).get(name, {}).get(column)
        return (self.before if column == "before" else self.now).get((gpu, label))

    def series(self, gpu):
        """{family: its rows that are written out, by their layers}."""
        found = {}
        for row in self.rows:
            if row.gpu == gpu and row.layers > 0 and row.cost is not None:
                found.setdefault(row.family, []).append(row)
        return {name: sorted(rows, key=lambda row: row.layers) for name, rows in found.items()}

    @property
    def named_families(self):
        """[(family, how it is called)] of what is named and written out, in order; 32 layers' name without the 32."""
        found = {}
        for name, labels in self.named:
            for column in ("general", "lean"):
                row = next((self.now[key] for key in self.now if key[1] == labels.get(column)), None)
                if row is not None and row.layers > 1:
                    words = name.split(", ", 1)[-1] + (", lean" if column == "lean" else "")
                    found.setdefault(row.family, words)
        return list(found.items())


def _row(raw, where):
    layers, fragment = number(raw.get("layers")), page_input.section(raw, "fragment")
    if layers is None or not isinstance(raw.get("variant"), str):
        raise BadInput(f"{where}: is no row of a variant; {AGAIN}")
    if fragment and number(fragment.get("cost")) is None:
        raise BadInput(f"{where}: cost is no number; {AGAIN}")
    return Row(str(raw.get("gpu")), raw["variant"], int(layers), fragment,
               number(page_input.section(raw, "layer").get("cost")), str(raw.get("failed", "")))


def load(folder):
    """The table in DIR/mobile.json. Raises BadInput."""
    path, raw = page_input.read(folder, "mobile.json", "rows", "perf/mobile/table.py")
    rows = [_row(row, f"{path}: rows[{i}]") for i, row in enumerate(raw["rows"])]
    before = [_row(row, f"{path}: before[{i}]") for i, row in enumerate(raw.get("before") or [])]
    gpus = page_input.section(raw, "gpus")
    if missing := {row.gpu for row in rows} - set(gpus):
        raise BadInput(f"{path}: gpus does not say what {sorted(missing)[0]} is; {AGAIN}")
    named = [(str(one.get("row")), one) for one in raw.get("named") or []]
    return Table(raw, gpus, rows, named, {(row.gpu, row.variant): row for row in rows},
                 {(row.gpu, row.variant): row for row in before})
