"""How the pages' plots look, and how they become SVG text."""

import io
import re

import matplotlib

matplotlib.use("svg")
import matplotlib.pyplot as plt  # noqa: E402
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter  # noqa: E402

INK, MUTED, RULE, PAPER_WHITE = "#22262b", "#6b7280", "#e3e5e8", "#fcfcfa"
WIDE, NARROW = 8.6, 4.0  # inches, as the style sheet's columns

plt.rcParams.update({
    "font.family": "DejaVu Sans", "font.size": 9, "svg.fonttype": "path", "svg.hashsalt": "slabcast",
    "axes.edgecolor": MUTED, "axes.labelcolor": INK, "axes.linewidth": 0.7, "text.color": INK,
    "axes.spines.top": False, "axes.spines.right": False, "axes.grid": True, "axes.axisbelow": True,
    "axes.titlesize": 9, "axes.titlelocation": "left", "axes.titleweight": "bold",
    "grid.color": RULE, "grid.linewidth": 0.7, "xtick.color": MUTED, "ytick.color": MUTED,
    "xtick.labelcolor": INK, "ytick.labelcolor": INK, "legend.frameon": False,
    "figure.constrained_layout.use": True,
})


def svg(figure, name):
    """Inline SVG that scales with the page; ids are made unique, for a page holds several."""
    buffer = io.StringIO()
    figure.savefig(buffer, format="svg", transparent=True, metadata={"Date": None})
    plt.close(figure)
    text = buffer.getvalue()
    text = text[text.index("<svg"):]
    text = re.sub(r'\b(id="|xlink:href="#|url\(#)', rf"\g<1>{name}-", text)
    text = re.sub(r"<metadata>.*?</metadata>", "", text, flags=re.DOTALL)
    return re.sub(r' width="[\d.]+pt"| height="[\d.]+pt"', "", text, count=2)


def plain_number(value, _=None):
    return f"{value:g}" if value < 10000 else f"{value:,.0f}"


def plain_log_ticks(axis):
    """1, 2, 5, 10 ... written out."""
    axis.set_major_locator(LogLocator(10, subs=(1, 2, 5)))
    axis.set_major_formatter(FuncFormatter(plain_number))
    axis.set_minor_formatter(NullFormatter())


def legend_above(axes, narrow, y=1.0):
    axes.legend(loc="lower left", bbox_to_anchor=(0, y), borderaxespad=0.2, fontsize=8,
                ncol=1 if narrow else 2, handlelength=1.6, columnspacing=1.4)


def key(entries):
    """A legend that wraps with the page: (text, colour, marker or None, hollow, dash array or None for no line)."""
    shapes = {"o": '<circle cx="13" cy="6" r="3.6"{0}/>', "s": '<rect x="9.6" y="2.6" width="6.8" height="6.8"{0}/>',
              "^": '<path d="M13 2 17 9.6H9z"{0}/>', "v": '<path d="M13 10 17 2.4H9z"{0}/>',
              "D": '<path d="M13 1.6 17.4 6 13 10.4 8.6 6z"{0}/>'}
    items = []
    for text, colour, marker, hollow, dashes in entries:
        line = f'<path d="M1 6H25" stroke="{colour}" stroke-width="1.6" stroke-dasharray="{dashes}"/>'
        paint = f' fill="{PAPER_WHITE if hollow else colour}" stroke="{colour}" stroke-width="1.3"'
        drawn = (line if dashes is not None else "") + (shapes[marker].format(paint) if marker else "")
        box = "0 0 26 12" if dashes is not None else "6 0 14 12"
        items.append(f'<li><svg viewBox="{box}" aria-hidden="true">{drawn}</svg>{text}</li>')
    return f'<ul class="key">{"".join(items)}</ul>'
