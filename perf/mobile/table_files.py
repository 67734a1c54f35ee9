"""The table as files: rows of JSON, or lines of CSV; and the list of rows that have a name."""

import csv
import io
import json
import os
import tempfile
from pathlib import Path

HERE = Path(__file__).resolve().parent
COMMITTED, BEFORE, NAMED = HERE / "table.csv", HERE / "before.csv", HERE / "rows.csv"

FIGURES = ("arithmetic", "fma", "cvt", "sfu", "texture", "varying", "load_store", "instructions", "nops", "fetches", "sy",
           "ss", "code_bytes", "quadwords", "full_registers", "half_registers", "waves", "threads", "loops", "spills",
           "fills")
COLUMNS = ("gpu", "variant", "layers", "cost", "unit", "cost_per_layer", *FIGURES, "failed")


def write_whole(path, text):
    """All of the file or nothing of it."""
    handle, temporary = tempfile.mkstemp(dir=path.parent, prefix=f".{path.name}.")
    try:
        with os.fdopen(handle, "w", encoding="utf-8") as file:
            file.write(text)
        os.chmod(temporary, 0o644)
        os.replace(temporary, path)
    except BaseException:
        os.unlink(temporary)
        raise


def _text(value):
    return "" if value is None else f"{value:g}" if isinstance(value, float) else str(value)


def csv_of(rows):
    """A line per row after the headings; empty where a compiler does not give that figure."""
    out = io.StringIO()
    lines = csv.writer(out, lineterminator="\n")
    lines.writerow(COLUMNS)
    for row in rows:
        fragment = row.get("fragment", {})
        lines.writerow([row["gpu"], row["variant"], row["layers"], _text(fragment.get("cost")), fragment.get("unit", ""),
                        _text(row.get("layer", {}).get("cost")), *(_text(fragment.get(name)) for name in FIGURES),
                        row.get("failed", "")])
    return out.getvalue()


def json_of(head, rows):
    """One object, a line per row."""
    lines = ",\n".join(json.dumps(row, separators=(",", ":"), sort_keys=True) for row in rows)
    return json.dumps(head, indent=1)[:-2] + f',\n "rows": [\n{lines}\n]}}\n'


def read_csv(path):
    """{(gpu, variant): {column: text}} of a table; empty where there is none."""
    if not path.exists():
        return {}
    with path.open(newline="", encoding="utf-8") as file:
        return {(row["gpu"], row["variant"]): row for row in csv.DictReader(file)}


def read_json_rows(path):
    """The rows of a table as JSON has them, without their axes."""
    def value(text):
        try:
            return float(text)
        except ValueError:
            return text
    return [{"gpu": row["gpu"], "variant": row["variant"], "layers": int(row["layers"]),
             "layer": {"cost": value(row["cost_per_layer"]) if row["cost_per_layer"] else None},
             "fragment": {name: value(row[name]) for name in ("cost", "unit", *FIGURES) if row[name]}}
            for row in read_csv(path).values() if row["cost"]]


def named_rows():
    """[{"row": name, "before": label, "general": label, "lean": label or ""}], in their order."""
    with NAMED.open(newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def named_labels(*columns):
    """The variants of these columns, each once."""
    return list(dict.fromkeys(row[column] for row in named_rows() for column in columns if row[column]))
