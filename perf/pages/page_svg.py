"""How the pages' plots look, and how they become SVG text and files."""

import io
import re
import textwrap

import matplotlib

matplotlib.use("svg")
import matplotlib.pyplot as plt  # noqa: E402
from matplotlib.lines import Line2D  # noqa: E402
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter  # noqa: E402

INK, MUTED, RULE, PAPER_WHITE = "#22262b", "#6b7280", "#e3e5e8", "#fcfcfa"
WIDE, NARROW = 8.6, 4.0  # inches, as the style sheet's columns

plt.rcParams.update({
    "font.family": "DejaVu Sans", "font.size": 9, "svg.fonttype": "none", "svg.hashsalt": "slabcast",
    "pdf.fonttype": 42,
    "axes.edgecolor": MUTED, "axes.labelcolor": INK, "axes.linewidth": 0.7, "text.color": INK,
    "axes.spines.top": False, "axes.spines.right": False, "axes.grid": True, "axes.axisbelow": True,
    "axes.titlesize": 9, "axes.titlelocation": "left", "axes.titleweight": "bold",
    "grid.color": RULE, "grid.linewidth": 0.7, "xtick.color": MUTED, "ytick.color": MUTED,
    "xtick.labelcolor": INK, "ytick.labelcolor": INK, "legend.frameon": False,
    "figure.constrained_layout.use": True,
})


FILES = {}  # of figures made so far: bytes by file name, for page_main


class Drawn(str):
    """A figure as inline SVG, which knows what its files are called."""
    name = ""


def svg(figure, name, key=()):
    """Inline SVG that scales with the page; ids are made unique, for a page holds several. The same goes to FILES,
    and as PDF too, unless it is a narrow one ("NAME-n"). `key`: entries of a legend, drawn above the plots, by which the figure grows: (text, colour, marker
    or None, hollow, dashes in points as "4 2", "" for a solid line, None for no line)."""
    if key:
        _add_legend(figure, key)
    buffer = io.StringIO()
    figure.savefig(buffer, format="svg", transparent=True, metadata={"Date": None})
    text = buffer.getvalue()
    text = text[text.index("<svg"):]
    text = re.sub(r'\b(id="|xlink:href="#|url\(#)', rf"\g<1>{name}-", text)
    text = re.sub(r"<metadata>.*?</metadata>", "", text, flags=re.DOTALL)
    # Text is text: where the font is not there, one of nearly its widths.
    text = text.replace("'DejaVu Sans'", "'DejaVu Sans', Verdana, sans-serif")
    FILES[f"{name}.svg"] = f'<?xml version="1.0" encoding="utf-8" standalone="no"?>\n{text}'.encode()
    if not name.endswith("-n"):  # embedding fonts takes as long as drawing: the wide one only
        figure.set_layout_engine("none")  # laid out already
        pages = io.BytesIO()
        figure.savefig(pages, format="pdf", transparent=True, metadata={"CreationDate": None})
        FILES[f"{name}.pdf"] = pages.getvalue()
    plt.close(figure)
    drawn = Drawn(re.sub(r' width="[\d.]+pt"| height="[\d.]+pt"', "", text, count=2))
    drawn.name = name
    return drawn


def _handle(entry, room):
    text, colour, marker, hollow, dashes = entry
    style = "none" if dashes is None else (0, tuple(map(float, dashes.split()))) if dashes else "-"
    return Line2D([], [], color=colour, lw=1.6, ls=style, marker=marker or "", ms=5.5, mew=1.3, mec=colour,
                  mfc=PAPER_WHITE if hollow else colour,
                  label=textwrap.fill(text.replace("$", r"\$"), room))


def _add_legend(figure, entries):
    """Above all that is there, as many columns as fit; what is there keeps its size."""
    width, height = figure.get_size_inches()
    handles = [_handle(entry, int(72 * width / 5.4) - 7) for entry in entries]
    for columns in range(min(len(handles), 6), 0, -1):
        legend = figure.legend(handles=handles, loc="upper left", ncol=columns, fontsize=8, handlelength=1.8,
                               columnspacing=1.4, borderaxespad=0.1, borderpad=0.2)
        box = legend.get_window_extent()
        if columns == 1 or box.width <= figure.bbox.width - 2:
            break
        legend.remove()
    taller = height + box.height / figure.dpi + 0.06
    figure.set_size_inches(width, taller)
    figure.get_layout_engine().set(rect=(0, 0, 1, height / taller))


def plain_number(value, _=None):
    return f"{value:g}" if value < 10000 else f"{value:,.0f}"


def plain_log_ticks(axis):
    """1, 2, 5, 10 ... written out."""
    axis.set_major_locator(LogLocator(10, subs=(1, 2, 5)))
    axis.set_major_formatter(FuncFormatter(plain_number))
    axis.set_minor_formatter(NullFormatter())
