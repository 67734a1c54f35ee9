"""Plots of what verifies the error itself: refinement with its expected orders, and the worst ray."""

import math

from matplotlib.ticker import LogLocator, NullLocator

import error_plots
from error_data import NAMES
from error_plots import HUES
from page_input import number, section
from page_svg import INK, MUTED, NARROW, WIDE, plt

KINDS = {"step": "step", "grid": "grid", "pixel": "pixel"}
SHAPES = ("o", "s", "^", "v", "D")
GUIDES = {2.0: (1.5, 2), 1.0: (6, 3), 0.5: (6, 2, 1.5, 2)}
CONTROL_HUE = HUES[1]
CHANNELS = (("red", "#b5485a"), ("green", "#5b8c5a"), ("blue", "#1d5a91"), ("alpha", INK))


def studies(errors, kind=None):
    """The refinement's studies that can be drawn, of one kind or all."""
    found = section(errors.raw, "refinement").get("studies")
    usable = [s for s in found if isinstance(s, dict) and isinstance(s.get("levels"), list)] if isinstance(
        found, list) else []
    return [s for s in usable if kind is None or s.get("kind") == kind]


def points_of(study):
    """(size, RMSE) of its levels, those that a logarithm has room for."""
    pairs = [(number(level.get("size")), number(level.get("rmse"))) for level in study["levels"]
             if isinstance(level, dict)]
    return [(x, y) for x, y in pairs if x and y and x > 0 and y > 0]


def shape_of(errors, study):
    """Methods of one kind are told apart by their marks."""
    alike = [s for s in studies(errors, study.get("kind")) if bool(s.get("control")) == bool(study.get("control"))]
    return SHAPES[alike.index(study) % len(SHAPES)]


def _guides(axes, orders, lines):
    """How errors of the expected orders fall, through the middle of the plot."""
    xs = [x for line in lines for x, _ in line]
    left, right = min(xs), max(xs)
    for order, start in orders.items():
        axes.plot([right, left], [start, start * (left / right) ** order], color=MUTED, lw=0.8,
                  dashes=GUIDES.get(order, (1, 1)), zorder=1)


def refinement(errors, narrow):
    """RMSE over what is refined, a panel for each kind, coarse on the left."""
    kinds = [kind for kind in KINDS if any(points_of(s) for s in studies(errors, kind))]
    if not kinds:
        return None
    figure, grid = plt.subplots(*((len(kinds), 1) if narrow else (1, len(kinds))), squeeze=False,
                                figsize=(NARROW, 3.0 * len(kinds)) if narrow else (WIDE, 3.9))
    for axes, kind in zip(grid.flat, kinds):
        shown = [(s, points) for s in studies(errors, kind) if (points := points_of(s))]
        axes.set_xscale("log")
        axes.set_yscale("log")
        for study, points in shown:
            control = bool(study.get("control"))
            axes.plot(*zip(*points), color=CONTROL_HUE if control else HUES[0], lw=1.1 if control else 1.7,
                      dashes=(3, 2) if control else (None, None), marker=shape_of(errors, study), ms=4,
                      mfc="none" if control else None, zorder=3 if control else 4)
        expected = {}
        for study, points in shown:
            order = number(study.get("expected_order"))
            if not study.get("control") and order:
                expected.setdefault(order, 1.8 * points[0][1])
        _guides(axes, expected, [points for _, points in shown])
        axes.invert_xaxis()
        axes.yaxis.set_major_locator(LogLocator(10, numticks=9))
        axes.yaxis.set_minor_locator(NullLocator())
        axes.xaxis.set_minor_locator(NullLocator())
        sizes = sorted({x for _, points in shown for x, _ in points})
        ticks = sizes[::max(1, math.ceil(len(sizes) / 5))]
        axes.set_xticks(ticks, [f"1/{1 / x:.0f}" if kind == "pixel" else f"{x:.2g}" for x in ticks])
        axes.set_xlabel({"step": "step, mm", "grid": "voxel edge, mm",
                         "pixel": "pixel edge, share of the picture"}[kind])
        axes.set_title(f"{kind} refined")
    figure.supylabel("RMSE of R, G, B and alpha", fontsize=9)
    return error_plots.svg(figure, f"refinement{'-n' if narrow else ''}", key_of_refinement(errors))


def key_of_refinement(errors):
    """One entry per method of a kind, then the guides."""
    entries = []
    for kind in KINDS:
        for study in studies(errors, kind):
            control = bool(study.get("control"))
            colour = CONTROL_HUE if control else HUES[0]
            entries.append((f"{kind}: {study.get('method')}", colour, shape_of(errors, study), control,
                            "3 2" if control else ""))
    if any(study.get("control") for study in studies(errors)):
        entries.append(("dashed: negative control", CONTROL_HUE, None, True, "3 2"))
    guides = sorted({order for s in studies(errors) if not s.get("control")
                     and (order := number(s.get("expected_order")))}, reverse=True)
    return entries + [(f"slope of order {order:g}", MUTED, None, False,
                       " ".join(f"{d:g}" for d in GUIDES.get(order, (1, 1)))) for order in guides]


def _layers(ray):
    layers = ray.get("layers")
    return [layer for layer in layers if isinstance(layer, dict) and number(layer.get("distance_mm")) is not None] \
        if isinstance(layers, list) else []


def worst_ray(ray, narrow):
    """Along the ray: what is there, what was gathered and should have been, and their difference."""
    layers = _layers(ray)
    if len(layers) < 2:
        return None
    along = [layer["distance_mm"] for layer in layers]
    figure, grid = plt.subplots(3, 1, sharex=True, figsize=(NARROW if narrow else WIDE, 6.0),
                                gridspec_kw={"height_ratios": (1, 1.3, 1.3)})
    value, gathered, apart = grid
    value.plot(along, [layer.get("value") for layer in layers], color=INK, lw=1.2)
    value.set_ylabel("value")
    opacity = value.twinx()
    opacity.fill_between(along, [layer.get("opacity") or 0 for layer in layers], color=HUES[2], alpha=0.35, lw=0)
    opacity.set_ylabel("opacity a unit")
    opacity.grid(False)
    opacity.set_ylim(bottom=0)
    for index, (_, colour) in enumerate(CHANNELS):
        exact = [layer["exact"][index] for layer in layers]
        summed = [layer["gathered"][index] for layer in layers]
        gathered.plot(along, exact, color=colour, lw=2.4, alpha=0.35, zorder=3)
        gathered.plot(along, summed, color=colour, lw=1.0, dashes=(4, 2), zorder=4)
        apart.plot(along, [a - b for a, b in zip(summed, exact)], color=colour, lw=1.1)
    gathered.set_ylabel("gathered")
    apart.set_ylabel("layers − exact")
    apart.axhline(0, color=MUTED, lw=0.8)
    apart.set_xlabel("distance from the eye, mm")
    return error_plots.svg(figure, f"ray{'-n' if narrow else ''}", key_of_ray())


def key_of_ray():
    return [*((name, colour, None, False, "") for name, colour in CHANNELS),
            ("the layers’ sum", MUTED, None, False, "4 2"), ("exact integral: broad and pale", MUTED, None, False, ""),
            ("opacity of the transfer function: filled", HUES[2], "s", False, None)]


def family_name(family):
    name = NAMES.get(family.get("classify"), str(family.get("classify")))
    return name + (", jitter" if family.get("jitter") else "")
