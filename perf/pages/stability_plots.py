"""Plots of stability cases, as SVG text. Each is drawn wide for desks and narrow for phones."""

import textwrap

import numpy as np
from matplotlib.ticker import FuncFormatter, LogLocator, NullLocator

from page_input import number
from page_svg import INK, NARROW, WIDE, plain_log_ticks, plt, svg

PASSED, FAILED = "#1d5a91", "#c0392b"
LEAST, MOST = 1e-6, 1e2  # shares of the bound that are told apart; what is beyond lies at the rim
HUES = ("#22262b", "#1d5a91", "#b5485a", "#d9a02b", "#2f8f8b")
SHAPES = "os^vD"
RANGE = 1e6  # of the ordinate, at most, where no bounds are drawn
BELOW = 20  # times below the least bound an ordinate begins
PLAIN = 1e3  # of the abscissa: beyond, its ticks are decades
MOST_CURVES = 6  # in a panel, before it is divided


def shares(stability, narrow):
    """How much of its bound each case uses: a dot per case, a line per family."""
    families = stability.families
    figure, axes = plt.subplots(figsize=(NARROW, 0.5 * len(families) + 0.9) if narrow else
                                (WIDE, 0.42 * len(families) + 0.8))
    scatter = np.random.default_rng(1)  # the same page from the same cases
    for place, family in enumerate(families):
        for passed, colour, marker in ((True, PASSED, "o"), (False, FAILED, "X")):
            found = [case.share for case in family.cases if case.passed == passed and case.share is not None]
            places = place + 0.22 * scatter.uniform(-1, 1, len(found))
            axes.plot(np.clip(found, LEAST, MOST), places, marker, ls="none", ms=3.6 if passed else 6, mec="none",
                      mfc=colour, alpha=0.5 if passed else 1, clip_on=False, zorder=3)
    axes.axvline(1, color=INK, lw=1.2, zorder=2)
    axes.set_xscale("log")
    axes.set_xlim(LEAST, MOST)
    axes.xaxis.set_major_locator(LogLocator(10, numticks=10))
    axes.xaxis.set_minor_locator(NullLocator())
    ticks = [10.0 ** e for e in range(-6, 3, 2)]
    axes.set_xticks(ticks, ["≤ $10^{-6}$", *(f"$10^{{{e}}}$" for e in range(-4, 0, 2)), "1", "≥ 100"])
    axes.set_yticks(range(len(families)), [family.name for family in families])
    axes.set_ylim(len(families) - 0.5, -0.5)
    axes.grid(axis="y", visible=False)
    axes.tick_params(axis="y", length=0)
    axes.set_xlabel("measured, as a share of the bound")
    return svg(figure, f"shares{'-n' if narrow else ''}")


def plots_of(family):
    """What the family's cases plot: [((x label, y label), {panel: {group: [(x, y, bound or None)]}})].

    Panels stand in one plot where they share their labels and their groups.
    """
    panels = {}
    for case in family.cases:
        series = case.extra("series")
        x, y = number(series.get("x")), number(series.get("y"))
        if x is not None and y is not None and x > 0 and y >= 0:
            labels, panel, group = ((str(series.get("x_label", "x")), str(series.get("y_label", "y"))),
                                    str(series.get("panel", "")), str(series.get("group", "")))
            panels.setdefault((labels, panel), {}).setdefault(group, []).append(
                (x, y, number(series.get("bound"))))
    found = {}
    for (labels, panel), groups in panels.items():
        for title, divided in _divided(panel, groups).items():
            found.setdefault((labels, frozenset(divided)), {})[title] = divided
    return [(labels, together) for (labels, _), together in found.items()]


def _divided(panel, groups):
    """A crowded panel's groups by the first part of their names: "planar, slicing", "shells, slicing"."""
    parts = {name: name.partition(", ") for name in groups}
    if len(groups) <= MOST_CURVES or len({first for first, _, _ in parts.values()}) < 2 or not all(
            rest for _, _, rest in parts.values()):
        return {panel: groups}
    found = {}
    for name, (first, _, rest) in parts.items():
        found.setdefault(", ".join(filter(None, (panel, first))), {})[rest] = groups[name]
    return found


def _styles(panels):
    """A colour and a mark for each group, the same in all panels."""
    names = list(dict.fromkeys(name for groups in panels.values() for name in groups))
    return {name: (HUES[i % len(HUES)], SHAPES[i % len(SHAPES)], i >= len(HUES))
            for i, name in enumerate(names)}


def _power_of_ten(value, _=None):
    """10⁻³ in letters: quicker to set than a formula, and text where the figure is read."""
    power = round(np.log10(value))
    return "1" if power == 0 else "10" + str(power).translate(str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹"))


def _decades(axis):
    axis.set_major_locator(LogLocator(10, numticks=9))
    axis.set_major_formatter(FuncFormatter(_power_of_ten))


def _key(panels):
    entries = [(name, colour, shape, again, "4 2" if again else "")
               for name, (colour, shape, again) in _styles(panels).items()]
    return entries + ([("bound", INK, None, False, "1 2")] if _bounds(panels) else [])


def _bounds(panels):
    return [bound for groups in panels.values() for points in groups.values() for _, _, bound in points if bound]


def floor_of(panels):
    """What is below is drawn there: beneath all bounds, or at a millionth of the largest."""
    bounds = _bounds(panels)
    if bounds:
        return min(bounds) / BELOW
    return (max(y for groups in panels.values() for points in groups.values() for _, y, _ in points) or 1.0) / RANGE


def _curve(axes, points, style, floor):
    colour, shape, again = style
    points = sorted(points, key=lambda point: point[0])
    axes.plot([x for x, _, _ in points], [max(y, floor) for _, y, _ in points], color=colour, marker=shape, ms=4.5,
              lw=1.4, mec=colour, mfc="white" if again else colour, dashes=(4, 2) if again else (None, None), zorder=3)
    bounds = [(x, bound) for x, _, bound in points if bound]
    if bounds:
        axes.plot(*zip(*bounds), color=colour, lw=1.1, dashes=(1, 2), zorder=2)


def curves(panels, labels, name):
    """A function for page_html.figure: y over x, a curve per group, log-log, and the bounds of y where they are told;
    what is tiny or zero at the rim."""
    floor = floor_of(panels)
    xs = [x for groups in panels.values() for points in groups.values() for x, _, _ in points]

    def draw(_, narrow):
        lines, columns = (len(panels), 1) if narrow else (-(-len(panels) // 2), min(2, len(panels)))
        figure, grid = plt.subplots(lines, columns, sharex=True, sharey=True, squeeze=False,
                                    figsize=(NARROW, 3.3 * lines + 0.3) if narrow else (WIDE, 3.7 * lines + 0.3))
        for axes in list(grid.flat)[len(panels):]:
            axes.set_visible(False)
        for axes, (title, groups) in zip(grid.flat, panels.items()):
            for group, points in groups.items():
                _curve(axes, points, _styles(panels)[group], floor)
            axes.set(xscale="log", yscale="log", title=textwrap.fill(title, 46))
            (plain_log_ticks if max(xs) <= PLAIN * min(xs) else _decades)(axes.xaxis)
            _decades(axes.yaxis)
            for axis in (axes.xaxis, axes.yaxis):
                axis.set_minor_locator(NullLocator())
        figure.supxlabel(labels[0], fontsize=9)
        figure.supylabel(labels[1], fontsize=9)
        return svg(figure, f"{name}{'-n' if narrow else ''}", _key(panels))
    return draw
