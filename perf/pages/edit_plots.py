"""Plots of replayed edits, as SVG text. Each is drawn wide for desks and narrow for phones."""

from matplotlib.transforms import blended_transform_factory

from edit_data import PARTS
from page_svg import INK, MUTED, NARROW, WIDE, plain_log_ticks, plt, svg

LIVE, NAIVE, COMPARED, BUDGET = INK, "#c8643a", "#8fb0cc", "#b02a1e"
FETCHES = {"volume_fetches": ("of voxels", INK), "skip_fetches": ("of the skip structure", "#1d5a91")}
STRUCTURES = {"bitfield-octree": "#1d5a91", "minmax-octree": "#1d5a91", "partitioned": "#1d5a91",
              "proximity": "#7fb58a", "chebyshev": "#7fb58a", "blocks": "#7fb58a", "none": "#d9d4c7",
              "nothing drawn": "#f0eee7"}
OTHER = "#b9a6cf"
PART_HUES = {"edit_ms": "#1d5a91", "work_ms": "#d9a02b", "prepare_ms": "#8b8f96"}
WIDE_SPREAD = 6  # of frame times, from which on the axis is logarithmic


def structure_hue(name):
    return STRUCTURES.get(name, OTHER)


def key_of_trace(edit):
    lines = [("live policy", LIVE, None, False, ""), ("naive: all rebuilt at every edit", NAIVE, None, False, ""),
             (f"{edit.compared}, made beforehand", COMPARED, None, False, "")]
    if edit.budgets:
        lines.append(("budget", BUDGET, None, False, "4 2"))
    return lines + [*((f"skipping: {name}", structure_hue(name), "s", False, None) for name in edit.structures),
                    ("edit", INK, "^", False, None)]


def _steps_above(edit, axes, narrow):
    """Names the script's steps where they begin, as far as there is room."""
    place = blended_transform_factory(axes.transData, axes.transAxes)
    room = len(edit.frames) * (0.16 if narrow else 0.07)
    free_from = 0
    for name, first, end in edit.runs(lambda frame: frame.step):
        axes.axvline(first, color=MUTED, lw=0.5, dashes=(1, 3), zorder=0)
        if first >= free_from:
            axes.text(first, 1.01, f" {name}", transform=place, fontsize=7, color=MUTED, ha="left", va="bottom")
            free_from = first + room


def _band(edit, axes):
    """What skipped in each frame, and where the TF was edited."""
    for name, first, end in edit.runs(lambda frame: frame.structure):
        axes.broken_barh([(first, end - first)], (0, 1), color=structure_hue(name), lw=0)
    places = [i + 0.5 for i, frame in enumerate(edit.frames) if frame.edited]
    axes.plot(places, [-0.55] * len(places), "^", ms=2.6, mec="none", mfc=INK, clip_on=False)
    axes.set_ylim(-1.1, 1)
    axes.set_yticks([])
    axes.grid(visible=False)
    axes.spines["left"].set_visible(False)
    axes.set_xlabel("frame")


def trace(edit, narrow):
    """Frame time over frame number: the policy, what it is measured against, the budget."""
    figure, (axes, band) = plt.subplots(
        2, 1, sharex=True, figsize=(NARROW, 3.9) if narrow else (WIDE, 4.3),
        gridspec_kw={"height_ratios": [9, 1], "hspace": 0.02})
    numbers = [i + 0.5 for i in range(len(edit.frames))]

    def draw(name, **style):
        axes.plot(numbers, [frame.times[name] for frame in edit.frames], drawstyle="steps-mid", **style)

    draw("naive_ms", color=NAIVE, lw=1.0, alpha=0.85, zorder=2)
    draw("octree_ms", color=COMPARED, lw=2.6, zorder=3, alpha=0.9)
    draw("frame_ms", color=LIVE, lw=1.2, zorder=4)
    if edit.budgets:
        axes.plot(numbers, edit.budgets, drawstyle="steps-mid", color=BUDGET, lw=1.1, dashes=(4, 2), zorder=5)
    most = max(max(frame.frame_ms, frame.naive_ms) for frame in edit.frames)
    least = min(frame.frame_ms for frame in edit.frames)
    if most > WIDE_SPREAD * least:
        axes.set_yscale("log")
        plain_log_ticks(axes.yaxis)
    else:
        axes.set_ylim(0, 1.06 * max(most, *(edit.budgets or [0])))
    axes.set_xlim(0, len(edit.frames))
    axes.set_ylabel("frame, ms")
    axes.tick_params(axis="x", length=0)
    _steps_above(edit, axes, narrow)
    _band(edit, band)
    return svg(figure, f"trace{'-n' if narrow else ''}", key_of_trace(edit))


def parts(edit, narrow):
    """What frames take beside drawing, stacked; the line is what rebuilding may take."""
    figure, axes = plt.subplots(figsize=(NARROW, 2.5) if narrow else (WIDE, 2.6))
    numbers = [i + 0.5 for i in range(len(edit.frames))]
    bottom = [0.0] * len(edit.frames)
    for name, hue in PART_HUES.items():
        heights = [frame.times[name] for frame in edit.frames]
        axes.bar(numbers, heights, 1.0, bottom, color=hue, lw=0, zorder=2)
        bottom = [low + height for low, height in zip(bottom, heights)]
    axes.set_xlim(0, len(edit.frames))
    axes.set_xlabel("frame")
    axes.set_ylabel("beside drawing, ms")
    _steps_above(edit, axes, narrow)
    return svg(figure, f"parts{'-n' if narrow else ''}",
               [(PARTS[name], hue, "s", False, None) for name, hue in PART_HUES.items()])


def fetches(edit, narrow):
    """Texels that are looked at in each frame; nothing where the device cannot count them."""
    if any(frame.count(name) is None for frame in edit.frames for name in FETCHES):
        return None
    figure, axes = plt.subplots(figsize=(NARROW, 2.5) if narrow else (WIDE, 2.6))
    numbers = [i + 0.5 for i in range(len(edit.frames))]
    for name, (_, hue) in FETCHES.items():
        axes.plot(numbers, [frame.count(name) / 1e6 for frame in edit.frames], drawstyle="steps-mid", color=hue, lw=1.3)
    axes.set_xlim(0, len(edit.frames))
    axes.set_ylim(bottom=0)
    axes.set_xlabel("frame")
    axes.set_ylabel("fetches, millions")
    _steps_above(edit, axes, narrow)
    return svg(figure, f"fetches{'-n' if narrow else ''}",
               [(name, hue, None, False, "") for name, hue in FETCHES.values()])
