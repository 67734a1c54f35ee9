"""The tables of the comparison: what was measured, with the papers' figures beside it."""

from page_html import (MISSING, coverage_words, esc, figures, interval, mebibytes, millions, plural, table,
                       times)
from page_input import number
from skipbench_data import MODES, NAMES, STRUCTURES, span

HEAT = (245, 248, 250), (29, 90, 145)  # of the slowest and the fastest cell
SLOW = 1.6  # times the fastest: no colour beyond
COUNTERS = ("layers_evaluated", "volume_fetches", "skip_fetches", "stretches", "blocks_visited")


def cubed(text):
    return str(text).replace("^3", "³")


def mib(value):
    """In one line."""
    return (mebibytes(value) or MISSING).replace(" ", "&nbsp;")


def note(text):
    return f'<p class="note">{text}</p>'


def bleeding(inner):
    return f'<div class="bleed">{inner}</div>'


def folded(summary, inner):
    return f"<details class=long><summary>{summary}</summary>{inner}</details>"


# Figures to reach


def _verdict(entry):
    reached = entry.get("reached")
    if reached is None:
        return MISSING
    return "yes" if reached else "<b class=fail>no</b>"


def _goal(entry):
    goal = number(entry.get("goal"))
    return MISSING if goal is None else f"{'≥' if entry.get('sense') == '>=' else '≤'} {figures(goal)}"


def _value(entry):
    """What was measured, and below it its interval where it is paired."""
    low, high = number(entry.get("low")), number(entry.get("high"))
    spread = interval(low, high)
    return figures(entry.get("value")) + (f"<br><i>{spread}</i>" if spread else "")


def _figure_lines(entries, judged):
    if not entries:
        return ""
    lines = []
    for entry in entries:
        name, volume, origin = (esc(entry.get(key, "")) for key in ("name", "volume", "from"))
        line = [f"{cubed(name)}<small>{volume}: {origin}</small>", _value(entry)]
        lines.append([*line, _goal(entry), _verdict(entry)] if judged else line)
    css = ["failed" if entry.get("reached") is False else "" for entry in entries]
    head = ["figure", "measured", *(["goal", "reached"] if judged else [])]
    return table(head, lines, css="cases bench", row_css=css)


def figures_to_reach(bench):
    """Those with a goal; those without wait behind a line, or stand alone where no volume has goals."""
    judged = [entry for entry in bench.figures if entry.get("goal") is not None]
    others = [entry for entry in bench.figures if entry.get("goal") is None]
    if not bench.figures:
        return ""
    rest = _figure_lines(others, False)
    if judged and others:
        rest = folded(f"{plural(len(others), 'figure')} without a goal, for comparison", rest)
    goals = "" if judged else " Goals were set for the project’s own scenes only."
    return _figure_lines(judged, True) + rest + note(
        "Worked out from the rows of this run. Times are compared within a race: the median over its rounds of the "
        "ratios of two frames of the same round, which may differ from the ratio of two medians; below it its "
        f"interval.{goals} {coverage_words(next((entry.get('coverage') for entry in bench.figures if entry.get('coverage')), None))}")


# Frames


def _parameters(bench, volume, marching):
    """Those of the first mode, and below them those with early exit where they are others."""
    leaving = bench.one("frames", volume=volume, family="ray casting", mode="early exit", skip=marching.structure)
    others = leaving.parameters if leaving else marching.parameters
    differ = f"<br><i>early exit: {esc(others)}</i>" if others != marching.parameters else ""
    return esc(marching.parameters) + differ


def ray_casting(bench, volume):
    """As the octree paper's table 1, a line per structure: frame times, multiples of none's speed, the paper's."""
    modes = [mode for mode in MODES if bench.of("frames", volume=volume, family="ray casting", mode=mode)]
    head = ["structure", "best parameters"]
    for mode in modes:
        head += [f"{mode}, ms", "times as fast", "paper"]
    lines = []
    for first in bench.of("frames", volume=volume, family="ray casting", mode=modes[0]):
        cells = [first.name, _parameters(bench, volume, first)]
        for mode in modes:
            row = bench.one("frames", volume=volume, family="ray casting", mode=mode, skip=first.structure)
            cells += [f"{figures(row.ms)}<br><i>{span(row.spread, figures)}</i>" if row else MISSING,
                      f"<b>{times(row.speedup)}</b><br><i>{interval(*row.interval)}</i>" if row else MISSING,
                      span(bench.published(first.structure, mode), lambda value: f"{value:.2f}") or MISSING]
        lines.append(cells)
    paper = bench.paper("faludi")
    told = "Median of a turn’s frames; below it the fastest and the slowest. Below a ratio its interval."
    if paper:
        told += (f" “Paper”: {esc(paper.get('source', ''))}, least to greatest of its datasets, on its device "
                 f"({esc(paper.get('device', ''))}); its distance map is Euclidean, of 4-voxel blocks.")
    return bleeding(table(head, lines, css="rows bench")) + note(told)


def work(bench, volume):
    lines = [[row.name, esc(row.parameters), *(millions(row.at("counters", name)) for name in COUNTERS)]
             for row in bench.of("work", volume=volume)]
    head = ["structure", "parameters", "layers evaluated, M", "volume fetches, M", "skip fetches, M",
            "blocks looked at, M", "blocks visited, M"]
    return lines and table(head, lines, css="paper bench") + note(
        "One frame of ray casting, marching only, with the same parameters for all. A block or node is looked at "
        "where a ray asks whether it may be left out; it is visited where the answer is no and the ray marches "
        "through. An octree’s look takes several fetches.")


def families(bench, volume):
    lines = []
    for row in bench.of("frames", volume=volume):
        if row.get("family") != "ray casting":
            lines.append([row.name, esc(row.get("family")), esc(row.get("mode")),
                          f"{esc(row.get('planes'))}×{esc(row.get('layers_per_plane'))}",
                          "rectangles" if row.get("tighten") else "sphere", esc(row.get("order", MISSING)),
                          figures(row.ms), span(row.spread, figures), times(row.speedup), interval(*row.interval),
                          millions(row.at("counters", "layers_evaluated")),
                          millions(row.at("counters", "skip_fetches"))])
    head = ["structure", "family", "mode", "planes × layers", "planes are", "blended", "ms", "min – max",
            "times as fast", "its interval", "layers, M", "skip fetches, M"]
    return lines and folded(f"{len(lines)} rows, each at its best ratio", table(head, lines, css="rows bench"))


# Parameters


def _shade(ms, best):
    """A cell's colour, by how near to the fastest of all."""
    share = max(0.0, min(1.0, 1 - (ms / best - 1) / (SLOW - 1)))
    red, green, blue = (round(low + (high - low) * share) for low, high in zip(*HEAT))
    return f"background:rgb({red},{green},{blue});color:{'#fff' if share > 0.55 else 'inherit'}"


def _heat(rows, down, across, caption):
    """The least time of all rows that fall into a cell; `down` and `across`: a key, and how to say its values."""
    cells = {}
    for row in rows:
        place = row.get(down[0]), row.get(across[0])
        cells[place] = min(row.at("search_ms"), cells.get(place, float("inf")))
    best = min(cells.values())
    columns = sorted({place[1] for place in cells})  # of one kind: numbers, or words, or nothing at all
    lines = []
    for value in sorted({place[0] for place in cells}):
        found = [cells.get((value, column)) for column in columns]
        lines.append([down[1](value), *(MISSING if ms is None else
                                        f'<span class=heat style="{_shade(ms, best)}">{figures(ms)}</span>'
                                        for ms in found)])
    return table(["", *(across[1](column) for column in columns)], lines, caption, css="heatmap")


def searched(bench, volume):
    """Each structure's grid, folded to two of its parameters at a time."""
    edge, level = ("skip_block", lambda value: f"{value}³ voxels"), ("initial_level", lambda value: f"level {value}")
    bits, way, nothing = ("skip_bits", lambda value: f"{value} bits"), ("traversal", str), ("", lambda _: "ms")
    parts = []
    for structure in STRUCTURES:
        rows = [row for row in bench.of("search", volume=volume, skip=structure) if row.at("search_ms")]
        if rows:
            has_bits, name = rows[0].get("skip_bits") is not None, NAMES[structure]
            parts.append(_heat(rows, edge, bits if has_bits else nothing, name))
            if rows[0].get("traversal"):
                parts.append(_heat(rows, level, way, name))
            if has_bits:
                parts.append(_heat(rows, level, edge, name))
    return parts and f'<div class="heats">{"".join(parts)}</div>' + note(
        "Ray casting, marching only, on a picture of half the edge: the least of three frames, in ms; in each cell "
        "the best of all that its two parameters leave open. The fastest five of each structure then raced at full "
        "size, none with them, without early exit and with it; the winners are what frames and memory are of. A level "
        "is how many levels below the root a walk begins.")


# Building


def _spread(row, name):
    """A median, and below it the least and the greatest."""
    low, high = row.at(name, "min"), row.at(name, "max")
    return f"{figures(row.at(name, 'median'))}<br><i>{span([low, high], figures)}</i>"


def _refusal(reason):
    return f"<b class=fail>refused</b><small>{esc(reason)}</small>" if reason else MISSING


def generation(bench, volume):
    """Built, held, and changed with the transfer function; the volume's own size beside."""
    entry = bench.entry(volume)
    texels, codes = number(entry.get("texel_bytes")), number(entry.get("codes_ms"))
    lines = []
    for row in bench.of("structures", volume=volume):
        if row.get("refused"):
            lines.append([row.name, esc(row.parameters), _refusal(row.get("refused")), *[MISSING] * 6])
            continue
        gpu, host, occupied = row.at("gpu_bytes"), row.at("host_bytes"), row.at("occupied_fraction")
        lines.append([row.name, esc(row.parameters), _spread(row, "build_ms"),
                      _spread(row, "gpu_build_ms") if row.get("gpu_build_ms") else _refusal(row.get("gpu_refused")),
                      figures(row.at("update_ms", "median")), mib(gpu),
                      f"{100 * gpu / texels:.2g} %" if gpu and texels else MISSING, mib(host) if host else MISSING,
                      f"{100 * occupied:.3g} %" if occupied is not None else MISSING])
    head = ["structure", "parameters", "build on the CPU, ms", "on the GPU, ms", "another TF, ms", "GPU memory",
            "of the volume’s", "host memory", "occupied"]
    told = ("Medians of builds in turn; below them the fastest and the slowest. The CPU begins with codes that all share"
            f"{f' ({figures(codes)} ms, once)' if codes else ''}, the GPU with the volume’s texture; the GPU’s times end "
            "when the host has its copy, too. ")
    ours = [row and row.at("build_ms", "median") for row in (
        bench.one("structures", volume=volume, skip=name) for name in ("proximity", "bitfield-octree"))]
    paper = span([data["generation"][0] / data["generation"][3] for data in bench.paper("faludi").get("datasets", [])],
                 lambda value: f"{value:.1f}")
    if all(ours) and paper:
        told += (f"On the CPU this proximity cloud takes {ours[0] / ours[1]:.1f} times as long as this bitfield octree, "
                 f"each with its own parameters; in the paper {paper} times, on its GPU, with blocks of 4 voxels. ")
    return lines and bleeding(table(head, lines, css="rows bench")) + note(
        told + "“Another TF”: what a structure that does not depend on it takes under a new one; the others are "
        "built anew.")


# A new transfer function


def _once(row):
    return MISSING if row is None else "refused" if row.get("refused") else figures(row.at("init_ms"))


def _kept(row):
    if row is None:
        return MISSING
    if row.get("refused"):
        return f"<details><summary class=fail>refused</summary><span class=why>{esc(row.get('refused'))}</span></details>"
    return mib(row.at("host_bytes"))


def _merged(bench, row, edge, transfer, count):
    if row is None:
        return MISSING
    paper = span(bench.published_merges(transfer, count), lambda value: f"{value:.1f}×") if edge == 4 else ""
    return (f"{figures(row.at('update_ms', 'median'))} ms <b>{row.speedup:.1f}×</b> <i>{interval(*row.interval, 1)}</i>"
            + (f"<br><i>{paper}</i>" if paper else ""))


def _merges_at(bench, volume, edge, counts):
    """One block edge: a line per transfer function, then what the partitions take once."""
    lines = []
    for rebuild in bench.of("rebuild", volume=volume, skip_block=edge, skip="chebyshev"):
        transfer = rebuild.get("tf", "")
        proximity = bench.one("rebuild", volume=volume, skip_block=edge, skip="proximity", tf=transfer)
        lines.append([f"{esc(transfer)}<small>{esc(rebuild.get('tf_name', ''))}</small>",
                      figures(rebuild.at("build_ms", "median")), figures(rebuild.at("of_ranges_ms", "median")),
                      figures(proximity.at("build_ms", "median")) if proximity else MISSING,
                      *(_merged(bench, bench.one("merge", volume=volume, skip_block=edge, tf=transfer,
                                                 partitions=count), edge, transfer, count) for count in counts)])
    made = [bench.one("partitions", volume=volume, skip_block=edge, partitions=count) for count in counts]
    lines.append(["one time, ms", "", "", "", *(_once(row) for row in made)])
    lines.append(["memory", "", "", "", *(_kept(row) for row in made)])
    head = [f"blocks of {edge}³" if edge > 1 else "single voxels", "rebuilt, ms", "of kept ranges, ms",
            "proximity, ms", *(f"{count} partitions" for count in counts)]
    return bleeding(table(head, lines, css="rows bench"))


def merging(bench, volume):
    """Rebuilding over merging, for every edge, transfer function and number of partitions; the paper's below ours."""
    counts = sorted({row.get("partitions") for row in bench.of("partitions", volume=volume)})
    edges = sorted({row.get("skip_block") for row in bench.of("rebuild", volume=volume)}, reverse=True)
    told = ("Times to follow a change of transfer function on the processor; in bold how many times faster merging is "
            "than rebuilding the Chebyshev map in full. “Of kept ranges” rebuilds from the least and greatest value "
            "of every block, which no transfer function changes: ours, not the paper’s. The least value has a "
            "partition of its own.")
    paper = bench.paper("rauter")
    if paper:
        told += (f" Grey below: {esc(paper.get('source', ''))}, least to greatest of its datasets, on its device "
                 f"({esc(paper.get('device', ''))}).")
    return "".join(_merges_at(bench, volume, edge, counts) for edge in edges) + note(told)


# Cost against size


def sizes(bench):
    rows = bench.of("sizes")
    edges = sorted({row.get("edge") for row in rows})
    lines = []
    for name in STRUCTURES:
        cells = [NAMES[name]]
        for edge in edges:
            row = bench.one("sizes", skip=name, edge=edge)
            if row is None:
                cells += [MISSING] * 4
            else:
                cells += ["refused" if row.get("refused") else figures(row.at("build_ms", "median")),
                          figures(row.at("gpu_build_ms", "median")), mib(row.at("gpu_bytes")), figures(row.ms)]
        lines.append(cells)
    head = ["structure"]
    for edge in edges:
        head += [f"{edge}³: CPU build, ms", "GPU build, ms", "GPU memory", "frame, ms"]
    return bleeding(table(head, lines, css="rows bench"))
