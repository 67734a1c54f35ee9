"""The plots of what compilers say, as SVG text. Each is drawn wide for desks and narrow for phones."""

from matplotlib.ticker import FuncFormatter, NullLocator

from page_svg import INK, MUTED, NARROW, WIDE, plain_log_ticks, plain_number, plt, svg

REST = "#c9ccd1"  # every variant without a name
COLOURS = ("#1d6091", "#b5532a", "#5aa0a8", "#d79a55", "#6a5aa8", "#8a6d3b", "#3b7d4f", "#a83f6f", "#22262b", "#7f8c3a",
           "#4aa3df", "#e0846b", "#9b7fd4", "#6fbf8f")
ARITHMETIC, TEXTURE, OTHER, BEFORE = "#1d6091", "#d79a55", "#8b8f96", "#b5532a"


def _panels(table, narrow, height):
    """A panel per GPU; those that are left over are hidden."""
    columns = 1 if narrow else 2
    lines = -(-len(table.gpus) // columns)
    figure, grid = plt.subplots(lines, columns, squeeze=False,
                                figsize=(NARROW if narrow else WIDE, height * lines + 0.3))
    panels = list(grid.flat)
    for axes in panels[len(table.gpus):]:
        axes.set_visible(False)
    return figure, list(zip(table.gpus, panels))


def per_layer(table, narrow):
    """Cost per layer over layers per plane: one line per variant, the named ones in colour."""
    named = table.named_families
    if not any(table.series(gpu) for gpu in table.gpus):
        return None
    figure, panels = _panels(table, narrow, 2.6)
    lengths = sorted({row.layers for row in table.rows if row.layers > 0})
    for gpu, axes in panels:
        series = table.series(gpu)
        for rows in series.values():
            axes.plot([row.layers for row in rows], [row.per_layer for row in rows], color=REST, lw=0.8, zorder=1)
        for (family, _), colour in zip(named, COLOURS):
            if rows := series.get(family):
                axes.plot([row.layers for row in rows], [row.per_layer for row in rows], "o-", color=colour, lw=1.5,
                          ms=3, zorder=3)
        axes.set_xscale("log", base=2)
        axes.set_yscale("log")
        axes.set_xticks(lengths, [plain_number(length) for length in lengths], fontsize=8)
        axes.xaxis.set_minor_locator(NullLocator())
        plain_log_ticks(axes.yaxis)
        axes.set_title(table.gpus[gpu]["title"])
        axes.set_ylabel("cycles per layer" if table.is_mali(gpu) else "instructions per layer")
    for _, axes in panels[-1:] if narrow else panels[-2:]:
        axes.set_xlabel("layers per plane")
    key = [(words, colour, "o", False, "") for (_, words), colour in zip(named, COLOURS)]
    return svg(figure, f"layers{'-n' if narrow else ''}", key + [("every other variant", REST, None, False, "")])


def _bars(axes, table, gpu, names):
    """What a fragment of each named row keeps busy."""
    mali = table.is_mali(gpu)
    for place, name in enumerate(names):
        row, before = table.cell(gpu, name, "general"), table.cell(gpu, name, "before")
        if row is not None and row.cost is not None:
            if mali:
                axes.barh(place - 0.19, row.figure("arithmetic") or 0.0, height=0.34, color=ARITHMETIC)
                axes.barh(place + 0.19, row.figure("texture") or 0.0, height=0.34, color=TEXTURE)
            else:
                nops = row.figure("nops") or 0.0
                axes.barh(place, row.cost - nops, height=0.6, color=ARITHMETIC)
                axes.barh(place, nops, left=row.cost - nops, height=0.6, color=OTHER)
        if before is not None and before.cost is not None:
            axes.plot([before.cost, before.cost], [place - 0.4, place + 0.4], color=BEFORE, lw=1.8)
    axes.set_yticks(range(len(names)), names, fontsize=7)
    axes.invert_yaxis()
    axes.grid(axis="y", visible=False)
    axes.tick_params(axis="y", length=0)
    axes.set_xlabel("cycles per fragment" if mali else "instructions per fragment", color=MUTED)
    axes.xaxis.set_major_formatter(FuncFormatter(plain_number))
    axes.set_title(table.gpus[gpu]["title"], color=INK)


def units(table, narrow):
    """Per named row: what is busy, and what it cost before."""
    names = [name for name, _ in table.named if any(table.cell(gpu, name, "general") for gpu in table.gpus)]
    if not names:
        return None
    figure, panels = _panels(table, narrow, 0.2 * len(names) + 0.8)
    for gpu, axes in panels:
        _bars(axes, table, gpu, names)
    key = [("arithmetic, or instructions that are no nops", ARITHMETIC, "s", False, None),
           ("Mali: texture unit", TEXTURE, "s", False, None), ("Adreno: nops", OTHER, "s", False, None)]
    key += [("all of it before", BEFORE, None, False, "")] if table.before else []
    return svg(figure, f"units{'-n' if narrow else ''}", key)
