"""Plots of error against its price, as SVG text. Each is drawn wide for desks and narrow for phones."""

import math

import numpy as np
from matplotlib.ticker import FuncFormatter, LogLocator, MultipleLocator, NullLocator

from error_data import FAMILY, NAMES, PARTS, say
from page_svg import INK, MUTED, NARROW, PAPER_WHITE, WIDE, plain_log_ticks, plain_number, plt, svg

# Three hues that stay apart for colour-blind eyes and in grey; then others, should there be more.
HUES = ("#1d5a91", "#b5485a", "#d9a02b", "#5b8c5a", "#7a5aa8")
SHAPES = {"slicing": "^", "hybrid": "o", "ray casting": "s"}
# Colour, dashes in points, marker, line width.
PART_STYLES = {"total": (INK, (), "o", 2.0), "sampling": ("#2f8f8b", (), "v", 1.2),
               "table": ("#8a63b8", (5, 2), "D", 1.2), "gpu": ("#8b8f96", (2, 1.5), "s", 1.2)}
SLOPES = {1: (6, 3), 2: (1.5, 2)}
RMSE = "RMSE of R, G, B (full scale 1)"
MOST_NAMES = 16  # on one plot


def hue(errors, classification):
    return HUES[errors.classifications.index(classification) % len(HUES)]


def _points(axes, errors, placed, **style):
    """Marks at (row, x, y): colour by classification, shape by ratio, hollow where the target has 8 bits."""
    alike = {}
    for row, x, y in placed:
        alike.setdefault((row.classification, row.ratio, row.target), []).append((x, y))
    for (classification, ratio, target), places in alike.items():
        colour = hue(errors, classification)
        axes.plot(*zip(*places), ls="none", marker=SHAPES.get(ratio, "o"), mec=colour,
                  mfc=PAPER_WHITE if target == "rgba8" else colour, **style)


def _log_axes(axes, plain_x):
    """Decades on both; the abscissa with plain numbers, 1 3 10 or 1 2 5 10 as there is room."""
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.yaxis.set_major_locator(LogLocator(10, numticks=9))
    axes.yaxis.set_minor_locator(NullLocator())
    axes.xaxis.set_minor_locator(NullLocator())
    if plain_x:
        low, high = axes.get_xlim()
        plain_log_ticks(axes.xaxis)
        subs = (1, 2, 5) if high < 30 * low else (1, 3) if high < 3e3 * low else (1,)
        axes.xaxis.set_major_locator(LogLocator(10, subs=subs, numticks=12))


def _label_front(figure, axes, labels):
    """Writes each (x, left end of its whisker, y, text) to the left of its point, where a front leaves room.

    Left of and below a front's point there is no other point: labels go there, each below the one
    before, and the axes grow until all fit.
    """
    made = [axes.annotate(text, (x, y), xytext=(0, 0), textcoords="offset points", ha="right", va="center",
                          fontsize=7, color=INK, zorder=6, annotation_clip=False,
                          bbox={"fc": PAPER_WHITE, "ec": "none", "pad": 0.4, "alpha": 0.8})
            for x, _, y, text in labels]
    for label in made:
        label.set_in_layout(False)
    figure.canvas.draw()
    box = axes.get_window_extent()
    pixel = figure.dpi / 72  # of a point
    widths = [label.get_window_extent().width + 12 * pixel for label in made]
    left, right = np.log10(axes.get_xlim())
    for (_, low, _, _), width in zip(labels, widths):
        share = min(0.8, width / box.width)
        left = min(left, (math.log10(low) - share * right) / (1 - share))
    axes.set_xlim(10 ** left, 10 ** right)
    height = 10.5 * pixel
    for _ in range(4):
        places, place = [], math.inf
        for x, _, y, _ in labels:
            place = min(axes.transData.transform((x, y))[1] - 2 * pixel, place - height)
            places.append(place)
        missing = box.y0 + 0.6 * height - min(places)
        if missing <= 0:
            break
        low, high = np.log10(axes.get_ylim())
        axes.set_ylim(10 ** (high - (high - low) * (1 + 1.1 * missing / box.height)), 10 ** high)
    for label, place, (x, low, y, _) in zip(made, places, labels):
        at, end = axes.transData.transform((x, y)), axes.transData.transform((low, y))[0]
        label.set_position(((end - at[0]) / pixel - 6, (place - at[1]) / pixel))
        if at[1] - place > 6 * pixel:
            foot = axes.transData.inverted().transform((end - 5 * pixel, place))
            axes.plot([foot[0], x], [foot[1], y], color=MUTED, lw=0.5, zorder=2)


def _front_names(errors, front, letter, narrow):
    marks = [letter(rank) for rank in range(1, len(front) + 1)]
    if narrow or len(front) > MOST_NAMES:
        return marks
    return [f"{errors.name(row)}  {mark}" for mark, row in zip(marks, front)]


def rank_by_time(rank):
    return str(rank)


def rank_by_fetches(rank):
    return chr(ord("a") + rank - 1) if rank <= 26 else f"z{rank - 26}"


def _work_precision(errors, narrow, front, cost, spread, letter, label, name):
    """All rows, error over cost, and the front: the staircase below which no setting gets."""
    rows = [row for row in errors.rows if cost(row) and row.rmse]
    if not rows:
        return None
    figure, axes = plt.subplots(figsize=(NARROW, 4.6) if narrow else (WIDE, 5.6))
    front = [row for row in front if cost(row) and row.rmse]
    for on_front, line, mark in ((False, {"lw": 0.7, "alpha": 0.3, "zorder": 2},
                                  {"ms": 3.8, "mew": 0.8, "alpha": 0.55, "zorder": 3}),
                                 (True, {"lw": 1.0, "alpha": 0.9, "zorder": 4}, {"ms": 6, "mew": 1.3, "zorder": 5})):
        shown = [row for row in rows if (row in front) == on_front]
        if shown:
            axes.hlines([row.rmse for row in shown], *zip(*(spread(row) for row in shown)),
                        colors=[hue(errors, row.classification) for row in shown], **line)
            _points(axes, errors, [(row, cost(row), row.rmse) for row in shown], **mark)
    axes.set_xlabel(label)
    axes.set_ylabel(RMSE)
    axes.margins(0.04)
    _log_axes(axes, plain_x=True)
    if not narrow:
        right = axes.secondary_yaxis("right", functions=(_psnr, _rmse_of))
        right.set_ylabel("PSNR, dB")
        right.yaxis.set_major_locator(MultipleLocator(10))
        right.yaxis.set_major_formatter(FuncFormatter(plain_number))
        right.yaxis.set_minor_locator(NullLocator())
    if front:
        axes.step([cost(row) for row in front], [row.rmse for row in front], where="post", color=INK, lw=1.1,
                  zorder=3.5)
        _label_front(figure, axes, [(cost(row), spread(row)[0], row.rmse, text) for row, text in
                                    zip(front, _front_names(errors, front, letter, narrow))])
    return svg(figure, f"{name}{'-n' if narrow else ''}", key_of_rows(errors, front=True))


def _psnr(rmse):
    return -20 * np.log10(np.maximum(rmse, 1e-30))


def _rmse_of(psnr):
    return 10 ** (-np.asarray(psnr) / 20)


def by_time(errors, narrow):
    return _work_precision(errors, narrow, errors.front, lambda row: row.median_ms,
                           lambda row: (row.low_ms, row.high_ms), rank_by_time,
                           "frame time, ms (median; whiskers: fastest to slowest frame)" if not narrow
                           else "frame time, ms", "time")


def by_fetches(errors, narrow):
    def millions(row):
        return (row.fetches or 0) / 1e6
    return _work_precision(errors, narrow, errors.front_by_fetches, millions, lambda row: (millions(row),) * 2,
                           rank_by_fetches, "fetches of volume and skip structure, millions a frame" if not narrow
                           else "fetches, millions a frame", "fetches")


def _family_to_show(errors, classification):
    """One family for a panel: the most spacings; then what blends, stops and jitters least."""
    return max((family for family in errors.families() if family[0].classification == classification),
               key=lambda family: (len(family), family[0].target == "rgba16f", not family[0].jitter,
                                   family[0].raw.get("termination") == "off", family[0].layers == 0))


def _slopes(axes, x, y):
    """What order 1 and 2 look like, from the coarsest row on."""
    for order, dashes in SLOPES.items():
        axes.plot([x[0], x[-1]], [y, y * (x[0] / x[-1]) ** order], color=MUTED, lw=0.8, dashes=dashes, zorder=1)


def convergence(errors, narrow):
    """The error's parts over layers per voxel, for one family of each classification."""
    families = [family for name in errors.classifications
                if len(family := _family_to_show(errors, name)) > 1]
    if not families:
        return None
    lines, columns = (len(families), 1) if narrow else (-(-len(families) // 3), min(3, len(families)))
    figure, grid = plt.subplots(lines, columns, sharex=True, sharey=True, squeeze=False,
                                figsize=(NARROW, 2.5 * lines + 0.9) if narrow else (WIDE, 3.2 * lines + 0.6))
    panels = list(grid.flat)
    for axes in panels[len(families):]:
        axes.set_visible(False)
    for axes, family in zip(panels, families):
        for part in PARTS:
            points = [(1 / row.spacing, row.error(part)) for row in family if row.error(part)]
            colour, dashes, marker, width = PART_STYLES[part]
            axes.plot([x for x, _ in points], [y for _, y in points], color=colour, dashes=dashes or (None, None),
                      lw=width, marker=marker, ms=3.5, zorder=4 if part == "total" else 3)
        start = next((row for row in family if row.rmse), None)
        if start:
            _slopes(axes, [1 / start.spacing, 1 / family[-1].spacing], start.rmse)
        _log_axes(axes, plain_x=False)
        axes.set_title(NAMES.get(family[0].classification, family[0].classification), pad=16,
                       color=hue(errors, family[0].classification))
        axes.annotate(", ".join(say(family[0], name) for name in FAMILY if name != "classify"), (0, 1),
                      xycoords="axes fraction", xytext=(0, 4), textcoords="offset points", fontsize=6.8, color=MUTED)
        spacings = sorted({1 / row.spacing for row in family})
        axes.set_xticks(spacings, [f"{x:g}" for x in spacings])
    figure.supxlabel("layers per voxel", fontsize=9)
    figure.supylabel(RMSE, fontsize=9)
    return svg(figure, f"convergence{'-n' if narrow else ''}", key_of_parts())


def target_groups(errors):
    """Rows that differ in planes and target alone: for each classification the spacing where most planes were
    drawn into both targets; the finest of those. [(classification, {target: rows})]"""
    groups = []
    for name in errors.classifications:
        pairs = {}
        for eight, half in errors.pairs("target", "rgba8", "rgba16f"):
            if eight.classification == name and not eight.jitter:
                place = (eight.spacing, str(eight.raw.get("termination")))
                pairs.setdefault(place, []).append((eight, half))
        if pairs:
            place = max(pairs, key=lambda place: (len(pairs[place]), place[1] == "off", -place[0]))
            found = sorted(pairs[place], key=lambda pair: pair[0].planes)
            if len(found) > 1:
                groups.append((name, {"rgba8": [pair[0] for pair in found], "rgba16f": [pair[1] for pair in found]}))
    return groups


def by_planes(errors, narrow):
    """What blending rounds away: the whole error and the GPU's part of it, over the number of planes."""
    groups = target_groups(errors)
    if not groups:
        return None
    figure, grid = plt.subplots(*((2, 1) if narrow else (1, 2)), sharex=True, sharey=True,
                                figsize=(NARROW, 5.6) if narrow else (WIDE, 3.5))
    for axes, part, title in zip(grid, ("total", "gpu"), ("whole error", "the GPU's part")):
        for name, targets in groups:
            for target, rows in targets.items():
                points = [(row, row.planes, row.error(part)) for row in rows if row.error(part) and row.planes]
                axes.plot([x for _, x, _ in points], [y for _, _, y in points], color=hue(errors, name), lw=1.4,
                          dashes=(4, 2) if target == "rgba8" else (None, None), zorder=3)
                _points(axes, errors, points, ms=5, mew=1.2, zorder=4)
        _log_axes(axes, plain_x=True)
        axes.set_title(title)
        if not narrow or axes is grid[-1]:
            axes.set_xlabel("planes")
    figure.supylabel(RMSE, fontsize=9)
    return svg(figure, f"planes{'-n' if narrow else ''}", key_of_rows(errors, lines=True))


def jitter(errors, narrow):
    """Each setting with jitter over the same without: below the diagonal, jitter helps."""
    pairs = errors.pairs("jitter", False, True)
    panels = [(("total", "rmse"), RMSE), (("total", "p999_delta_e"), "99.9th percentile of ΔE 2000")]
    panels = [(what, title, points) for what, title in panels
              if (points := [(b, a.error(*what), b.error(*what)) for a, b in pairs
                             if a.error(*what) and b.error(*what)])]
    if not panels:
        return None
    lines, columns = (len(panels), 1) if narrow else (1, len(panels))
    figure, grid = plt.subplots(lines, columns, squeeze=False,
                                figsize=(NARROW, 3.9 * lines) if narrow else (WIDE, 4.2))
    for axes, (_, title, points) in zip(grid.flat, panels):
        _points(axes, errors, points, ms=4.5, mew=1.0, alpha=0.8, zorder=3)
        _log_axes(axes, plain_x=False)
        axes.xaxis.set_major_locator(LogLocator(10, numticks=9))
        values = [value for _, x, y in points for value in (x, y)]
        ends = (min(values) / 1.4, max(values) * 1.4)
        axes.set(xlim=ends, ylim=ends, box_aspect=1, xlabel="without jitter", ylabel="with jitter")
        axes.plot(ends, ends, color=MUTED, lw=0.9, zorder=1)
        axes.set_title(title)
    return svg(figure, f"jitter{'-n' if narrow else ''}", key_of_rows(errors))


def key_of_rows(errors, ratios=True, front=False, lines=False):
    """Entries of the legend of all plots that have a point per row."""
    solid, dashed = ("" if lines else None), ("4 2" if lines else None)
    entries = [(NAMES.get(name, name), hue(errors, name), "o", False, solid) for name in errors.classifications]
    shown = [ratio for ratio in SHAPES if ratios and any(row.ratio == ratio for row in errors.rows)]
    entries += [(ratio, MUTED, SHAPES[ratio], False, None) for ratio in shown if len(shown) > 1]
    if len({row.target for row in errors.rows}) > 1:
        entries += [("filled: RGBA16F", MUTED, "o", False, solid), ("hollow: RGBA8", MUTED, "o", True, dashed)]
    if front:
        entries.append(("front: nothing is both cheaper and more accurate", INK, None, False, ""))
    return entries


def key_of_parts():
    texts = {"sampling": "sampling: finite layers, classifying first",
             "gpu": "GPU: texel format, filter, float32, termination, blending"}
    entries = [(texts.get(part, part), colour, marker, False, " ".join(f"{d:g}" for d in dashes))
               for part, (colour, dashes, marker, _) in PART_STYLES.items()]
    return entries + [(f"slope of order {order}", MUTED, None, False, " ".join(f"{d:g}" for d in dashes))
                      for order, dashes in SLOPES.items()]
