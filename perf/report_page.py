"""The report as one self-contained HTML page."""

import base64
import html
from pathlib import Path

import report_plots as plots
from report_data import PAPER_FIGURES, number

MISSING = "–"


def esc(value):
    return html.escape(str(value))


def figures(value, digits=3):
    """Three significant figures below a thousand, whole numbers above."""
    value = number(value)
    if value is None:
        return MISSING
    return f"{value:,.0f}" if abs(value) >= 1000 else f"{value:.{digits}g}"


def times(value):
    return MISSING if value is None else f"{value:.2f}×"


def mebibytes(value):
    value = number(value)
    return None if value is None else f"{figures(value / 2**20)} MiB"


def millions(value):
    return MISSING if value is None else f"{value / 1e6:,.2f}"


def table(head, rows, caption="", css=""):
    """The first column names the row; all others are figures."""
    head = "".join(f"<th scope=col>{cell}</th>" for cell in head)
    body = "".join(
        "<tr>" + "".join(f"<th scope=row>{cell}</th>" if i == 0 else f"<td>{cell}</td>"
                         for i, cell in enumerate(row)) + "</tr>" for row in rows)
    caption = f"<caption>{caption}</caption>" if caption else ""
    return (f'<div class="scroll"><table class="{css}">{caption}<thead><tr>{head}</tr></thead>'
            f"<tbody>{body}</tbody></table></div>")


def facts(pairs):
    """A definition list; what is not known is left out."""
    items = "".join(f"<div><dt>{esc(name)}</dt><dd>{value}</dd></div>"
                    for name, value in pairs if value not in (None, ""))
    return f'<dl class="facts">{items}</dl>'


def figure(draw, sweep, caption):
    """`draw` in both widths; the style sheet shows one. Nothing where there is nothing to draw."""
    wide, narrow = draw(sweep, False), draw(sweep, True)
    if wide is None:
        return ""
    return (f'<figure><div class="wide">{wide}</div><div class="narrow">{narrow}</div>'
            f"<figcaption>{caption}</figcaption></figure>")


def section(title, body):
    return f"<section><h2>{title}</h2>{body}</section>" if body else ""


def masthead(sweep):
    volume, device = sweep.section("volume"), sweep.section("device")
    name = esc(volume.get("name", "volume"))
    dims = "×".join(str(d) for d in volume.get("dims", []))
    line = ", ".join(part for part in (name, dims, esc(device.get("renderer", "unknown device")))
                     if part)
    notice = ""
    if device.get("software"):
        notice = ('<p class="notice"><strong>Drawn by a software driver.</strong> The processor stands in for a '
                  "GPU: these milliseconds say nothing about a headset. Compare rows of this page with one "
                  "another, and read the work counters, which do not depend on speed.</p>")
    return (f'<header><p class="kicker">Slabcast · ratio sweep</p><h1>How many planes, how many layers each?</h1>'
            f'<p class="lede">{line}</p>{notice}{findings(sweep)}</header>')


def findings(sweep):
    """What was found, in words and this run's own ratios."""
    cards = []
    for series in sweep.series:
        best = series.best
        gain = series.speed_up(best)
        against = f"{times(gain)} the speed of slicing" if gain else "slicing was not measured"
        cards.append(f'<div class="card {"skips" if series.skips else ""}"><span>{esc(series.label)}: best at</span>'
                     f"<b>{best.label}</b><span>{figures(best.median_ms)} ms; {against}</span></div>")
    return f'<div class="cards">{"".join(cards)}</div>'


def run_facts(sweep):
    device, conditions, volume = (sweep.section(n) for n in ("device", "conditions", "volume"))
    size = "×".join(str(s) for s in conditions.get("size", []))
    spacing = " × ".join(figures(s) for s in volume.get("spacingMm", []))
    settings = " · ".join(esc(conditions[key]) for key in ("classification", "space", "target", "lattice")
                          if conditions.get(key))
    termination, shade = conditions.get("termination"), conditions.get("shade")
    layers = conditions.get("totalLayers")
    step = number(conditions.get("layerSpacingMm"))
    views = conditions.get("views")
    command = sweep.raw.get("command")
    return facts([
        ("Device", esc(device.get("renderer", MISSING))),
        ("Vendor", esc(device.get("vendor", ""))),
        ("Driver", esc(device.get("version", MISSING))),
        ("Date", esc(sweep.raw.get("date", MISSING))),
        ("Commit", f"<code>{esc(sweep.raw.get('commit', MISSING))}</code>"),
        ("Volume", " · ".join(part for part in (esc(volume.get("type", "")), f"{spacing} mm" if spacing else "") if part)),
        ("Picture", f"{size}{f', {views} views' if number(views) and views > 1 else ''}" if size else None),
        ("Settings", settings),
        ("Shading, termination", f"{esc(shade)}, {esc(termination)}" if shade or termination else None),
        ("Layers", f"{layers} in total{f', {figures(step)} mm apart' if step else ''}" if layers else None),
        ("Tight polygons", {True: "on", False: "off"}.get(conditions.get("tighten"))),
        ("Frames per row", conditions.get("framesPerRow")),
    ]) + (f'<p class="command"><code>{esc(command)}</code></p>' if command else "")


def _measured_at(sweep, kind):
    """This run's counterpart of one line of the paper's table: a row per series, where it was measured."""
    def pick(series):
        if kind == "ray casting":
            return next((row for row in series.rows if row.planes == 1), None)
        if kind == "slicing":
            return series.slicing
        between = [row for row in series.rows if row.planes > 1 and row.layers > 1]
        return min(between, key=lambda row: row.median_ms, default=None)
    return [(series, pick(series)) for series in sweep.series]


def paper_table(sweep):
    """The paper's figures as multiples of its own slicing, beside ours as multiples of ours."""
    slicing = PAPER_FIGURES["slicing"]
    rows = []
    for kind, paper in PAPER_FIGURES.items():
        cells = [times(fps / base if fps else None) + (f" <i>({fps:g} fps)</i>" if fps else "")
                 for fps, base in zip(paper, slicing)]
        for series, row in _measured_at(sweep, kind):
            cells.append(f"{times(series.speed_up(row))} <i>({row.label})</i>" if row else MISSING)
        rows.append([kind.capitalize(), *cells])
    head = ["Speed, slicing = 1", "paper’s phone, no skipping", "paper’s phone, skipping",
            *(f"this run, {esc(series.label)}" for series in sweep.series)]
    note = ("The paper’s columns are <strong>another device under other conditions</strong>: Samsung Galaxy S8 "
            "(Exynos 8895, Mali-G71 MP20), stereo at 2960×1440, 2× multisampling, a 256³ skull that fills the "
            "view, about 444 layers a voxel apart, pre-classified colours. Only the multiples of each device’s "
            "own slicing may be read side by side. The best hybrid’s ratio of planes to layers is not given "
            "in its text. Source: B. Tukora, <cite>Pollack Periodica</cite> 15(2), 2020, section 3.")
    return table(head, rows, css="paper") + f'<p class="note">{note}</p>'


def against_plain_slicing(sweep):
    """Best hybrid and best ray casting of all series, as multiples of slicing without skipping and with full polygons."""
    plain = next((row for row in sweep.rows if row.layers == 1 and row.raw.get("skip") in (None, "none")
                  and not row.raw.get("tighten")), None)
    kinds = {"hybrid": [row for row in sweep.rows if row.planes > 1 and row.layers > 1],
             "ray casting": [row for row in sweep.rows if row.planes == 1]}
    return [(f"Best {kind} against plain slicing",
             f"{best.label}: {times(plain.median_ms / best.median_ms)}")
            for kind, rows in kinds.items() if plain and rows
            for best in [min(rows, key=lambda row: row.median_ms)]]


def memory_and_speed(sweep):
    memory, build, volume = (sweep.section(n) for n in ("memory", "skipBuild", "volume"))
    occupied = number(build.get("occupiedFraction"))
    pairs = [
        ("Peak host memory", mebibytes(memory.get("peakHostBytes"))),
        ("Volume in memory", mebibytes(memory.get("volumeBytes", volume.get("bytes")))),
        ("Textures", mebibytes(memory.get("textureBytes"))),
        ("Skip structure in memory", mebibytes(memory.get("skipBytes"))),
        ("Skip structure built in", f"{figures(build['ms'])} ms" if number(build.get("ms")) is not None else None),
        ("Skip structure", f"{esc(build['structure'])}, blocks of {esc(build.get('blockEdge', '?'))}³ voxels"
         if build.get("structure") else None),
        ("Blocks not free", f"{100 * occupied:.1f} %" if occupied is not None else None),
    ]
    for series in sweep.series:
        if series.slicing:
            best = series.best
            pairs.append((f"Best, {series.label}",
                          f"{best.label}: {times(series.speed_up(best))} slicing, {figures(best.fps)} fps"))
    return facts(pairs + against_plain_slicing(sweep))


def all_rows(sweep):
    head = ["planes × layers", "skipping", "form", "tight", "median ms", "min – max", "p10 – p90", "n", "fps",
            "fragments", "layers", "skipped", "volume fetches", "skip fetches", "compile ms", "variant"]
    lines = []
    for series in sweep.series:
        for row in series.rows:
            ms, raw = row.raw["frameMs"], row.raw
            lines.append([
                row.label, esc(raw.get("skip", MISSING)), esc(raw.get("form", MISSING)),
                {True: "on", False: "off"}.get(raw.get("tighten"), MISSING), f"<b>{figures(row.median_ms)}</b>",
                f"{figures(row.low_ms)} – {figures(row.high_ms)}",
                f"{figures(ms.get('p10'))} – {figures(ms.get('p90'))}", figures(ms.get("n")), figures(row.fps),
                *(millions(row.counter(name)) for name in plots.COUNTERS),
                figures(raw.get("compileMs")), f"<code>{esc(raw.get('variant', MISSING))}</code>"])
    return table(head, lines, css="rows") + '<p class="note">Counters are millions per frame.</p>'


def _thumbnail(sweep, row):
    """The path of a row's picture, only inside the sweep's own folder; None where there is none."""
    relative = row.raw.get("thumbnail")
    path = (sweep.folder / str(relative)).resolve()
    if not relative or not path.is_relative_to(sweep.folder.resolve()) or not path.is_file():
        return None
    return path


def _pictures(sweep, ratio):
    """Bytes of each different picture of one ratio -> (labels of the series, files) that hold it."""
    pictures = {}
    for series in sweep.series:
        for row in series.rows:
            path = _thumbnail(sweep, row) if row.ratio == ratio else None
            if path:
                labels, paths = pictures.setdefault(path.read_bytes(), ([], set()))
                labels.append(series.label)
                paths.add(path)
    return pictures


def _thumbnail_note(pictures_by_ratio):
    """Claims sameness only where every ratio has a file of each of several series."""
    if any(len(pictures) > 1 for pictures in pictures_by_ratio.values()):
        return "<p>Where the series’ pictures differ, in however small a way, each is shown.</p>"
    if all(len(paths) > 1 for pictures in pictures_by_ratio.values() for _, paths in pictures.values()):
        return ("<p>At every ratio the pictures of all series, with and without skipping, are the same file, "
                "byte for byte, so each is shown once.</p>")
    return ""


def thumbnails(sweep):
    """One picture per ratio where all series agree byte for byte; else each series' own."""
    found = {ratio: pictures for ratio in sweep.ratios if (pictures := _pictures(sweep, ratio))}
    tiles = []
    for (planes, layers), pictures in found.items():
        for data, (labels, _) in pictures.items():
            uri = "data:image/png;base64," + base64.b64encode(data).decode()
            which = f"<i>{esc('; '.join(labels))}</i>" if len(pictures) > 1 else ""
            tiles.append(f'<figure><img src="{uri}" alt="The volume at {planes}×{layers}" loading="lazy">'
                         f"<figcaption>{planes}×{layers}{which}</figcaption></figure>")
    return f'{_thumbnail_note(found)}<div class="tiles">{"".join(tiles)}</div>' if tiles else ""


def page(sweep):
    style = (Path(__file__).parent / "report.css").read_text(encoding="utf-8")
    loops = any(row.raw.get("form") == "loop" for row in sweep.rows)
    sections = [
        section("This run", run_facts(sweep)),
        section("Frame time over the ratio", figure(
            plots.frame_times, sweep, "The core paper’s Fig. 4 for this device: median frame time, with whiskers from the "
            "fastest to the slowest frame." + (" Hollow points use the loop form of the shader." if loops else ""))),
        section("Beside the paper", figure(
            plots.speed_ups, sweep, "The same medians as speed, in multiples of this device’s own slicing.")
            + paper_table(sweep)),
        section("Work per frame", figure(
            plots.counters, sweep, "What the shader did. Counts, not times: they depend on the picture, not on the device’s speed.")),
        section("Memory and speed", memory_and_speed(sweep)),
        section("Compiling the variants", figure(
            plots.compile_times, sweep, "Compile and link of each variant and what its first frame took beyond a usual one, the driver’s caches off.")),
        section("Pictures", thumbnails(sweep)),
        section("Every row", all_rows(sweep)),
    ]
    title = f"Ratio sweep: {esc(sweep.section('volume').get('name', 'volume'))}"
    return (f'<!doctype html>\n<html lang="en"><head><meta charset="utf-8">'
            f'<meta name="viewport" content="width=device-width, initial-scale=1"><title>{title}</title>'
            f"<style>\n{style}</style></head>\n<body><main>{masthead(sweep)}\n"
            + "\n".join(filter(None, sections)) + "</main></body></html>\n")
