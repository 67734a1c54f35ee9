"""Plots of the ways of skipping, as SVG text. Each is drawn wide for desks and narrow for phones."""

from matplotlib.ticker import FixedLocator, FuncFormatter, LogLocator, NullFormatter, NullLocator

from page_svg import INK, MUTED, NARROW, PAPER_WHITE, WIDE, plain_number, plt, svg
from skipbench_data import MODES, NAMES, STRUCTURES, middle

COLOURS = {"none": "#8b8f96", "blocks": "#b59a6a", "proximity": "#1d5a91", "chebyshev": "#5aa0a8",
           "partitioned": "#2f8f6b", "boolean-octree": "#d9a02b", "minmax-octree": "#b5485a",
           "bitfield-octree": "#7a5aa8"}
TRANSFERS = {"TF1": "#1d5a91", "TF2": "#8b8f96", "TF3": "#d9a02b", "TF4": "#b5485a", "TF5": "#2f8f6b",
             "TF6": "#7a5aa8"}
DIAMOND = {"marker": "D", "ms": 3.2, "mfc": PAPER_WHITE, "mec": INK, "mew": 0.8, "ls": "none", "zorder": 5}


def key_of_structures(structures):
    return [(NAMES[name], COLOURS[name], "s", False, None) for name in STRUCTURES if name in structures]


def _log_axis(axis):
    axis.set_major_locator(LogLocator(10, subs=(1, 2, 5), numticks=12))
    axis.set_major_formatter(FuncFormatter(plain_number))
    axis.set_minor_locator(NullLocator())


def _id(what, bench, volume, narrow):
    """Of a plot, unique in the page and of plain letters, which a volume's name may not be."""
    place = [entry.get("name") for entry in bench.volumes].index(volume)
    return f"{what}-{place}{'-n' if narrow else ''}"


def _bar(axes, place, row, **look):
    """From 1, what none takes: to the right what is faster, to the left what is slower; with the ratio's interval."""
    axes.barh(place, row.speedup - 1, left=1, zorder=2, **look)
    low, high = row.interval
    if low is not None and high is not None:
        axes.errorbar(row.speedup, place, xerr=[[row.speedup - low], [high - row.speedup]], fmt="none", ecolor=INK,
                      elinewidth=0.9, capsize=1.8, capthick=0.9, zorder=4.5)


def _panels(titles, tall, narrow):
    """Panels side by side, or one below the other; all have the axis of speed-ups, log as ratios are."""
    lines, columns = (len(titles), 1) if narrow else (1, len(titles))
    figure, grid = plt.subplots(lines, columns, squeeze=False, sharex=True,
                                figsize=(NARROW, tall * lines + 0.3) if narrow else (WIDE, tall + 0.6))
    for axes, title in zip(grid.flat, titles):
        axes.axvline(1, color=INK, lw=0.9, zorder=4)
        axes.set_title(title)
        axes.set_xscale("log")
        _log_axis(axes.xaxis)
        axes.grid(axis="y", visible=False)
        axes.tick_params(axis="x", labelbottom=True)
        axes.tick_params(axis="y", length=0, labelleft=narrow or axes is grid.flat[0])
    return figure, grid.flat


def _name_bars(axes, names):
    """From the top down."""
    axes.set_yticks(range(len(names)), [NAMES.get(name, name) for name in names], fontsize=8)
    axes.invert_yaxis()


def _name_axis(panels, text, narrow):
    panels[-1 if narrow else len(panels) // 2].set_xlabel(text, color=MUTED)


def _skipping(bench, volume, family, mode):
    """Rows of frames but what all are compared with; none with rectangles first."""
    rows = bench.of("frames", volume=volume, family=family, mode=mode)
    return sorted((row for row in rows if row.structure != "none" or row.get("tighten")),
                  key=lambda row: row.structure != "none")


def speedups(bench, volume):
    """Bars of ray casting: a panel per mode, a bar per structure, the paper's figures as marks on it."""
    def draw(_, narrow):
        modes = {mode: rows for mode in MODES if (rows := _skipping(bench, volume, "ray casting", mode))}
        if not modes:
            return None
        figure, panels = _panels(list(modes), 2.1, narrow)
        for axes, (mode, rows) in zip(panels, modes.items()):
            for place, row in enumerate(rows):
                _bar(axes, place, row, height=0.66, color=COLOURS.get(row.structure, MUTED))
                for value in bench.published(row.structure, mode):
                    axes.plot(value, place, **DIAMOND)
            _name_bars(axes, [row.structure for row in rows])
        _name_axis(panels, "times as fast as none (log)", narrow)
        entries = [("interval of the ratio", INK, "|", False, "")]
        if any(bench.published(row.structure, mode) for mode, rows in modes.items() for row in rows):
            entries.append(("the paper's datasets, on its device", INK, "D", True, None))
        return svg(figure, _id("speed", bench, volume, narrow), entries)
    return draw


def families(bench, volume):
    """The best of each family and structure, as a multiple of the speed of that family without skipping."""
    def draw(_, narrow):
        groups = {(family, mode): rows for family in ("hybrid", "slicing") for mode in MODES
                  if (rows := _skipping(bench, volume, family, mode))}
        if not groups:
            return None
        figure, panels = _panels([family if family == "slicing" else f"{family}, {mode}" for family, mode in groups],
                                 2.3, narrow)
        for axes, rows in zip(panels, groups.values()):
            names = list(dict.fromkeys(row.structure for row in rows))
            apart = 0.19 if len(rows) > len(names) else 0  # of the two kinds of planes
            for row in rows:
                tight, colour = bool(row.get("tighten")), COLOURS.get(row.structure, MUTED)
                _bar(axes, names.index(row.structure) + (apart if tight else -apart), row, edgecolor=colour,
                     height=0.34 if apart else 0.66, color=colour if tight else PAPER_WHITE, linewidth=1)
            _name_bars(axes, names)
        _name_axis(panels, "times as fast as none, planes of the sphere (log)", narrow)
        return svg(figure, _id("families", bench, volume, narrow),
                   [("planes as rectangles", MUTED, "s", False, None), ("planes of the sphere", MUTED, "s", True, None),
                    ("interval of the ratio", INK, "|", False, "")])
    return draw


def merging(bench, volume):
    """A panel per block edge: merge times over partitions, against both ways to rebuild."""
    def draw(_, narrow):
        edges = sorted({row.get("skip_block") for row in bench.of("rebuild", volume=volume)}, reverse=True)
        if not edges:
            return None
        columns = 1 if narrow else len(edges)
        lines = len(edges) if narrow else 1
        counts = sorted({row.get("partitions") for row in bench.of("partitions", volume=volume)})
        figure, grid = plt.subplots(lines, columns, squeeze=False, sharex=True,
                                    figsize=(NARROW, 2.5 * lines) if narrow else (WIDE, 3.1))
        for axes, edge in zip(grid.flat, edges):
            for transfer, colour in TRANSFERS.items():
                rows = bench.of("merge", volume=volume, skip_block=edge, tf=transfer)
                axes.plot([row.get("partitions") for row in rows], [row.at("update_ms", "median") for row in rows],
                          "o-", color=colour, lw=1.3, ms=3.4, zorder=3)
            rebuilds = bench.of("rebuild", volume=volume, skip_block=edge, skip="chebyshev")
            for name, style in (("build_ms", "-"), ("of_ranges_ms", (0, (4, 3)))):
                level = middle([row.at(name, "median") for row in rebuilds])
                if level is not None:
                    axes.axhline(level, color=INK, lw=1.1, ls=style, zorder=2)
            axes.set_xscale("log", base=2)
            axes.set_yscale("log")
            axes.xaxis.set_major_locator(FixedLocator(counts))
            axes.xaxis.set_major_formatter(FuncFormatter(plain_number))
            axes.xaxis.set_minor_formatter(NullFormatter())
            axes.set_xlim(min(counts) * 0.8, max(counts) * 1.25)
            axes.tick_params(axis="x", labelbottom=True)
            _log_axis(axes.yaxis)
            axes.set_title(f"blocks of {edge}³ voxels" if edge > 1 else "single voxels")
            axes.set_xlabel("partitions", color=MUTED)
        grid.flat[0].set_ylabel("ms (log)")
        return svg(figure, _id("merging", bench, volume, narrow), key_of_transfers(bench, volume))
    return draw


def key_of_transfers(bench, volume):
    names = {row.get("tf"): row.get("tf_name") for row in bench.of("rebuild", volume=volume)}
    merged = [(f"{tf}: {names[tf]}", colour, "o", False, "") for tf, colour in TRANSFERS.items() if tf in names]
    return [*merged, ("rebuilt in full", INK, None, False, ""), ("rebuilt of kept ranges", INK, None, False, "4 3")]


def _mebibytes(row):
    """On the GPU, and of partitioned maps on the host; None where nothing is held."""
    held = row.at("gpu_bytes")
    return None if held is None else (held + (row.at("host_bytes") or 0)) / 2 ** 20


SIZED = (("build, ms", lambda row: row.at("build_ms", "median")), ("memory, MiB", _mebibytes),
         ("frame, ms", lambda row: row.ms))


def sizes(bench, narrow):
    """Build time, memory and frame time over the cube's edge, log-log."""
    rows = bench.of("sizes")
    edges = sorted({row.get("edge") for row in rows})
    if not edges:
        return None
    figure, grid = plt.subplots(3 if narrow else 1, 1 if narrow else 3, squeeze=False,
                                figsize=(NARROW, 7.2) if narrow else (WIDE, 3.0))
    for axes, (title, cost) in zip(grid.flat, SIZED):
        for name in STRUCTURES:
            points = sorted((row.get("edge"), value) for row in rows
                            if row.structure == name and (value := cost(row)))
            if points:
                axes.plot(*zip(*points), "o-", color=COLOURS[name], lw=1.4, ms=3.4,
                          zorder=2 if name == "none" else 3)
        axes.set_xscale("log", base=2)
        axes.set_yscale("log")
        axes.xaxis.set_major_locator(FixedLocator(edges))
        axes.xaxis.set_major_formatter(FuncFormatter(lambda edge, _: f"{edge:g}³"))
        axes.xaxis.set_minor_formatter(NullFormatter())
        low, high = axes.get_ylim()
        _log_axis(axes.yaxis)
        if high > 100 * low:
            axes.yaxis.set_major_locator(LogLocator(10, numticks=9))
        axes.set_title(f"{title} (log)")
    return svg(figure, f"sizes{'-n' if narrow else ''}", key_of_structures({row.structure for row in rows}))
