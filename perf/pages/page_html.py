"""What the pages are written with: figures as text, tables, captions, the frame of a page."""

import base64
import html
from pathlib import Path

from page_input import number, section as part

MISSING = "–"


def esc(value):
    return html.escape(str(value))


def figures(value, digits=3):
    """Three significant figures below a thousand, whole numbers above."""
    value = number(value)
    if value is None:
        return MISSING
    return f"{value:,.0f}" if abs(value) >= 1000 else f"{value:.{digits}g}"


def scientific(value, digits=3):
    """For errors, which span many decades: 4.10e-3."""
    value = number(value)
    if value is None:
        return MISSING
    mantissa, exponent = f"{value:.{digits - 1}e}".split("e")
    return f"{mantissa}e{int(exponent)}".replace("-", "−") if value else "0"


def times(value):
    return MISSING if value is None else f"{value:.2f}×"


def interval(low, high, digits=2):
    """Of a ratio: "2.80 – 3.05"; nothing where it is not known."""
    return "" if low is None or high is None else f"{low:.{digits}f} – {high:.{digits}f}"


INTERVAL_WORDS = ("between two order statistics of the rounds’ ratios, the narrowest pair that covers the median with at "
                  "least 95 % whatever the distribution; of fewer than 6 rounds from the least to the greatest")


def coverage_words(coverage):
    """What an interval is, and how sure."""
    known = number(coverage)
    return f"Intervals are {INTERVAL_WORDS}" + (f": here {100 * known:.1f} %." if known is not None else ".")


def mebibytes(value):
    value = number(value)
    return None if value is None else f"{figures(value / 2**20)} MiB"


def millions(value):
    return MISSING if value is None else f"{value / 1e6:,.2f}"


def on_off(value):
    return {True: "on", False: "off"}.get(value)


def by(values):
    """256×256×108"""
    return "×".join(str(value) for value in values) if isinstance(values, list) else ""


def plural(count, noun):
    return f"{count} {noun}{'' if count == 1 else 's'}"


def table(head, rows, caption="", css="", row_css=None):
    """The first column names the row; all others are figures. `row_css`: a class for each row."""
    head = "".join(f"<th scope=col>{cell}</th>" for cell in head)
    opening = [f'<tr class="{css}">' if css else "<tr>" for css in row_css or [""] * len(rows)]
    body = "".join(
        tr + "".join(f"<th scope=row>{cell}</th>" if i == 0 else f"<td>{cell}</td>"
                     for i, cell in enumerate(row)) + "</tr>" for tr, row in zip(opening, rows))
    caption = f"<caption>{caption}</caption>" if caption else ""
    return (f'<div class="scroll"><table class="{css}">{caption}<thead><tr>{head}</tr></thead>'
            f"<tbody>{body}</tbody></table></div>")


def facts(pairs):
    """A definition list; what is not known is left out."""
    items = "".join(f"<div><dt>{esc(name)}</dt><dd>{value}</dd></div>"
                    for name, value in pairs if value not in (None, ""))
    return f'<dl class="facts">{items}</dl>'


def device_facts(raw):
    """On what it ran, when, and which build: the first facts of every page."""
    device = part(raw, "device")
    return [("Device", esc(device.get("renderer", MISSING))),
            ("Vendor", esc(device.get("vendor", ""))),
            ("Driver", esc(device.get("version", MISSING))),
            ("Date", esc(raw.get("date", MISSING))),
            ("Commit", f"<code>{esc(raw.get('commit', MISSING))}</code>")]


def command(raw):
    text = raw.get("command")
    return f'<p class="command"><code>{esc(text)}</code></p>' if text else ""


def card(name, value, note, css=""):
    return f'<div class="card {css}"><span>{name}</span><b>{value}</b><span>{note}</span></div>'


def cards(made):
    return f'<div class="cards">{"".join(made)}</div>' if made else ""


def figure(draw, measured, caption):
    """`draw` in both widths; the style sheet shows one. Nothing where there is nothing to draw."""
    wide, narrow = draw(measured, False), draw(measured, True)
    if wide is None:
        return ""
    return (f'<figure><div class="wide">{wide}</div><div class="narrow">{narrow}</div>'
            f"<figcaption>{caption} <span>Files: <code>figures/{esc(wide.name)}.svg</code>, <code>.pdf</code>; for a "
            f"column: <code>figures/{esc(narrow.name)}.svg</code>.</span></figcaption></figure>")


def image(data, alt):
    """A PNG file's bytes, inside the page."""
    uri = "data:image/png;base64," + base64.b64encode(data).decode()
    return f'<img src="{uri}" alt="{esc(alt)}" loading="lazy">'


def section(title, body, anchor=""):
    name = f' id="{esc(anchor)}"' if anchor else ""
    return f"<section{name}><h2>{title}</h2>{body}</section>" if body else ""


SOFTWARE_TIMES = ("these milliseconds say nothing about a headset. Compare rows of this page with one another, and "
                  "read the work counters, which do not depend on speed.")


def masthead(kicker, title, line, device, rest, of_software=SOFTWARE_TIMES):
    """The page's head, with a warning of what it means where no GPU drew; `rest` is what was found."""
    notice = ""
    if device.get("software"):
        notice = ('<p class="notice"><strong>Drawn by a software driver.</strong> The processor stands in for a '
                  f"GPU: {of_software}</p>")
    return (f'<header><p class="kicker">Slabcast · {kicker}</p><h1>{title}</h1>'
            f'<p class="lede">{line}</p>{notice}{rest}</header>')


def document(title, head, sections):
    """The whole page; nothing outside it is loaded."""
    style = (Path(__file__).parent / "report.css").read_text(encoding="utf-8")
    return (f'<!doctype html>\n<html lang="en"><head><meta charset="utf-8">'
            f'<meta name="viewport" content="width=device-width, initial-scale=1"><title>{title}</title>'
            f"<style>\n{style}</style></head>\n<body><main>{head}\n"
            + "\n".join(filter(None, sections)) + "</main></body></html>\n")
