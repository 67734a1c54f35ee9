"""The report's plots, as SVG text. Each is drawn wide for desks and narrow for phones."""

import numpy as np
from matplotlib.ticker import MaxNLocator

from page_svg import MUTED, NARROW, WIDE, plain_log_ticks, plt, svg
from report_data import COUNTERS, PAPER_FIGURES, number

PLAIN = ("#b5532a", "#d79a55", "#8a6d3b")
SKIPPING = ("#1d6091", "#5aa0a8", "#6a5aa8")
PAPER = "#8b8f96"
MODEL = "#7a3e8f"


def _colours(sweep):
    counts = {True: 0, False: 0}
    colours = []
    for series in sweep.series:
        palette = SKIPPING if series.skips else PLAIN
        colours.append(palette[counts[series.skips] % len(palette)])
        counts[series.skips] += 1
    return colours


def _key(sweep, marker="o"):
    return [(series.label, colour, marker, False, "") for series, colour in zip(sweep.series, _colours(sweep))]


def _ratio_axis(axes, sweep, room, label=True):
    """`room`: how many labels fit side by side before they must lean."""
    places = {ratio: i for i, ratio in enumerate(sweep.ratios)}
    crowded = len(places) > room
    axes.set_xticks(range(len(places)), [f"{p}×{n}" for p, n in sweep.ratios],
                    rotation=60 if crowded else 0, ha="right" if crowded else "center",
                    rotation_mode="anchor", fontsize=8)
    axes.set_xlim(-0.5, len(places) - 0.5)
    axes.grid(axis="x", visible=False)
    if label:
        axes.set_xlabel("ray casting  ←   planes × layers per plane   →  slicing", color=MUTED)
    return places


def _log_ms_axis(axes):
    axes.set_yscale("log")
    plain_log_ticks(axes.yaxis)
    axes.tick_params(axis="y", which="minor", length=0)


def frame_times(sweep, narrow):
    """The core paper's Fig. 4 for this device: median, with whiskers from the fastest to the slowest frame."""
    figure, axes = plt.subplots(figsize=(NARROW, 3.9) if narrow else (WIDE, 4.1))
    places = _ratio_axis(axes, sweep, 5 if narrow else 14)
    _log_ms_axis(axes)
    middle = (len(sweep.series) - 1) / 2
    for i, (series, colour) in enumerate(zip(sweep.series, _colours(sweep))):
        x = [places[row.ratio] + 0.09 * (i - middle) for row in series.rows]
        y = [row.median_ms for row in series.rows]
        spans = ([row.median_ms - row.low_ms for row in series.rows],
                 [row.high_ms - row.median_ms for row in series.rows])
        axes.errorbar(x, y, spans, color=colour, lw=1.6, elinewidth=1.0, capsize=2.5, zorder=3)
        for row, xi in zip(series.rows, x):
            hollow = row.raw.get("form") == "loop"
            axes.plot(xi, row.median_ms, "o", ms=5, mec=colour, mew=1.3, zorder=4,
                      mfc="white" if hollow else colour)
    axes.set_ylabel("frame time, ms (log)")
    loops = any(row.raw.get("form") == "loop" for row in sweep.rows)
    fps = axes.secondary_yaxis("right", functions=(_reciprocal, _reciprocal))
    fps.set_ylabel("frames per second")
    plain_log_ticks(fps.yaxis)
    return svg(figure, f"times{'-n' if narrow else ''}",
               _key(sweep) + [("hollow: loop, not unrolled", MUTED, "o", True, None)] * loops)


def _reciprocal(value):
    """Milliseconds to frames per second and back; the axis also asks for 0 while it is being laid out."""
    return 1000.0 / np.maximum(value, 1e-9)


def _errorbars(axes, x, values, intervals, colour):
    spans = [[value - (value if low is None else low) for value, (low, _) in zip(values, intervals)],
             [(value if high is None else high) - value for value, (_, high) in zip(values, intervals)]]
    axes.errorbar(x, values, spans, color=colour, marker="o", ms=4, lw=1.6, elinewidth=1.0, capsize=2.5, zorder=3)


def speed_ups(sweep, narrow):
    """Speed as a multiple of slicing: the one scale on which another device's figures may stand beside ours."""
    if not any(row.speed_up("slicing") for row in sweep.rows):
        return None
    figure, axes = plt.subplots(figsize=(NARROW, 3.3) if narrow else (WIDE, 3.3))
    places = _ratio_axis(axes, sweep, 5 if narrow else 14)
    middle = (len(sweep.series) - 1) / 2
    for i, (series, colour) in enumerate(zip(sweep.series, _colours(sweep))):
        rows = [row for row in series.rows if row.speed_up("slicing")]
        if rows:
            _errorbars(axes, [places[row.ratio] + 0.09 * (i - middle) for row in rows],
                       [row.speed_up("slicing") for row in rows], [row.interval("slicing") for row in rows], colour)
    axes.axhline(1.0, color=MUTED, lw=0.9)
    reached = PAPER_FIGURES["hybrid"][1] / PAPER_FIGURES["slicing"][1]
    axes.axhline(reached, color=PAPER, lw=1.0, ls=(0, (4, 3)))
    axes.annotate(f"paper's best hybrid, on its phone: {reached:.2f}×", (0.01, reached),
                  xycoords=("axes fraction", "data"), xytext=(0, 3), textcoords="offset points",
                  fontsize=7.5, color=MUTED)
    axes.set_ylim(bottom=0, top=max(axes.get_ylim()[1], reached * 1.15))
    axes.set_ylabel("speed, slicing = 1")
    return svg(figure, f"speed{'-n' if narrow else ''}", _key(sweep))


def _within(value, row, end):
    """An end of a model's range; the value where it is not known."""
    return number(row.get(end)) or value


def model_times(sweep, narrow):
    """A panel per GPU: the model's frame time with its range, and the measured one of this device in grey."""
    series, gpus = sweep.modelled
    if not gpus:
        return None
    columns = 1 if narrow else 2
    lines = -(-len(gpus) // columns)
    figure, grid = plt.subplots(lines, columns, figsize=(NARROW, 2.3 * lines + 0.6) if narrow else
                                (WIDE, 2.2 * lines + 0.5), squeeze=False)
    panels = list(grid.flat)
    for axes in panels[len(gpus):]:
        axes.set_visible(False)
    for k, (axes, gpu) in enumerate(zip(panels, gpus)):
        rows = [row for row in series.rows if row.model(gpu)]
        places = _ratio_axis(axes, sweep, 4 if narrow else 7, label=k >= len(gpus) - columns)
        x = [places[row.ratio] for row in rows]
        y = [number(row.model(gpu)["frame_ms"]) for row in rows]
        axes.fill_between(x, [_within(value, row.model(gpu), "low_ms") for value, row in zip(y, rows)],
                          [_within(value, row.model(gpu), "high_ms") for value, row in zip(y, rows)],
                          color=MODEL, alpha=0.18, lw=0)
        axes.plot(x, y, color=MODEL, lw=1.6, ls=(0, (4, 2)), marker="o", ms=4, mfc="white")
        axes.plot([places[row.ratio] for row in series.rows], [row.median_ms for row in series.rows],
                  color=PAPER, lw=1.2, marker="o", ms=3)
        _log_ms_axis(axes)
        axes.set_ylabel("ms (log)")
        axes.set_title(f"model: {rows[0].model(gpu).get('device', gpu)}")
    return svg(figure, f"model{'-n' if narrow else ''}",
               [("a model, not measured, with its range", MODEL, "o", True, "4 2"),
                ("measured on this run\u2019s device", PAPER, "o", False, "")])


def counters(sweep, narrow):
    """One small panel per counter, all over the same ratios, each from zero."""
    names = [n for n in COUNTERS if any(row.counter(n) is not None for row in sweep.rows)]
    if not names:
        return None
    columns = 1 if narrow else 2
    lines = -(-len(names) // columns)
    figure, grid = plt.subplots(lines, columns, figsize=(NARROW, 2.0 * lines + 0.6) if narrow else
                                (WIDE, 2.0 * lines + 0.5), sharex=True, squeeze=False)
    panels = list(grid.T.flat)
    for axes in panels[len(names):]:
        axes.set_visible(False)
    for axes, name in zip(panels, names):
        bottom = axes in grid[-1] or axes is panels[len(names) - 1]
        places = _ratio_axis(axes, sweep, 6, label=False)
        for series, colour in zip(sweep.series, _colours(sweep)):
            points = [(places[r.ratio], r.counter(name)) for r in series.rows
                      if r.counter(name) is not None]
            axes.plot([x for x, _ in points], [y / 1e6 for _, y in points], "o-", color=colour,
                      lw=1.4, ms=3, clip_on=False)
        axes.set_title(f"{COUNTERS[name]}, millions per frame")
        axes.set_ylim(bottom=0)
        axes.yaxis.set_major_locator(MaxNLocator(4))
        axes.tick_params(axis="x", labelbottom=bottom)
    return svg(figure, f"work{'-n' if narrow else ''}", _key(sweep))


def _making(row):
    """(compile and link, what the first frame took beyond a usual one), ms; None where not measured."""
    compiled, first = number(row.raw.get("compile_ms")), number(row.raw.get("first_frame_ms"))
    return None if compiled is None else (compiled, max(0.0, (first or 0.0) - row.median_ms))


def compile_times(sweep, narrow):
    """Per variant the longest time measured: later uses find it compiled."""
    longest = {}
    for row in sweep.rows:
        name, made = row.raw.get("variant"), _making(row)
        if name and made:
            place = (str(name), row.raw.get("skip") not in (None, "none"))
            longest[place] = max(made, longest.get(place, made), key=sum)
    if not longest:
        return None
    ordered = sorted(longest.items(), key=lambda item: item[0][::-1])
    figure, axes = plt.subplots(figsize=(NARROW if narrow else WIDE, 0.23 * len(ordered) + 0.7))
    for place, (_, (compiled, beyond)) in enumerate(ordered):
        axes.barh(place, compiled, height=0.68, color=SKIPPING[0])
        axes.barh(place, beyond, left=compiled, height=0.68, color=SKIPPING[1])
        total = compiled + beyond
        axes.annotate(f" {total:.0f}" if total >= 10 else f" {total:.1f}", (total, place), va="center", fontsize=7.5,
                      color=MUTED)
    axes.set_yticks(range(len(ordered)), [name for (name, _), _ in ordered], fontsize=7.5 if not narrow else 6)
    axes.invert_yaxis()
    axes.grid(axis="y", visible=False)
    axes.tick_params(axis="y", length=0)
    axes.margins(x=0.1, y=0.01)
    axes.set_xlabel("ms")
    return svg(figure, f"compile{'-n' if narrow else ''}",
               [("compile and link", SKIPPING[0], "s", False, None),
                ("its first frame, beyond a usual one", SKIPPING[1], "s", False, None)])
